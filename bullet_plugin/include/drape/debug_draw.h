// Draws what Drape found and did in the last step with any drawer of Bullet's: contacts, gaps, obstacle triangles that
// take part, and pairs that the step could not keep apart. C++11.
//
//   world.debugDrawWorld();
//   drape::debugDraw(plugin, *world.getDebugDrawer());
#pragma once

#include "drape/export.h"

class btIDebugDraw;

namespace drape
{
class Plugin;

// Selects what debugDraw() draws. Combine with |.
enum DebugDrawFlags : unsigned
{
    // A cross at each contact's point. Green is a contact that is near, yellow one at its resting distance, red one
    // that is too close. With recorded impulses (Plugin::recordContacts()) an orange cross is a contact that pushed.
    kDrawContacts = 1,
    // A line from each contact's point along its normal, in the same colour. Its length is the thickness times
    // DebugDrawOptions::m_normalScale, or follows the impulse, see kDrawImpulses.
    kDrawNormals = 2,
    // A line from the obstacle's point to the cloth's point, in the contact's colour.
    kDrawGaps = 4,
    // The edges of obstacle patches of 16 triangles whose box is within reach of a cloth's triangle at the step's end,
    // in light blue. The search also covers the paths over the step.
    kDrawPatches = 8,
    // The triangles and edges of each pair that the last step could not keep apart (Plugin::flaggedPairs()), in
    // magenta. Single nodes are not drawn.
    kDrawFlagged = 16,
    // The lines of kDrawNormals, which this implies, show the impulse, without contacts that did not push: its
    // direction, friction included, and a length by its share of the greatest one in the step. Needs recorded impulses.
    kDrawImpulses = 32,

    kDrawDefault = kDrawContacts | kDrawNormals | kDrawFlagged,
    kDrawEverything = 63
};

// Sizes of what is drawn.
struct DebugDrawOptions
{
    // Length of a normal, in thicknesses of the pair; of the greatest impulse with kDrawImpulses.
    float m_normalScale = 3;
    // Half the size of a cross, in thicknesses.
    float m_crossScale = 0.4f;
};

// Draws the last step of any world of the plugin, by calls of drawLine() in world coordinates. Call between steps,
// before soft bodies and obstacles of that step are removed. flags: DebugDrawFlags. Draws nothing if Drape is off or
// memory runs out. Exceptions of the drawer pass through. Without recorded contacts there are none of cloth with cloth.
// Cost: linear in the contacts; kDrawPatches takes milliseconds for large meshes.
DRAPE_EXPORT void debugDraw(const Plugin& plugin, btIDebugDraw& drawer, unsigned flags = kDrawDefault,
                            const DebugDrawOptions& options = DebugDrawOptions());
}  // namespace drape
