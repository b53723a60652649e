// Packs the obstacles' features for the culls (patch_cull_simd.cl, patch_cull_pairs_gpu.cl), and the wide tree over
// their patches, after an obstacle was added or moved.
#include "../lib/broad_phase/cone_reach.h"
#include "../lib/broad_phase/feature_cull.h"
#include "../lib/step_data/step_views.h"

// Positions that are invalid become NaN.
static Vec3 packedPosition(__global const float* positions, const uint vertex, const int used)
{
    const Vec3 none = vec3(NAN, NAN, NAN);
    if (!used) return none;
    const Vec3 p = vec3Load(positions, vertex);
    return positionIsValid(p) ? p : none;
}

static void packVec3(__global float* out, const uint first, const Vec3 v)
{
    out[first * DRAPE_PATCH_WIDTH] = v.x;
    out[(first + 1) * DRAPE_PATCH_WIDTH] = v.y;
    out[(first + 2) * DRAPE_PATCH_WIDTH] = v.z;
}

// A triangle's normal (faceCone()) and the cones of its corners and edges.
typedef struct FaceCones
{
    NormalCone m_face, m_around[6];
} FaceCones;

static FaceCones conesOf(const ObstacleView* obstacle, const uint index)
{
    __global const Triangle* triangle = obstacle->m_triangles + index;
    FaceCones cones;
    Vec3 p[3];
    for (int k = 0; k < 3; ++k)
    {
        p[k] = vec3Load(obstacle->m_positions, triangle->m_vertices[k]);
        cones.m_around[k] = obstacle->m_vertexCones[triangle->m_vertices[k]];
        cones.m_around[3 + k] = obstacle->m_edgeCones[triangle->m_edges[k]];
    }
    cones.m_face = faceCone(p);
    return cones;
}

// Packs lane i of the face blocks.
static void packFace(const ObstacleView* obstacle, __global const uint* owners, const uint i, __global float* faces)
{
    const int used = owners[i] != DRAPE_NO_FEATURE;
    const uint owner = used ? owners[i] : 0;
    __global float* out =
        faces + (i / DRAPE_PATCH_WIDTH) * DRAPE_FACE_FLOATS * DRAPE_PATCH_WIDTH + i % DRAPE_PATCH_WIDTH;
    __global const Triangle* triangle = obstacle->m_triangles + owner;
    for (int k = 0; k < 3; ++k)
        packVec3(out, 3 * k, packedPosition(obstacle->m_positions, triangle->m_vertices[k], used));
    const FaceCones cones = conesOf(obstacle, owner);
    out[9 * DRAPE_PATCH_WIDTH] = used ? faceSpread(cones.m_face, cones.m_around) : 0.0f;
}

// Packs lane i of the vertex blocks. ids: the vertex of each lane.
static void packVertex(const ObstacleView* obstacle, __global const uint* owners, const uint i,
                       __global float* vertices, __global uint* ids)
{
    __global float* out =
        vertices + (i / DRAPE_PATCH_WIDTH) * DRAPE_VERTEX_FLOATS * DRAPE_PATCH_WIDTH + i % DRAPE_PATCH_WIDTH;
    const uint owner = owners[i] & ((1u << DRAPE_CORNER_SHIFT) - 1u), corner = owners[i] >> DRAPE_CORNER_SHIFT;
    const int used = owners[i] != DRAPE_NO_FEATURE;
    const uint vertex = used ? obstacle->m_triangles[owner].m_vertices[corner] : 0;
    const NormalCone cone = obstacle->m_vertexCones[vertex];
    ids[i] = vertex;
    packVec3(out, 0, packedPosition(obstacle->m_positions, vertex, used));
    packVec3(out, 3, cone.m_axis);
    out[6 * DRAPE_PATCH_WIDTH] = cone.m_cosine;
}

// Packs lane i of the edge blocks. ids: the edge of each lane.
static void packEdge(const ObstacleView* obstacle, __global const uint* owners, const uint i, __global float* edges,
                     __global uint* ids)
{
    __global float* out =
        edges + (i / DRAPE_PATCH_WIDTH) * DRAPE_EDGE_FLOATS * DRAPE_PATCH_WIDTH + i % DRAPE_PATCH_WIDTH;
    const int used = owners[i] != DRAPE_NO_FEATURE;
    const uint owner = used ? owners[i] & ((1u << DRAPE_CORNER_SHIFT) - 1u) : 0;
    const uint corner = used ? owners[i] >> DRAPE_CORNER_SHIFT : 0;
    __global const Triangle* triangle = obstacle->m_triangles + owner;
    const uint edge = triangle->m_edges[corner], next = corner == 2 ? 0 : corner + 1;
    const NormalCone cone = obstacle->m_edgeCones[edge];
    ids[i] = edge;
    packVec3(out, 0, packedPosition(obstacle->m_positions, triangle->m_vertices[corner], used));
    packVec3(out, 3, packedPosition(obstacle->m_positions, triangle->m_vertices[next], used));
    packVec3(out, 6, cone.m_axis);
    out[9 * DRAPE_PATCH_WIDTH] = cone.m_cosine;
}

