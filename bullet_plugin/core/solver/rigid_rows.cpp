#include "rigid_rows.h"

#include <algorithm>

#include "kernels/lib/rigid_row.h"

namespace drape
{
namespace
{
Vec3 product(const Vec3 rows[3], Vec3 v)
{
    return vec3(vec3Dot(rows[0], v), vec3Dot(rows[1], v), vec3Dot(rows[2], v));
}

Vec3 byAxis(Vec3 a, Vec3 b)
{
    return vec3(a.x * b.x, a.y * b.y, a.z * b.z);
}
}  // namespace

void RigidRows::clear()
{
    m_impulse = m_turning = vec3(0, 0, 0);
    m_contacts.clear();
    m_anchors.clear();
}

bool RigidRows::bodiesYield() const
{
    const auto yields = [this](std::uint32_t index)
    {
        const Vec3 inverseMass = (*m_bodies)[index].m_inverseMass;
        return inverseMass.x > 0 && inverseMass.y > 0 && inverseMass.z > 0;
    };
    return std::all_of(m_contacts.begin(), m_contacts.end(),
                       [&](const ContactState& state) { return yields(state.m_contact.m_body); }) &&
           std::all_of(m_anchors.begin(), m_anchors.end(),
                       [&](const AnchorState& state) { return yields(state.m_anchor.m_body); });
}

Vec3 RigidRows::velocityAt(std::uint32_t index, Vec3 arm) const
{
    const RigidBody& body = (*m_bodies)[index];
    return vec3Add(body.m_velocity, vec3Cross(body.m_spin, arm));
}

// Returns how far along a direction a unit push along it moves a body's point in the substep, 1/kg.
float RigidRows::mobility(std::uint32_t index, Vec3 arm, Vec3 direction) const
{
    const RigidBody& body = (*m_bodies)[index];
    const Vec3 spin = product(body.m_inverseInertia, vec3Cross(arm, direction));
    const Vec3 velocity = vec3Add(byAxis(body.m_inverseMass, direction), vec3Cross(spin, arm));
    return vec3Dot(direction, velocity) * (m_time / m_correctionTime);
}

// Pushes the node, and the body the other way. by: direction times multiplier, kg m.
void RigidRows::push(SolverNodes& nodes, std::uint32_t node, std::uint32_t index, Vec3 arm, Vec3 by)
{
    RigidBody& body = (*m_bodies)[index];
    nodes.shift(node, vec3Scale(by, nodes.nodes()[node].m_inverseMass));
    const Vec3 impulse = vec3Scale(by, -1 / m_correctionTime), turning = vec3Cross(arm, impulse);
    body.m_velocity = vec3Add(body.m_velocity, byAxis(body.m_inverseMass, impulse));
    body.m_spin = vec3Add(body.m_spin, product(body.m_inverseInertia, turning));
    body.m_impulse = vec3Add(body.m_impulse, impulse);
    body.m_turning = vec3Add(body.m_turning, turning);
    m_impulse = vec3Add(m_impulse, impulse);
    m_turning = vec3Add(m_turning, vec3Cross(vec3Add(vec3Sub(body.m_centre, m_reference), arm), impulse));
}

void RigidRows::begin(float time, float correctionTime, float passed)
{
    m_time = time;
    m_correctionTime = correctionTime;
    m_passed = passed;
    for (ContactState& state : m_contacts)
        state.m_hold = {vec3(0, 0, 0), 0};
}

void RigidRows::end()
{
    for (ContactState& state : m_contacts)
        state.m_carried =
            vec3AddScaled(state.m_carried, velocityAt(state.m_contact.m_body, state.m_contact.m_arm), m_time);
    for (AnchorState& state : m_anchors)
        state.m_carried =
            vec3AddScaled(state.m_carried, velocityAt(state.m_anchor.m_body, state.m_anchor.m_arm), m_time);
}

void RigidRows::project(SolverNodes& nodes, ContactState& state)
{
    const RigidContact& contact = state.m_contact;
    const float inverseMass = nodes.inverseMass(contact.m_node);
    if (!(inverseMass > 0)) return;
    const Vec3 carried = vec3AddScaled(state.m_carried, velocityAt(contact.m_body, contact.m_arm), m_time);
    const Vec3 way = vec3Sub(nodes.displacement(contact.m_node), carried);
    const float yields = mobility(contact.m_body, contact.m_arm, contact.m_plane.m_normal);
    Vec3 by;
    if (rigidContactPush(&contact.m_plane, &state.m_hold, way, inverseMass, yields, m_passed, &by))
        push(nodes, contact.m_node, contact.m_body, contact.m_arm, by);
}

void RigidRows::project(SolverNodes& nodes, AnchorState& state)
{
    const RigidAnchor& anchor = state.m_anchor;
    for (int axis = 0; axis < 3; ++axis)
    {
        const Vec3 direction = vec3(float(axis == 0), float(axis == 1), float(axis == 2));
        const Vec3 carried = vec3AddScaled(state.m_carried, velocityAt(anchor.m_body, anchor.m_arm), m_time);
        const Vec3 wanted = vec3AddScaled(carried, anchor.m_apart, m_passed);
        const float error = vec3Dot(direction, vec3Sub(wanted, nodes.displacement(anchor.m_node)));
        const float both =
            nodes.nodes()[anchor.m_node].m_inverseMass + mobility(anchor.m_body, anchor.m_arm, direction);
        if (!(both > 0)) continue;
        push(nodes, anchor.m_node, anchor.m_body, anchor.m_arm,
             vec3Scale(direction, rigidAnchorPush(error, anchor.m_share, both)));
    }
}

void RigidRows::project(SolverNodes& nodes)
{
    for (AnchorState& state : m_anchors)
        project(nodes, state);
    for (ContactState& state : m_contacts)
        project(nodes, state);
}
}  // namespace drape
