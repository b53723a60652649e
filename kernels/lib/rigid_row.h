// Rows of a cloth's nodes beside rigid bodies (core/solver/rigid_rows.h): what a projection pushes.
#ifndef DRAPE_LIB_RIGID_ROW_H
#define DRAPE_LIB_RIGID_ROW_H

#include "../shared/solver.h"
#include "vec3.h"

DRAPE_NAMESPACE_BEGIN

// Projects a node's contact with a plane of a body. way: m, of the node relative to the body's point in the step.
// inverseMass: of the node, 1/kg, > 0. mobility: of the body's point along the normal, 1/kg. passed: the share of the
// step that has passed. Returns whether the row pushes, with the push of the node in *by, kg m.
DRAPE_FUNCTION int rigidContactPush(const RigidPlane* plane, RigidHold* hold, Vec3 way, float inverseMass,
                                    float mobility, float passed, Vec3* by)
{
    const float inverseMobility = 1.0f / drapeMax(inverseMass + mobility, 1e-30f);
    const float along = vec3Dot(plane->m_normal, way);
    const float level = plane->m_gap < 0.0f ? plane->m_recover * passed : -plane->m_gap;
    const float violation = level - along;
    if (!(violation > 0.0f) && !(hold->m_multiplier > 0.0f)) return 0;
    const float pushed = drapeMax(0.0f, hold->m_multiplier + violation * inverseMobility);
    Vec3 held = vec3AddScaled(hold->m_held, vec3AddScaled(way, plane->m_normal, -along), -inverseMobility);
    const float most = plane->m_friction * pushed, wanted = vec3Length(held);
    if (wanted > most) held = vec3Scale(held, most / wanted);
    *by = vec3AddScaled(vec3Sub(held, hold->m_held), plane->m_normal, pushed - hold->m_multiplier);
    hold->m_multiplier = pushed;
    hold->m_held = held;
    return 1;
}

// Returns the push along an axis that brings an anchored node towards its point, kg m. error: m, from the node to the
// point along the axis. share: of it that is corrected. both: inverse mass of the node and mobility of the body, 1/kg.
DRAPE_FUNCTION float rigidAnchorPush(float error, float share, float both)
{
    return both > 0.0f ? share * error / both : 0.0f;
}

DRAPE_NAMESPACE_END

#endif
