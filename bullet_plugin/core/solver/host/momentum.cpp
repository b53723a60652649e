#include "momentum.h"

#include <algorithm>
#include <cmath>

#include "bullet_plugin/core/solver/rigid_rows.h"
#include "bullet_plugin/core/vec3d.h"
#include "mass_sum.h"
#include "substeps.h"

namespace drape
{
namespace
{
// Maximum energy of the motion that is given back, as a share of the energy of the motion about the centre of mass.
// Links take far less in a step. A cloth that has collapsed to a point is not spun up.
constexpr double kMostEnergy = 0.01;

// Shares that damping leaves at the step's end.
struct Kept
{
    double m_before = 1;    // share of the momentum at the step's start
    double m_received = 0;  // share of what the cloth receives evenly over the step

    explicit Kept(const Substeps& substeps)
    {
        for (int i = 0; i < substeps.count(); ++i)
        {
            m_before *= double(substeps.undamped());
            m_received += m_before / substeps.count();
        }
    }
};

// Sums over the nodes, about the first node's start.
struct Sums
{
    MassSum m_masses;                   // at the step's end
    double m_energy = 0;                // twice the kinetic one
    Vec3d m_momentum;                   // linear momentum at the step's end
    Vec3d m_missing, m_missingTurning;  // linear and angular momentum
};

// Adds up the nodes; what they lack is the momentum at the start and what forces gave, less the momentum at the end.
// Returns false if a node is fixed, or not valid: its momentum is not for others.
bool sumUp(const SolverNodes& nodes, const Substeps& substeps, const Kept& kept, Sums& sums)
{
    const double time = double(substeps.time()), given = kept.m_received * time;
    // A node begins with the velocity path / time - pathTime() * acceleration. Substeps accelerate nodes where they
    // start.
    const double perPath = kept.m_before / time, perForce = given - kept.m_before * double(substeps.pathTime());
    const double inMotion = given * 0.5 * (1 - 1 / double(substeps.count()));
    const Vec3d origin = wide(nodes.start(0));
    for (std::size_t i = 0; i < nodes.count(); ++i)
    {
        const SolverNode& node = nodes.nodes()[i];
        const bool isValid = positionIsValid(vec3Add(nodes.start(i), node.m_displacement));
        if (!(node.m_inverseMass > 0) || !isValid) return false;
        const double mass = 1 / double(node.m_inverseMass);
        const Vec3d force = double(substeps.spread()) * wide(substeps.accelerations()[i]);
        const Vec3d velocity = wide(nodes.velocity(i));
        const Vec3d start = wide(nodes.start(i)) - origin, moved = wide(node.m_displacement), end = start + moved;
        const Vec3d missing = mass * (perPath * wide(nodes.pathVector(i)) + perForce * force - velocity);
        const Vec3d momentum = mass * velocity;
        sums.m_masses.add(mass, end);
        sums.m_energy += dot(momentum, velocity);
        sums.m_momentum = sums.m_momentum + momentum;
        sums.m_missing = sums.m_missing + missing;
        sums.m_missingTurning =
            sums.m_missingTurning + cross(start, missing) + cross(moved, (mass * inMotion) * force - momentum);
    }
    return true;
}

// Takes off what the cloth gave to rigid bodies.
void subtractGiven(const RigidRows& rigid, Vec3d origin, const Kept& kept, Sums& sums)
{
    const Vec3d impulse = kept.m_received * wide(rigid.given().m_impulse);
    sums.m_missing = sums.m_missing - impulse;
    sums.m_missingTurning = sums.m_missingTurning - kept.m_received * wide(rigid.given().m_turning) -
                            cross(wide(rigid.given().m_reference) - origin, impulse);
}
}  // namespace

bool keepsMomentum(const SolverCloth& cloth)
{
    const ClothContacts& contacts = *cloth.m_contacts;
    if (!cloth.m_substeps || !contacts.m_features.empty() || !contacts.m_limit.regions().empty()) return false;
    return contacts.m_nodes.count() > 0 && (!cloth.m_rigid || cloth.m_rigid->bodiesYield());
}

void keepMomentum(const SolverCloth& cloth)
{
    SolverNodes& nodes = cloth.m_contacts->m_nodes;
    const Kept kept(*cloth.m_substeps);
    const Vec3d origin = wide(nodes.start(0));
    Sums sums;
    if (!sumUp(nodes, *cloth.m_substeps, kept, sums)) return;
    if (cloth.m_rigid) subtractGiven(*cloth.m_rigid, origin, kept, sums);
    const Vec3d centre = sums.m_masses.centre(), drift = 1 / sums.m_masses.mass() * sums.m_missing;
    const Vec3d turning = sums.m_missingTurning - cross(centre, sums.m_missing);
    const Vec3d spin = sums.m_masses.spinOf(turning);
    const double most = kMostEnergy * (sums.m_energy - dot(sums.m_momentum, sums.m_momentum) / sums.m_masses.mass());
    const double added = dot(spin, turning) + dot(drift, sums.m_missing);
    if (!(added > 0) || !std::isfinite(added) || !(most > 0)) return;
    const double share = std::min(1.0, std::sqrt(most / added));
    const Vec3 turned = narrow(share * spin), moved = narrow(share * drift), about = narrow(centre + origin);
    for (std::size_t i = 0; i < nodes.count(); ++i)
    {
        const Vec3 arm = vec3Add(vec3Sub(nodes.start(i), about), nodes.displacement(i));
        nodes.addVelocity(i, vec3Add(moved, vec3Cross(turned, arm)));
    }
}
}  // namespace drape
