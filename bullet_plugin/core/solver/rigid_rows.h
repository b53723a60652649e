// Contacts of a cloth's nodes with rigid bodies that the caller found, and anchors to rigid bodies: two-way, since the
// bodies may yield.
//
// Within a step a body stands where the step ends, and its velocity tells where it came from. What the cloth pushes
// changes the body's velocity, and with it how far the body's points come in the rest of the step. Rows are projected
// in their order, on one thread. World frame, SI units.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/shared/solver.h"
#include "solver_nodes.h"

namespace drape
{
struct RigidBody
{
    Vec3 m_centre;              // m, centre of mass
    Vec3 m_velocity, m_spin;    // m/s at the centre of mass, rad/s
    Vec3 m_inverseMass;         // 1/kg by axis; 0 for a body that does not yield
    Vec3 m_inverseInertia[3];   // rows, 1/(kg m²)
    Vec3 m_impulse, m_turning;  // given by the cloth in this step, N s, and about the centre of mass, N m s
};

// A node beside a plane of a body.
struct RigidContact
{
    std::uint32_t m_node, m_body;
    Vec3 m_arm;  // m, from the body's centre of mass to the contact
    RigidPlane m_plane;
};

// A node that follows a point of a body.
struct RigidAnchor
{
    std::uint32_t m_node, m_body;
    Vec3 m_arm;     // m, from the body's centre of mass to the point
    Vec3 m_apart;   // m, from the node to the point at the step's start
    float m_share;  // share of an error that a projection corrects, up to 1
};

class RigidRows
{
public:
    bool empty() const { return m_contacts.empty() && m_anchors.empty(); }
    void clear();
    // bodies: of all rows; they must stay in place until the last substep. Call before add().
    void setBodies(std::vector<RigidBody>& bodies) { m_bodies = &bodies; }
    void add(const RigidContact& contact)
    {
        if (empty()) m_reference = (*m_bodies)[contact.m_body].m_centre;
        m_contacts.push_back({contact, vec3(0, 0, 0), {vec3(0, 0, 0), 0}});
    }
    void add(const RigidAnchor& anchor)
    {
        if (empty()) m_reference = (*m_bodies)[anchor.m_body].m_centre;
        m_anchors.push_back({anchor, vec3(0, 0, 0)});
    }

    // Begins a substep of `time` seconds that ends when the share `passed` of the step has passed. correctionTime: s,
    // see Substeps.
    void begin(float time, float correctionTime, float passed);
    // Returns whether all bodies of the rows yield.
    bool bodiesYield() const;
    // Returns what the rows gave to the bodies since clear(): impulse, N s, and angular momentum about reference(),
    // N m s.
    Vec3 impulse() const { return m_impulse; }
    Vec3 turning() const { return m_turning; }
    // Returns the first body's centre of mass, m.
    Vec3 reference() const { return m_reference; }
    // Projects every row once.
    void project(SolverNodes& nodes);
    // Ends a substep: the bodies' points have gone on with the bodies' velocities.
    void end();

private:
    struct ContactState
    {
        RigidContact m_contact;
        Vec3 m_carried;  // m, displacement of the body's point from the step's start to that of the substep
        RigidHold m_hold;
    };
    struct AnchorState
    {
        RigidAnchor m_anchor;
        Vec3 m_carried;
    };

    Vec3 velocityAt(std::uint32_t body, Vec3 arm) const;
    float mobility(std::uint32_t body, Vec3 arm, Vec3 direction) const;
    void push(SolverNodes& nodes, std::uint32_t node, std::uint32_t body, Vec3 arm, Vec3 by);
    void project(SolverNodes& nodes, ContactState& state);
    void project(SolverNodes& nodes, AnchorState& state);

    std::vector<RigidBody>* m_bodies = nullptr;
    std::vector<ContactState> m_contacts;
    std::vector<AnchorState> m_anchors;
    Vec3 m_reference = {0, 0, 0}, m_impulse = {0, 0, 0}, m_turning = {0, 0, 0};
    float m_time = 1, m_correctionTime = 1, m_passed = 1;
};
}  // namespace drape
