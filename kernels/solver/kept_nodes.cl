// Predicts cloths whose nodes stay on the device, with the bits of the adapter's prediction, and keeps their results.
//
// Work-items share the nodes of each cloth: as many of them as launch.m_lanes.
#include "../lib/geometry/vec3.h"
#include "../lib/solver/solver_node.h"
#include "solver_bindings.h"

typedef struct Predicted
{
    Vec3 m_acceleration;  // m/s²
    Vec3 m_free;          // m, the end by Bullet's prediction
    Vec3 m_end;           // m, by that of substeps
    Vec3 m_vector;        // m, to it, without the rounding of positions
} Predicted;

static Predicted predict(__global const KeptCloth* cloth, const KeptNode* node)
{
    const Vec3 before = node->m_velocity;
    Vec3 velocity = node->m_inverseMass > 0.0f ? vec3Add(before, cloth->m_gravity) : before;
    velocity = vec3Add(velocity, vec3(0.0f, 0.0f, 0.0f));  // by forces; turns -0 into 0
    const Vec3 moved = vec3Scale(velocity, cloth->m_time);
    Predicted predicted;
    predicted.m_acceleration = vec3Scale(vec3Sub(velocity, before), cloth->m_perSecond);
    const Vec3 shift =
        vec3AddScaled(vec3Scale(predicted.m_acceleration, cloth->m_shift), node->m_support, cloth->m_supportShift);
    predicted.m_free = vec3Add(node->m_position, moved);
    predicted.m_end = vec3Add(predicted.m_free, shift);
    predicted.m_vector = vec3Add(moved, shift);
    return predicted;
}

static void store(__global float* to, const uint node, const Vec3 v)
{
    to[3 * node] = v.x;
    to[3 * node + 1] = v.y;
    to[3 * node + 2] = v.z;
}

// Writes the paths for the detection.
__kernel void predictKept(DRAPE_PREDICT_KEPT)
{
    __global const KeptCloth* cloth = cloths + get_global_id(0) / launch.m_lanes;
    if (get_global_id(0) / launch.m_lanes >= launch.m_cloths || cloth->m_start == DRAPE_NOT_DETECTED) return;
    for (uint i = get_global_id(0) % launch.m_lanes; i < cloth->m_count; i += launch.m_lanes)
    {
        const KeptNode node = kept[cloth->m_before + i];
        store(detected + cloth->m_start, i, node.m_position);
        store(detected + cloth->m_end, i, predict(cloth, &node).m_end);
    }
}

// Writes the paths for the solver, in the order of its nodes.
__kernel void takeKeptPaths(DRAPE_SOLVE_KEPT)
{
    __global const KeptCloth* cloth = cloths + get_global_id(0) / launch.m_lanes;
    if (get_global_id(0) / launch.m_lanes >= launch.m_cloths) return;
    __global const uint* nodeOrder = (__global const uint*)(topology + layout.m_nodeOrder) + cloth->m_solved;
    __global NodePath* paths = (__global NodePath*)(work + layout.m_paths) + cloth->m_solved;
    __global Vec3* accelerations = (__global Vec3*)(work + layout.m_accelerations) + cloth->m_solved;
    __global Vec3* supports = (__global Vec3*)(work + layout.m_supports) + cloth->m_solved;
    for (uint i = get_global_id(0) % launch.m_lanes; i < cloth->m_count; i += launch.m_lanes)
    {
        const KeptNode node = kept[cloth->m_before + (nodeOrder[i] - cloth->m_solved)];
        const Predicted predicted = predict(cloth, &node);
        NodePath path;
        path.m_start = node.m_position;
        path.m_vector = predicted.m_vector;
        path.m_inverseMass = path.m_freeMass = node.m_inverseMass;
        paths[i] = path;
        accelerations[i] = predicted.m_acceleration;
        supports[i] = node.m_support;
    }
}

typedef struct Bounds
{
    uint m_low[3 * DRAPE_KEPT_BOXES], m_high[3 * DRAPE_KEPT_BOXES];
    int m_isInvalid, m_isOffPath;
} Bounds;

static void addTo(Bounds* all, const uint box, const Vec3 v)
{
    const float numbers[3] = {v.x, v.y, v.z};
    for (uint axis = 0; axis < 3; ++axis)
    {
        const uint key = orderedBits(as_uint(numbers[axis])), at = 3 * box + axis;
        all->m_low[at] = min(all->m_low[at], key);
        all->m_high[at] = max(all->m_high[at], key);
        all->m_isInvalid |= !drapeIsFinite(numbers[axis]);
    }
}

// Keeps the step's result, and bounds the next step for the same time and gravity.
__kernel void keepNodes(DRAPE_SOLVE_KEPT, DRAPE_UPDATES(KeptBounds, bounds))
{
    const uint index = get_global_id(0) / launch.m_lanes;
    if (index >= launch.m_cloths) return;
    __global const KeptCloth* cloth = cloths + index;
    __global const uint* nodeOrder = (__global const uint*)(topology + layout.m_nodeOrder) + cloth->m_solved;
    __global const NodePath* paths = (__global const NodePath*)(work + layout.m_paths) + cloth->m_solved;
    __global const Vec3* accelerations = (__global const Vec3*)(work + layout.m_accelerations) + cloth->m_solved;
    __global const SolverNode* ends = (__global const SolverNode*)(work + layout.m_nodes) + cloth->m_solved;
    __global const NodeState* states = (__global const NodeState*)(work + layout.m_states) + cloth->m_solved;
    Bounds all;
    for (uint k = 0; k < 3 * DRAPE_KEPT_BOXES; ++k)
    {
        all.m_low[k] = 0xffffffffu;
        all.m_high[k] = 0u;
    }
    all.m_isInvalid = all.m_isOffPath = 0;
    for (uint i = get_global_id(0) % launch.m_lanes; i < cloth->m_count; i += launch.m_lanes)
    {
        const NodePath path = paths[i];
        const Vec3 displacement = ends[i].m_displacement, off = vec3Sub(displacement, path.m_vector);
        const uint at = nodeOrder[i] - cloth->m_solved;
        const Vec3 before = kept[cloth->m_before + at].m_velocity;
        KeptNode node;
        node.m_position = vec3Add(path.m_start, displacement);
        node.m_inverseMass = path.m_freeMass;
        node.m_velocity = states[i].m_velocity;
        node.m_support = nodeSupport(states + i, before, accelerations[i], cloth->m_perSecond, cloth->m_leastThickness);
        node.m_unused = node.m_unusedToo = 0.0f;
        kept[cloth->m_after + at] = node;
        const Predicted predicted = predict(cloth, &node);
        addTo(&all, 0, node.m_position);
        addTo(&all, 1, predicted.m_free);
        addTo(&all, 2, predicted.m_end);
        all.m_isOffPath |= vec3Dot(off, off) > cloth->m_mostOffPath * cloth->m_mostOffPath;
    }
    for (uint k = 0; k < 3 * DRAPE_KEPT_BOXES; ++k)
    {
        atomic_min(bounds[index].m_low + k, all.m_low[k]);
        atomic_max(bounds[index].m_high + k, all.m_high[k]);
    }
    if (all.m_isInvalid) bounds[index].m_isInvalid = 1;
    if (all.m_isOffPath) bounds[index].m_isOffPath = 1;
}
