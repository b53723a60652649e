// Makes the row of a contact that acts, turns it to the nodes' current positions, and limits the speed that it gives.
#ifndef DRAPE_LIB_ACTING_CONTACT_H
#define DRAPE_LIB_ACTING_CONTACT_H

#include "../geometry/segment.h"
#include "contact_plane.h"
#include "contact_row.h"

DRAPE_NAMESPACE_BEGIN

// Share of the greatest inverse mass that is added to a contact's mobility where the rest of its point is fixed;
// proportionally less where less of it is fixed. It keeps a node with little weight in the point from being thrown
// far. The node moves at most 2.8 times the violation in a sweep, at a weight of a fifth, and less the smaller its
// weight.
#define DRAPE_HELD_SOFTNESS 0.04f

// Nodes count as partly fixed if their inverse mass is less than this share of the greatest one of the contact, the
// more the less it is. Heavier nodes hardly move, so light ones would be thrown beside them as beside fixed nodes.
#define DRAPE_HEAVY_SHARE 0.1f

// Minimum share of the thickness that a step recovers of an initial depth. Only positions recover; no speed remains.
// A tenth quickly corrects cloth that came a little too near while it moved along a curved obstacle.
#define DRAPE_RECOVERED_SHARE 0.1f

// The nodes of a contact's feature.
typedef struct FeatureNodes
{
    DRAPE_UINT m_count;
    DRAPE_UINT m_nodes[3];  // indices
    Vec3 m_starts[3];       // m, at the step's start
    Vec3 m_carried[3];      // m, where the obstacle's motion in the step carries the starts
    Vec3 m_ends[3];         // m, of the predicted paths
    float m_inverseMasses[3];
    int m_moves;  // true if the obstacle moves
} FeatureNodes;

// Properties of a contact's row beside its plane.
typedef struct ContactSettings
{
    float m_thickness;  // m
    float m_friction;   // coefficient
    float m_hardness;   // see targetGap()
    float m_perSecond;  // 1/s, steps per second
} ContactSettings;

// Returns whether a contact turns along with its face (renewPlane()): one of a face and a vertex that did not meet in
// the step.
DRAPE_FUNCTION int contactTurns(const DRAPE_GLOBAL Contact* contact)
{
    return contact->m_kind == DRAPE_FACE_VERTEX && !(contact->m_time < 1.0f);
}

// Gaps have the thickness subtracted: 0 is the resting distance, negative is too close.
typedef struct ContactGaps
{
    float m_start;   // m, at the step's start, relative to the obstacle
    float m_end;     // m, at the path's end
    float m_target;  // m, least gap at the step's end: 0, or less when the step began too close
} ContactGaps;

// Returns the least gap at the step's end. A step that began too close recovers the share `hardness` of its depth
// (Bullet's kinetic contact hardness, kKHR), or DRAPE_RECOVERED_SHARE of the thickness if that is more. Cloth that
// starts inside is therefore not thrown out.
DRAPE_FUNCTION float targetGap(float startGap, float hardness, float thickness)
{
    const float recovered = drapeMax(startGap + DRAPE_RECOVERED_SHARE * thickness, startGap * (1.0f - hardness));
    return drapeMin(0.0f, recovered);
}

DRAPE_FUNCTION Vec3 weightedPoint(DRAPE_UINT count, const Vec3* positions, const float* weights)
{
    Vec3 at = vec3Scale(positions[0], weights[0]);
    for (DRAPE_UINT k = 1; k < count; ++k)
        at = vec3AddScaled(at, positions[k], weights[k]);
    return at;
}

// Returns both gaps along the contact's normal. A feature that slid around an edge of the obstacle began behind its
// contact's plane without having been inside the obstacle. Only the depth at the path's end is known then.
DRAPE_FUNCTION ContactGaps contactGaps(const FeatureNodes* nodes, const ContactPlane* plane,
                                       const ContactSettings* settings)
{
    const float thickness = settings->m_thickness;
    const Vec3 start = weightedPoint(nodes->m_count, nodes->m_carried, plane->m_weights);
    const Vec3 end = weightedPoint(nodes->m_count, nodes->m_ends, plane->m_weights);
    ContactGaps gaps;
    gaps.m_start = vec3Dot(plane->m_normal, vec3Sub(start, plane->m_point)) - thickness;
    gaps.m_end = vec3Dot(plane->m_normal, vec3Sub(end, plane->m_point)) - thickness;
    if (gaps.m_start < -thickness && gaps.m_start < gaps.m_end) gaps.m_start = gaps.m_end;
    gaps.m_target = targetGap(gaps.m_start, settings->m_hardness, thickness);
    return gaps;
}

// Returns the share of a weighted point that belongs to fixed nodes, or to nodes that are much heavier than the
// lightest one. most: greatest inverse mass of the nodes, 1/kg.
DRAPE_FUNCTION float heldShare(const FeatureNodes* nodes, const float* weights, float most)
{
    const float light = DRAPE_HEAVY_SHARE * most;
    float held = 0.0f;
    for (DRAPE_UINT k = 0; k < nodes->m_count; ++k)
        if (nodes->m_inverseMasses[k] < light) held += weights[k] * (1.0f - nodes->m_inverseMasses[k] / light);
    return held;
}

