#include "drape/debug_draw.h"

#include <algorithm>
#include <cmath>

#include "BulletSoftBody/btSoftBody.h"
#include "LinearMath/btIDebugDraw.h"
#include "bullet_plugin/adapter/debug_draw/near_patches.h"
#include "bullet_plugin/adapter/wiring/plugin_state.h"
#include "bullet_plugin/core/public_call.h"
#include "drape/plugin.h"

namespace drape
{
namespace
{
const btVector3 kTooClose(1, btScalar(0.15), btScalar(0.1)), kResting(1, btScalar(0.9), btScalar(0.1)),
    kNear(btScalar(0.2), btScalar(0.8), btScalar(0.3)), kPushed(1, btScalar(0.55), 0),
    kPatch(btScalar(0.35), btScalar(0.7), 1), kFlagged(1, 0, 1);

// Deviation from the resting distance, as a share of the thickness, from which a contact counts as near or too close.
constexpr float kRestingShare = 0.05f;

struct Line
{
    btVector3 m_from, m_to, m_colour;
};

// A contact to be drawn.
struct DrawnContact
{
    btVector3 m_point, m_cloth, m_normal, m_impulse;  // m, m, unit, N s
    btScalar m_gap, m_thickness;                      // m
    bool m_pushed;
};

btVector3 vectorOf(const float v[3])
{
    return btVector3(btScalar(v[0]), btScalar(v[1]), btScalar(v[2]));
}

btVector3 placeOf(const btSoftBody& body, const int nodes[3], const float weights[3])
{
    btVector3 place(0, 0, 0);
    for (int k = 0; k < 3 && nodes[k] >= 0; ++k)
        place += body.m_nodes[nodes[k]].m_x * btScalar(weights[k]);
    return place;
}

std::vector<DrawnContact> contactsOf(const PluginState& state)
{
    std::vector<DrawnContact> drawn;
    for (const StepContact& contact : state.m_records.list())
    {
        const btVector3 cloth = placeOf(*contact.m_cloth.m_body, contact.m_cloth.m_nodes, contact.m_cloth.m_weights);
        const btVector3 point = contact.m_other.m_body ? placeOf(*contact.m_other.m_body, contact.m_other.m_nodes,
                                                                 contact.m_other.m_weights)
                                                       : vectorOf(contact.m_point);
        const btVector3 impulse = vectorOf(contact.m_impulse);
        drawn.push_back({point, cloth, vectorOf(contact.m_normal), impulse, btScalar(contact.m_gap),
                         btScalar(contact.m_thickness), impulse.length2() > 0});
    }
    if (state.m_records.isOn()) return drawn;
    for (const ContactInfo& contact : state.m_found.list())
    {
        const btVector3 cloth = placeOf(*contact.m_cloth, contact.m_nodes, contact.m_weights);
        const btVector3 point = vectorOf(contact.m_point), normal = vectorOf(contact.m_normal);
        const btScalar thickness = btScalar(contact.m_thickness), gap = normal.dot(cloth - point) - thickness;
        drawn.push_back({point, cloth, normal, btVector3(0, 0, 0), gap, thickness, false});
    }
    return drawn;
}

btVector3 colourOf(const DrawnContact& contact)
{
    if (contact.m_gap < -kRestingShare * contact.m_thickness) return kTooClose;
    if (contact.m_pushed) return kPushed;
    return contact.m_gap > kRestingShare * contact.m_thickness ? kNear : kResting;
}

void addContact(const DrawnContact& contact, unsigned flags, const DebugDrawOptions& options, btScalar mostImpulse,
                std::vector<Line>& lines)
{
    const btVector3 colour = colourOf(contact);
    const btScalar half = contact.m_thickness * options.m_crossScale;
    for (int axis = 0; axis < 3 && (flags & kDrawContacts); ++axis)
    {
        btVector3 arm(0, 0, 0);
        arm[axis] = half;
        lines.push_back({contact.m_point - arm, contact.m_point + arm, colour});
    }
    if (flags & kDrawGaps) lines.push_back({contact.m_point, contact.m_cloth, colour});
    if (!(flags & (kDrawNormals | kDrawImpulses))) return;
    const bool byImpulse = (flags & kDrawImpulses) != 0;
    const btVector3 direction =
        byImpulse ? contact.m_impulse / btMax(mostImpulse, btScalar(SIMD_EPSILON)) : contact.m_normal;
    if (direction.length2() > 0)
        lines.push_back(
            {contact.m_point, contact.m_point + direction * (contact.m_thickness * options.m_normalScale), colour});
}

// Adds the edges of a triangle, an edge or a point.
void addEdges(const btVector3* corners, int count, const btVector3& colour, std::vector<Line>& lines)
{
    for (int k = 0; k < count && count > 1; ++k)
        if (count == 3 || k == 0) lines.push_back({corners[k], corners[(k + 1) % count], colour});
}

void addFeature(const btSoftBody& body, const int nodes[3], std::vector<Line>& lines)
{
    btVector3 corners[3];
    int count = 0;
    while (count < 3 && nodes[count] >= 0)
    {
        corners[count] = body.m_nodes[nodes[count]].m_x;
        ++count;
    }
    addEdges(corners, count, kFlagged, lines);
}

void addFlagged(const FlaggedPair& pair, std::vector<Line>& lines)
{
    addFeature(*pair.m_body, pair.m_nodes, lines);
    if (pair.m_otherBody) return addFeature(*pair.m_otherBody, pair.m_otherNodes, lines);
    const btVector3 corners[3] = {vectorOf(pair.m_corners[0]), vectorOf(pair.m_corners[1]),
                                  vectorOf(pair.m_corners[2])};
    addEdges(corners, 3, kFlagged, lines);
}

std::vector<Line> linesOf(const PluginState& state, unsigned flags, const DebugDrawOptions& options)
{
    std::vector<Line> lines;
    if (!state.ready()) return lines;
    if (flags & kDrawPatches)
        for (const DrawnTriangle& triangle : nearTriangles(state))
            addEdges(triangle.data(), 3, kPatch, lines);
    if (flags & (kDrawContacts | kDrawNormals | kDrawGaps | kDrawImpulses))
    {
        const std::vector<DrawnContact> contacts = contactsOf(state);
        btScalar most = 0;
        for (const DrawnContact& contact : contacts)
            most = btMax(most, contact.m_impulse.length());
        for (const DrawnContact& contact : contacts)
            addContact(contact, flags, options, most, lines);
    }
    if (flags & kDrawFlagged)
        for (const FlaggedPair& pair : state.m_flagged)
            addFlagged(pair, lines);
    return lines;
}
}  // namespace

void debugDraw(const Plugin& plugin, btIDebugDraw& drawer, unsigned flags, const DebugDrawOptions& options)
{
    if (!plugin.state()) return;
    const PluginState& state = *plugin.state();
    const std::vector<Line> lines = guardedOr(std::vector<Line>(), [&] { return linesOf(state, flags, options); });
    for (const Line& line : lines)
        drawer.drawLine(line.m_from, line.m_to, line.m_colour);
}
}  // namespace drape
