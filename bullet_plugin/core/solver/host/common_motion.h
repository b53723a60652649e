// The rigid motion with the linear and angular momentum of several masses: how they move after an impact in which they
// stick to each other. No other motion of these masses with that momentum has less energy.
//
// Double precision. Cost: linear in the masses.
#pragma once

#include "mass_sum.h"

namespace drape
{
class CommonMotion
{
public:
    // Adds a point mass: kg, m, m/s.
    void add(double mass, Vec3d place, Vec3d velocity);
    // Adds a rigid body: its inertia about its centre, kg m2, and angular velocity, rad/s.
    void addBody(double mass, Vec3d place, Vec3d velocity, const Inertia& inertia, Vec3d spin);
    // Computes the motion of what was added. turns: else none turns, and angular momentum is lost.
    void compute(bool turns = true);
    // Returns the velocity of a place, m/s.
    Vec3d velocityAt(Vec3d place) const;
    Vec3d spin() const { return m_spin; }

private:
    MassSum m_sum;
    Vec3d m_origin;                       // the first place
    Vec3d m_momentum, m_angularMomentum;  // about m_origin
    Vec3d m_velocity, m_spin;             // the centre's
};
}  // namespace drape