// Gives the row another plane.
DRAPE_FUNCTION void setPlane(ActingContact* contact, const FeatureNodes* nodes, const ContactPlane* plane)
{
    ContactRow* row = &contact->m_row;
    float mobility = 0.0f, most = 0.0f;
    for (DRAPE_UINT k = 0; k < nodes->m_count; ++k)
    {
        const float inverseMass = nodes->m_inverseMasses[k], weight = plane->m_weights[k];
        row->m_weights[k] = weight;
        row->m_shares[k] = weight * inverseMass;
        mobility += weight * weight * inverseMass;
        most = drapeMax(most, inverseMass);
    }
    const float held = heldShare(nodes, plane->m_weights, most);
    const float softened = mobility + DRAPE_HELD_SOFTNESS * held * most;
    row->m_inverseMobility = mobility > 0.0f ? 1.0f / softened : 0.0f;
    row->m_mended = held > 0.0f ? mobility * row->m_inverseMobility : 1.0f;
    row->m_normal = plane->m_normal;
    const Vec3 start = weightedPoint(nodes->m_count, nodes->m_starts, plane->m_weights);
    Vec3 carried = vec3(0.0f, 0.0f, 0.0f);
    if (nodes->m_moves)
    {
        carried = vec3Scale(start, -1.0f);
        for (DRAPE_UINT k = 0; k < nodes->m_count; ++k)
            carried = vec3AddScaled(carried, nodes->m_carried[k], plane->m_weights[k]);
    }
    row->m_advance = vec3Dot(row->m_normal, carried);
    row->m_carried = vec3AddScaled(carried, row->m_normal, -row->m_advance);
    row->m_level = vec3Dot(row->m_normal, vec3Sub(plane->m_point, start)) + contact->m_distance;
}

// Makes the row of a contact, with no pushes.
DRAPE_FUNCTION ActingContact actingContact(const FeatureNodes* nodes, const ContactPlane* plane,
                                           const ContactSettings* settings, ContactGaps gaps)
{
    ActingContact contact;
    contact.m_row.m_count = nodes->m_count;
    for (int k = 0; k < 3; ++k)
    {
        contact.m_row.m_nodes[k] = nodes->m_nodes[k];
        contact.m_row.m_weights[k] = contact.m_row.m_shares[k] = 0.0f;
    }
    contact.m_row.m_friction = settings->m_friction;
    contact.m_row.m_multiplier = 0.0f;
    contact.m_row.m_held = vec3(0.0f, 0.0f, 0.0f);
    contact.m_distance = settings->m_thickness + gaps.m_target;
    contact.m_phase = contact.m_pushed = 0;
    contact.m_unused[0] = contact.m_unused[1] = contact.m_unused[2] = 0;
    setPlane(&contact, nodes, plane);
    contact.m_speedLimit = DRAPE_INFINITY;
    if (gaps.m_start < 0.0f)
    {
        const float recovered = drapeMax(0.0f, gaps.m_end - gaps.m_start);
        contact.m_speedLimit = (recovered + contact.m_row.m_advance) * settings->m_perSecond;
    }
    return contact;
}

// Renews the plane of a contact between a face and a vertex where the two are nearest now. The obstacle counts as
// standing at the step's end: the nodes move along with the rest of its motion. displacements: m, of the nodes. passed:
// the share of the step that has passed. found: the plane as it was found. Returns whether the plane changed; it is
// written to *plane then.
DRAPE_FUNCTION int renewPlane(ActingContact* contact, const FeatureNodes* nodes, const Vec3* displacements,
                              float passed, const ContactPlane* found, ContactPlane* plane)
{
    Vec3 positions[3];
    for (DRAPE_UINT k = 0; k < 3; ++k)
    {
        const DRAPE_UINT at = k < nodes->m_count ? k : nodes->m_count - 1;  // a link repeats its second node
        const Vec3 position = vec3Add(nodes->m_starts[at], displacements[at]);
        positions[k] = vec3AddScaled(position, vec3Sub(nodes->m_carried[at], nodes->m_starts[at]), 1.0f - passed);
    }
    if (!planeOfFace(positions, found->m_point, found->m_normal, plane)) return 0;
    if (nodes->m_count == 2) joinCorners(plane->m_weights);
    setPlane(contact, nodes, plane);
    return 1;
}

// Removes from the nodes' velocities what the contact gained by recovering a depth that the step began with. Returns
// the impulse that it takes back along the normal, N s.
DRAPE_FUNCTION float limitSpeed(const ActingContact* contact, DRAPE_GLOBAL NodeState* states)
{
    const ContactRow* row = &contact->m_row;
    float speed = 0.0f;
    for (DRAPE_UINT k = 0; k < row->m_count; ++k)
        speed += vec3Dot(states[row->m_nodes[k]].m_velocity, row->m_normal) * row->m_weights[k];
    const float excess = speed - contact->m_speedLimit;
    // A renewed plane may rest on pinned nodes alone.
    if (!(excess > 0.0f) || !(row->m_inverseMobility > 0.0f)) return 0.0f;
    for (DRAPE_UINT k = 0; k < row->m_count; ++k)
    {
        DRAPE_GLOBAL NodeState* state = states + row->m_nodes[k];
        const Vec3 loss = vec3Scale(row->m_normal, -(row->m_shares[k] * excess * row->m_inverseMobility));
        state->m_velocity = vec3Add(state->m_velocity, loss);
        state->m_shifted |= DRAPE_NODE_SHIFTED;
    }
    return excess * row->m_inverseMobility;
}

DRAPE_NAMESPACE_END

#endif
