#include "mass_sum.h"

namespace drape
{
namespace
{
// Share of the trace that is added to the moments of inertia.
constexpr double kSoftening = 1e-6;
}  // namespace

void MassSum::add(double mass, Vec3d place)
{
    const Vec3d moment = mass * place;
    m_mass += mass;
    m_moment = m_moment + moment;
    m_second.m_xx += moment.x * place.x;
    m_second.m_yy += moment.y * place.y;
    m_second.m_zz += moment.z * place.z;
    m_second.m_yz += moment.y * place.z;
    m_second.m_zx += moment.z * place.x;
    m_second.m_xy += moment.x * place.y;
}

void MassSum::addInertia(const Inertia& inertia)
{
    const double half = 0.5 * (inertia.m_xx + inertia.m_yy + inertia.m_zz);
    m_second.m_xx += half - inertia.m_xx;
    m_second.m_yy += half - inertia.m_yy;
    m_second.m_zz += half - inertia.m_zz;
    m_second.m_yz -= inertia.m_yz;
    m_second.m_zx -= inertia.m_zx;
    m_second.m_xy -= inertia.m_xy;
}

Vec3d MassSum::spinOf(Vec3d angularMomentum) const
{
    const Vec3d place = centre();
    const double xx = m_second.m_xx - m_moment.x * place.x, yy = m_second.m_yy - m_moment.y * place.y;
    const double zz = m_second.m_zz - m_moment.z * place.z, yz = m_second.m_yz - m_moment.y * place.z;
    const double zx = m_second.m_zx - m_moment.z * place.x, xy = m_second.m_xy - m_moment.x * place.y;
    const double soft = kSoftening * 2 * (xx + yy + zz);
    if (!(soft > 0)) return {0, 0, 0};
    const Vec3d rows[3] = {{yy + zz + soft, -xy, -zx}, {-xy, zz + xx + soft, -yz}, {-zx, -yz, xx + yy + soft}};
    const Vec3d a = cross(rows[1], rows[2]), b = cross(rows[2], rows[0]), c = cross(rows[0], rows[1]);
    return 1 / dot(rows[0], a) * (angularMomentum.x * a + angularMomentum.y * b + angularMomentum.z * c);
}
}  // namespace drape
