// The mass, centre and moments of inertia of points and rigid bodies. Kilograms and metres, double precision.
#pragma once

#include "bullet_plugin/core/vec3d.h"

namespace drape
{
// A symmetric matrix.
struct Inertia
{
    double m_xx = 0, m_yy = 0, m_zz = 0, m_yz = 0, m_zx = 0, m_xy = 0;
};

class MassSum
{
public:
    // place: m, from the origin that all places have in common, which should be near them.
    void add(double mass, Vec3d place);
    // Adds a rigid body's inertia about its own centre, kg m2, beside its mass.
    void addInertia(const Inertia& inertia);

    double mass() const { return m_mass; }
    Vec3d centre() const { return 1 / m_mass * m_moment; }
    // Returns the angular velocity, rad/s, of an angular momentum about the centre, kg m2/s. A share of 1e-6 is lost:
    // what lies on one line has no inertia about it.
    Vec3d spinOf(Vec3d angularMomentum) const;

private:
    double m_mass = 0;
    Vec3d m_moment;
    Inertia m_second;  // second moments of mass
};
}  // namespace drape
