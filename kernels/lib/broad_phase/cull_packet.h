// Volumes of a packet of cloth triangles, one per lane; a GPU's traversal (patch_traversal_gpu.cl) makes the same for
// one triangle, see cull_volume.h. Also the volumes of one triangle's nodes and edges, with one direction per lane.
#ifndef DRAPE_LIB_CULL_PACKET_H
#define DRAPE_LIB_CULL_PACKET_H

#include "cull_volume.h"

DRAPE_NAMESPACE_BEGIN

// See CullVolume. Intervals are padded by m_noise along a direction of length 1, and by m_rounding.
typedef struct CullVolumes
{
    Lanes m_low[DRAPE_DOP_DIRECTIONS], m_high[DRAPE_DOP_DIRECTIONS];
    Lanes m_radius, m_least;
    Lanes m_noise, m_rounding;  // m
} CullVolumes;

// Bound on the rounding errors of a volume, for positions whose |x| + |y| + |z| is at most 1: the bound of
// dopGrowInterval() and cullInterval(), with that sum in place of every projection.
#define DRAPE_PACKET_PAD 6.1e-7f

// Motion of a packet's triangles. m_stays: triangles that are not swept; m_moved: m, squared, of the fastest corner.
typedef struct PacketMotion
{
    LaneMask m_stays;
    Lanes m_moved;
} PacketMotion;

// See isSwept(). p: as for cullVolumes(); e0, e1: edges from the first corner at the end.
DRAPE_FUNCTION PacketMotion packetMotion(const LanesVec3* p, LanesVec3 e0, LanesVec3 e1, Lanes radius, DRAPE_UINT mode)
{
    PacketMotion motion;
    motion.m_moved = lanesSplat(0.0f);
    for (int k = 0; k < 3 && mode != DRAPE_DISCRETE; ++k)
    {
        const LanesVec3 displacement = lanesSub(p[3 + k], p[k]);
        motion.m_moved = lanesMax(motion.m_moved, lanesDot(displacement, displacement));
    }
    const Lanes small = 0.9f * radius - 2e-5f * (lanesNorm1(e0) + lanesNorm1(e1));
    const LaneMask automatic = lanesMaskSplat(mode == DRAPE_AUTOMATIC);
    motion.m_stays =
        (automatic & (small > 0.0f) & (motion.m_moved <= small * small)) | lanesMaskSplat(mode == DRAPE_DISCRETE);
    return motion;
}

// Positions along a direction. With three terms not rounded as dopProject() does, but by no more than the sum of all of
// a position's coordinates in the place of dopInner()'s.
DRAPE_FUNCTION Lanes projectLanes(LanesVec3 p, int i)
{
    const Vec3 direction = vec3(dopProject(vec3(1.0f, 0.0f, 0.0f), i), dopProject(vec3(0.0f, 1.0f, 0.0f), i),
                                dopProject(vec3(0.0f, 0.0f, 1.0f), i));
    return lanesDotUniform(p, direction);
}

// Computes the corners' intervals along every direction, without any padding. Returns the sum of those along the axes,
// m.
DRAPE_FUNCTION Lanes packetIntervals(CullVolumes* cull, const LanesVec3* p)
{
    Lanes size = lanesSplat(0.0f);
    DRAPE_UNROLL
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        Lanes low = projectLanes(p[0], i), high = low;
        DRAPE_UNROLL
        for (int k = 1; k < 6; ++k)
        {
            const Lanes v = projectLanes(p[k], i);
            low = lanesMin(low, v);
            high = lanesMax(high, v);
        }
        if (i < 3) size += high - low;
        cull->m_low[i] = low;
        cull->m_high[i] = high;
    }
    return size;
}

// p: corners at the step's start relative to the obstacle, then at its end, all valid; unswept triangles lose the
// starts. whole: false for a triangle in which another corner replaces an invalid one. Returns the triangles that may
// come near the obstacle; others, and those of negative radius, get an empty volume.
DRAPE_FUNCTION LaneMask cullVolumes(CullVolumes* cull, LanesVec3* p, Lanes radius, LaneMask whole, DRAPE_UINT mode,
                                    const DRAPE_GLOBAL ObstacleMotion* motion)
{
    const LanesVec3 e0 = lanesSub(p[4], p[3]), e1 = lanesSub(p[5], p[3]), e2 = lanesSub(p[5], p[4]);
    const PacketMotion packet = packetMotion(p, e0, e1, radius, mode);
    const LaneMask stays = packet.m_stays;
    Lanes farthest = lanesSplat(0.0f);
    for (int k = 0; k < 3; ++k)
    {
        p[k] = lanesVec3(lanesSelect(stays, p[3 + k].x, p[k].x), lanesSelect(stays, p[3 + k].y, p[k].y),
                         lanesSelect(stays, p[3 + k].z, p[k].z));
        farthest = lanesMax(farthest, lanesMax(lanesNorm1(p[k]), lanesNorm1(p[3 + k])));
    }

    const LanesVec3 area = lanesCross(e0, e1);
    const Lanes longest = lanesMax(lanesMax(lanesDot(e0, e0), lanesDot(e1, e1)), lanesDot(e2, e2));
    const Lanes length = lanesSqrt(lanesDot(area, area));
    const LaneMask sure =
        whole & (length > DRAPE_CULL_THIN * longest) & (length >= DRAPE_CULL_SMALL * radius * lanesSqrt(longest));
    const Lanes unswept = lanesSelect(stays, lanesSqrt(packet.m_moved), lanesSplat(0.0f));
    cull->m_radius = radius;
    cull->m_least = lanesSelect(sure, unswept + DRAPE_CULL_MET * radius, radius);

    cull->m_noise = lanesMin(DRAPE_CULL_NOISE * (2.0f * radius + packetIntervals(cull, p)), radius);
    cull->m_rounding = DRAPE_PACKET_PAD * farthest + DRAPE_TINY;
    LaneMask near = radius >= 0.0f;
    DRAPE_UNROLL
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        const Lanes pad = dopNorm(i) * cull->m_noise + cull->m_rounding;
        cull->m_low[i] -= pad;
        cull->m_high[i] += pad;
        if (i < 3 && motion)
            near &= (cull->m_low[i] - radius <= motion->m_high[i]) & (cull->m_high[i] + radius >= motion->m_low[i]);
    }
    DRAPE_UNROLL
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        cull->m_low[i] = lanesSelect(near, cull->m_low[i], lanesSplat(DRAPE_INFINITY));
        cull->m_high[i] = lanesSelect(near, cull->m_high[i], lanesSplat(-DRAPE_INFINITY));
    }
    return near;
}