// A child of a wide node: its volume and, along each direction, the reach of a contact of its features as a share of
// the reach.
typedef struct WideChild
{
    Dop m_volume;
    float m_reach[DRAPE_DOP_DIRECTIONS];
} WideChild;

static void wideStore(__global float* restrict wideNodes, const uint child, const WideChild* value)
{
    __global float* out = wideNodes + (child / DRAPE_PATCH_WIDTH) * DRAPE_WIDE_NODE_FLOATS * DRAPE_PATCH_WIDTH +
                          child % DRAPE_PATCH_WIDTH;
    for (int k = 0; k < DRAPE_DOP_DIRECTIONS; ++k)
    {
        out[k * DRAPE_PATCH_WIDTH] = value->m_volume.m_low[k];
        out[(DRAPE_DOP_DIRECTIONS + k) * DRAPE_PATCH_WIDTH] = value->m_volume.m_high[k];
        out[(2 * DRAPE_DOP_DIRECTIONS + k) * DRAPE_PATCH_WIDTH] = value->m_reach[k];
    }
}

// The triangles of a patch, without empty lanes.
typedef struct PatchFaces
{
    __global const uint* m_owners;
    uint m_first, m_last;
} PatchFaces;

// Returns a cone around all directions that the patch's faces, edges and vertices admit.
static NormalCone patchCone(const ObstacleView* obstacle, const PatchFaces* faces)
{
    Vec3 axis = vec3(0.0f, 0.0f, 0.0f);
    for (uint i = faces->m_first; i < faces->m_last; ++i)
    {
        const FaceCones cones = conesOf(obstacle, faces->m_owners[i]);
        if (!(cones.m_face.m_cosine > 0.0f)) return cones.m_face;
        axis = vec3Add(axis, cones.m_face.m_axis);
    }
    const float length = vec3Length(axis);
    if (!(length > 0.5f)) return normalCone(axis, -1.0f);
    axis = vec3Scale(axis, 1.0f / length);
    float cosine = 1.0f;
    for (uint i = faces->m_first; i < faces->m_last && cosine > 0.0f; ++i)
    {
        const FaceCones cones = conesOf(obstacle, faces->m_owners[i]);
        cosine = drapeMin(cosine, cosineAround(axis, cones.m_face));
        cosine = drapeMin(cosine, cosineOfCones(axis, cones.m_around));
    }
    return normalCone(axis, cosine - DRAPE_CONE_PAD);
}

static void growVolume(Dop* dop, const Dop* other)
{
    for (int k = 0; k < DRAPE_DOP_DIRECTIONS; ++k)
    {
        dop->m_low[k] = drapeMin(dop->m_low[k], other->m_low[k]);
        dop->m_high[k] = drapeMax(dop->m_high[k], other->m_high[k]);
    }
}

// Packs a child position of the wide tree's lowest level: a patch, or none from patchCount on. Writes the tree's data
// of the patch, on a CPU also as adjacent volumes, and its size, m. The volume is grown by a share of the size, which
// covers the directions of contacts that are rounding noise (see feature_cull.h).
static void packVolume(const ObstacleView* obstacle, __global const uint* faceOwners, const uint patchCount,
                       const uint patch, __global float* wideNodes, __global float* sizes, __global float* volumes)
{
    WideChild child;
    dopClear(&child.m_volume);
    PatchFaces faces = {faceOwners, patch * DRAPE_PATCH_WIDTH, patch * DRAPE_PATCH_WIDTH};
    while (patch < patchCount && faces.m_last < (patch + 1) * DRAPE_PATCH_WIDTH &&
           faceOwners[faces.m_last] != DRAPE_NO_FEATURE)
    {
        Dop one;
        triangleVolume(&one, obstacle->m_triangles + faceOwners[faces.m_last++], obstacle->m_positions,
                       obstacle->m_positions, 0.0f);
        growVolume(&child.m_volume, &one);
    }
    float size = 0.0f;
    for (int k = 0; k < 3; ++k)
        size += drapeMax(child.m_volume.m_high[k] - child.m_volume.m_low[k], 0.0f);
    const NormalCone cone = patchCone(obstacle, &faces);
    for (int k = 0; k < DRAPE_DOP_DIRECTIONS; ++k)
    {
        child.m_volume.m_low[k] -= DRAPE_CULL_NOISE * size * dopNorm(k);
        child.m_volume.m_high[k] += DRAPE_CULL_NOISE * size * dopNorm(k);
        child.m_reach[k] = coneReach(cone, k);
    }
    wideStore(wideNodes, patch, &child);
    if (patch >= patchCount) return;
    sizes[patch] = size;
#if DRAPE_LANES > 1
    __global float* out = volumes + patch * DRAPE_WIDE_NODE_FLOATS;
    for (int k = 0; k < DRAPE_DOP_DIRECTIONS; ++k)
    {
        out[k] = child.m_volume.m_low[k];
        out[DRAPE_DOP_DIRECTIONS + k] = child.m_volume.m_high[k];
        out[2 * DRAPE_DOP_DIRECTIONS + k] = child.m_reach[k];
    }
#endif
}

