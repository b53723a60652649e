#include "common_motion.h"

namespace drape
{
void CommonMotion::add(double mass, Vec3d place, Vec3d velocity)
{
    if (m_sum.mass() == 0) m_origin = place;
    m_sum.add(mass, place - m_origin);
    m_momentum = m_momentum + mass * velocity;
    m_angularMomentum = m_angularMomentum + cross(place - m_origin, mass * velocity);
}

void CommonMotion::addBody(double mass, Vec3d place, Vec3d velocity, const Inertia& inertia, Vec3d spin)
{
    add(mass, place, velocity);
    m_sum.addInertia(inertia);
    const Vec3d turning = {inertia.m_xx * spin.x + inertia.m_xy * spin.y + inertia.m_zx * spin.z,
                           inertia.m_xy * spin.x + inertia.m_yy * spin.y + inertia.m_yz * spin.z,
                           inertia.m_zx * spin.x + inertia.m_yz * spin.y + inertia.m_zz * spin.z};
    m_angularMomentum = m_angularMomentum + turning;
}

void CommonMotion::compute(bool turns)
{
    if (!(m_sum.mass() > 0)) return;
    m_velocity = 1 / m_sum.mass() * m_momentum;
    if (turns) m_spin = m_sum.spinOf(m_angularMomentum - cross(m_sum.centre(), m_momentum));
}

Vec3d CommonMotion::velocityAt(Vec3d place) const
{
    if (!(m_sum.mass() > 0)) return {0, 0, 0};
    return m_velocity + cross(m_spin, place - m_origin - m_sum.centre());
}
}  // namespace drape