// Returns the triangles that are not proved out of reach of one child of a wide node.
DRAPE_FUNCTION LaneMask cullPacketChild(const CullVolumes* cull, const DRAPE_GLOBAL float* child)
{
    LaneMask near = lanesMaskSplat(1);
    DRAPE_UNROLL
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        const float share = child[(2 * DRAPE_DOP_DIRECTIONS + i) * DRAPE_PATCH_WIDTH];
        const Lanes reach = lanesMax(cull->m_radius * share, cull->m_least * dopNorm(i));
        near &= (child[i * DRAPE_PATCH_WIDTH] - reach <= cull->m_high[i]) &
                (child[(DRAPE_DOP_DIRECTIONS + i) * DRAPE_PATCH_WIDTH] + reach >= cull->m_low[i]);
    }
    return near;
}

// Directions of the volumes, one per lane. Unused lanes hold zero, and infinity in m_ignored, which is zero
// elsewhere.
typedef struct Directions
{
    LanesVec3 m_along;
    Lanes m_norm, m_ignored;
} Directions;

#if defined(DRAPE_LANES) && DRAPE_LANES > 1
typedef char DirectionsFit[DRAPE_DOP_DIRECTIONS <= DRAPE_LANES ? 1 : -1];
DRAPE_FUNCTION Directions directionLanes(void)
{
    float x[DRAPE_LANES], y[DRAPE_LANES], z[DRAPE_LANES], norm[DRAPE_LANES], ignored[DRAPE_LANES];
    DRAPE_UNROLL
    for (int i = 0; i < DRAPE_LANES; ++i)
    {
        const float is = i < DRAPE_DOP_DIRECTIONS ? 1.0f : 0.0f;
        x[i] = dopProject(vec3(is, 0.0f, 0.0f), i);
        y[i] = dopProject(vec3(0.0f, is, 0.0f), i);
        z[i] = dopProject(vec3(0.0f, 0.0f, is), i);
        norm[i] = is * dopNorm(i);
        ignored[i] = i < DRAPE_DOP_DIRECTIONS ? 0.0f : DRAPE_INFINITY;
    }
    Directions directions;
    directions.m_along = lanesVec3(lanesLoad(x, 0), lanesLoad(y, 0), lanesLoad(z, 0));
    directions.m_norm = lanesLoad(norm, 0);
    directions.m_ignored = lanesLoad(ignored, 0);
    return directions;
}
#endif

// A triangle's nodes over the step along the directions, m: together they are its volume's intervals. Without bounds in
// lanes that are no direction.
typedef struct NodeIntervals
{
    Lanes m_low[3], m_high[3];
} NodeIntervals;

// corners: of one triangle, see cullVolumes(); noise, rounding: its pads there.
DRAPE_FUNCTION void nodeIntervals(NodeIntervals* nodes, const Directions* directions, const Vec3* corners, float noise,
                                  float rounding)
{
    const Lanes pad = directions->m_norm * noise + rounding + directions->m_ignored;
    for (int k = 0; k < 3; ++k)
    {
        const Lanes start = lanesDotUniform(directions->m_along, corners[k]);
        const Lanes end = lanesDotUniform(directions->m_along, corners[3 + k]);
        nodes->m_low[k] = lanesMin(start, end) - pad;
        nodes->m_high[k] = lanesMax(start, end) + pad;
    }
}

// Region, along the directions, in which cloth may be near a patch, m.
typedef struct NearPatch
{
    Lanes m_low, m_high;
} NearPatch;

// low, high, share: data of the patch in the wide tree. radius, least: the triangle's, see CullVolume.
DRAPE_FUNCTION NearPatch nearPatch(const Directions* directions, Lanes low, Lanes high, Lanes share, float radius,
                                   float least)
{
    const Lanes reach = lanesMax(radius * share, least * directions->m_norm);
    NearPatch near;
    near.m_low = low - reach;
    near.m_high = high + reach;
    return near;
}

// Returns the directions along which node k is out of reach of a patch. NaN lanes are not included.
DRAPE_FUNCTION LaneMask nodeIsOut(const NodeIntervals* nodes, int k, NearPatch near)
{
    return (near.m_low > nodes->m_high[k]) | (near.m_high < nodes->m_low[k]);
}

// Returns the directions along which the edge from node k on is out of reach of the patch.
DRAPE_FUNCTION LaneMask edgeIsOut(const NodeIntervals* nodes, int k, NearPatch near)
{
    const int next = k == 2 ? 0 : k + 1;
    return (near.m_low > lanesMax(nodes->m_high[k], nodes->m_high[next])) |
           (near.m_high < lanesMin(nodes->m_low[k], nodes->m_low[next]));
}

DRAPE_NAMESPACE_END

#endif