// Writes number `row` of a child position of one level: `node` of the level below, or none from nodeCount on. below
// and level: that level's nodes and this one's.
static void widenChild(__global float* wideNodes, const uint below, const uint nodeCount, const uint level,
                       const uint node, const uint row)
{
    const int isLow = row < DRAPE_DOP_DIRECTIONS, isHigh = !isLow && row < 2 * DRAPE_DOP_DIRECTIONS;
    float joined = isLow ? DRAPE_INFINITY : isHigh ? -DRAPE_INFINITY : 0.0f;
    __global const float* lanes = wideNodes + ((below + node) * DRAPE_WIDE_NODE_FLOATS + row) * DRAPE_PATCH_WIDTH;
    for (uint lane = 0; lane < DRAPE_PATCH_WIDTH && node < nodeCount; ++lane)
        joined = isLow ? drapeMin(joined, lanes[lane]) : drapeMax(joined, lanes[lane]);
    wideNodes[((level + node / DRAPE_PATCH_WIDTH) * DRAPE_WIDE_NODE_FLOATS + row) * DRAPE_PATCH_WIDTH +
              node % DRAPE_PATCH_WIDTH] = joined;
}

#ifdef __OPENCL_VERSION__
#include "../lib/step_data/arena_views.h"
#include "scene_bindings.h"

// Packs a lane per work-item, from values.m_first up to m_last.
__kernel void patchPackFaces(DRAPE_PATCH_PACK_FACES)
{
    const uint i = values.m_first + get_global_id(0);
    if (i >= values.m_last) return;
    const ObstacleView obstacle = obstacleAt(obstacles, &values.m_obstacle);
    packFace(&obstacle, (__global const uint*)(patches + values.m_patches.m_faceIds), i,
             (__global float*)(patches + values.m_patches.m_faces));
}

__kernel void patchPackVertices(DRAPE_PATCH_PACK_OWNED)
{
    const uint i = values.m_first + get_global_id(0);
    if (i >= values.m_last) return;
    const ObstacleView obstacle = obstacleAt(obstacles, &values.m_obstacle);
    packVertex(&obstacle, owners, i, (__global float*)(patches + values.m_patches.m_vertices),
               (__global uint*)(patches + values.m_patches.m_vertexIds));
}

__kernel void patchPackEdges(DRAPE_PATCH_PACK_OWNED)
{
    const uint i = values.m_first + get_global_id(0);
    if (i >= values.m_last) return;
    const ObstacleView obstacle = obstacleAt(obstacles, &values.m_obstacle);
    packEdge(&obstacle, owners, i, (__global float*)(patches + values.m_patches.m_edges),
             (__global uint*)(patches + values.m_patches.m_edgeIds));
}

// Packs a child position per work-item, from values.m_first up to m_last.
__kernel void patchVolumes(DRAPE_PATCH_PACK_FACES)
{
    const uint patch = values.m_first + get_global_id(0);
    if (patch >= values.m_last) return;
    const ObstacleView obstacle = obstacleAt(obstacles, &values.m_obstacle);
    packVolume(&obstacle, (__global const uint*)(patches + values.m_patches.m_faceIds), values.m_count, patch,
               (__global float*)(patches + values.m_patches.m_wideNodes),
               (__global float*)(patches + values.m_patches.m_sizes),
               (__global float*)(patches + values.m_patches.m_volumes));
}

// Writes one number of a child position per work-item, from values.m_first up to m_last.
__kernel void patchWiden(DRAPE_PATCH_WIDEN)
{
    const uint node = values.m_first + get_global_id(0) / DRAPE_WIDE_NODE_FLOATS;
    if (node >= values.m_last) return;
    widenChild((__global float*)(patches + values.m_wideNodes), values.m_below, values.m_count, values.m_level, node,
               get_global_id(0) % DRAPE_WIDE_NODE_FLOATS);
}
#endif
