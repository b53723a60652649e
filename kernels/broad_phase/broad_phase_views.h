// Views of a step's data in the broad phase's kernels. For devices only.
#ifndef DRAPE_BROAD_PHASE_VIEWS_H
#define DRAPE_BROAD_PHASE_VIEWS_H

#include "../lib/step_data/arena_views.h"
#include "broad_phase_bindings.h"

static StepCloths stepCloths(const CullValues* values, __global const float* nodes, __global const ClothWord* cloths,
                             __global const float* radius, __global const float* thickness,
                             __global const ObstacleMotion* motions)
{
    StepCloths step;
    step.m_cloth = clothAt(nodes, cloths, &values->m_cloth, values->m_mode, 0);
    step.m_order = (__global const uint*)(cloths + values->m_cloth.m_order);
    step.m_count = values->m_cloth.m_triangleCount;
    step.m_radius = radius;
    step.m_thickness = thickness;
    step.m_obstacleMeshes = values->m_obstacleMeshes;
    step.m_reachScale = values->m_reachScale;
    step.m_motions = motions;
    step.m_motionCount = values->m_motionCount;
    return step;
}

#endif
