// Volumes of packets, a lane at a time: as those of single triangles, never smaller. Those of their nodes and edges.
#include "kernels/lib/broad_phase/cull_packet.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/cases.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
constexpr float kRadius = 0.03f;  // m

struct Counts
{
    int m_volumes = 0, m_near = 0, m_unswept = 0;
    int m_tried = 0, m_out = 0;  // nodes against patches beside the opposite edge
};

// Volumes of one triangle as kernels/broad_phase/patch_traversal_gpu.cl makes them. Returns whether it may come near
// the obstacle.
int cullVolume(CullVolume* cull, const ObstacleMotion* motion, const Triangle* triangle, const float* start,
               const float* end, std::uint32_t mode)
{
    CullCorners corners;
    cull->m_radius = kRadius;
    if (!cullCorners(&corners, &cull->m_least, motion, triangle, start, end, kRadius, mode)) return 0;
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
        cullInterval(&corners, i, cull->m_volume.m_low + i, cull->m_volume.m_high + i);
    return cullMeets(&corners, kRadius, motion);
}

// Returns the lane of direction i.
Directions directionLane(int i)
{
    const Vec3 axes[] = {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)};
    return {lanesVec3(dopProject(axes[0], i), dopProject(axes[1], i), dopProject(axes[2], i)), dopNorm(i), 0.0f};
}

// Returns the nodes and edges out of reach of a patch that is a point without a cone, bits as in Triangle::m_owned.
std::uint32_t outOfReach(const CullVolumes& packet, const Vec3* corners, Vec3 point)
{
    std::uint32_t out = 0;
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        const Directions direction = directionLane(i);
        const float place = dopProject(point, i);
        const NearPatch patch = nearPatch(&direction, place, place, dopNorm(i), packet.m_radius, packet.m_least);
        NodeIntervals nodes;
        nodeIntervals(&nodes, &direction, corners, packet.m_noise, packet.m_rounding);
        for (int k = 0; k < 3; ++k)
        {
            if (nodeIsOut(&nodes, k, patch)) out |= DRAPE_OWNS_VERTEX(k);
            if (edgeIsOut(&nodes, k, patch)) out |= DRAPE_OWNS_EDGE(k);
        }
    }
    return out;
}

// `corners` are those of the packet's volume.
void expectNodesMakeTheVolume(const CullVolumes& packet, const Vec3* corners, Counts& counts)
{
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        const Directions direction = directionLane(i);
        NodeIntervals nodes;
        nodeIntervals(&nodes, &direction, corners, packet.m_noise, packet.m_rounding);
        EXPECT_EQ(std::min({nodes.m_low[0], nodes.m_low[1], nodes.m_low[2]}), packet.m_low[i]);
        EXPECT_EQ(std::max({nodes.m_high[0], nodes.m_high[1], nodes.m_high[2]}), packet.m_high[i]);
    }
    for (int k = 0; k < 3; ++k)
    {
        const int next = (k + 1) % 3, last = (k + 2) % 3;
        // Points at a node, or beside an edge within the contact distance, are in its reach. The opposite node may be
        // outside.
        const Vec3 middle = vec3Scale(vec3Add(corners[3 + next], corners[3 + last]), 0.5f);
        const Vec3 beside = vec3Add(middle, vec3(0.0f, packet.m_radius, 0.0f));
        EXPECT_EQ(outOfReach(packet, corners, corners[3 + k]) &
                      (DRAPE_OWNS_VERTEX(k) | DRAPE_OWNS_EDGE(k) | DRAPE_OWNS_EDGE(last)),
                  0u);
        const std::uint32_t out = outOfReach(packet, corners, beside);
        EXPECT_EQ(out & DRAPE_OWNS_EDGE(next), 0u);
        ++counts.m_tried;
        counts.m_out += (out & DRAPE_OWNS_VERTEX(k)) != 0;
    }
}

// Expects equal volumes of valid triangles.
void expectSameVolume(const StepCase& step, const Triangle& triangle, std::uint32_t mode, const ObstacleMotion* motion,
                      Counts& counts)
{
    CullVolume single;
    const int mayComeNear =
        cullVolume(&single, motion, &triangle, step.m_cloth.m_positions.data(), step.m_end.data(), mode);
    Vec3 corners[6];
    LanesVec3 lanes[6];
    cornersSeen(corners, motion, &triangle, step.m_cloth.m_positions.data(), step.m_end.data());
    for (int k = 0; k < 6; ++k)
        lanes[k] = lanesVec3(corners[k].x, corners[k].y, corners[k].z);
    CullVolumes packet;
    EXPECT_EQ(cullVolumes(&packet, lanes, kRadius, 1, mode, motion), mayComeNear);
    ++counts.m_volumes;
    if (!mayComeNear) return;
    ++counts.m_near;
    counts.m_unswept += !isSwept(corners, kRadius, mode);
    EXPECT_EQ(packet.m_radius, single.m_radius);
    EXPECT_NEAR(packet.m_least, single.m_least, 1e-6f);
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        EXPECT_LE(packet.m_low[i], single.m_volume.m_low[i]);
        EXPECT_GE(packet.m_high[i], single.m_volume.m_high[i]);
        EXPECT_NEAR(packet.m_low[i], single.m_volume.m_low[i], 5e-6f);
        EXPECT_NEAR(packet.m_high[i], single.m_volume.m_high[i], 5e-6f);
    }
    for (int k = 0; k < 6; ++k)
        corners[k] = vec3(lanes[k].x, lanes[k].y, lanes[k].z);
    expectNodesMakeTheVolume(packet, corners, counts);
}
}  // namespace

TEST(CullPacket, VolumesAreThoseOfSingleTriangles)
{
    // The obstacle rotates by a right angle and shifts, in one half of the cloth.
    const ObstacleMotion motion = {{0, -1, 0, 0.02f, 1, 0, 0, -0.01f, 0, 0, 1, 0.005f}, {-2, -2, -2}, {0, 2, 2}, 0};
    Counts counts;
    for (const bool moving : {false, true})
    {
        const StepCase steps[] = {soupCase(200, 1, moving, 600), needleCase(Thin::Cloth, 200, 1.0f, moving, 601),
                                  fallingCase("sphere", 17, kRadius, 602)};
        for (const StepCase& step : steps)
        {
            SCOPED_TRACE(step.trace());
            for (const std::uint32_t mode : {DRAPE_DISCRETE, DRAPE_CONTINUOUS, DRAPE_AUTOMATIC})
            {
                const Side cloth = makeSide({step.m_cloth});
                for (const Triangle& triangle : cloth.m_pool.triangles())
                {
                    for (const ObstacleMotion* seen : {static_cast<const ObstacleMotion*>(nullptr), &motion})
                        expectSameVolume(step, triangle, mode, seen, counts);
                }
            }
        }
    }
    EXPECT_GT(counts.m_near, counts.m_volumes / 2);
    EXPECT_LT(counts.m_near, counts.m_volumes * 9 / 10);
    EXPECT_GT(counts.m_unswept, counts.m_near / 5);
    EXPECT_GT(counts.m_out, counts.m_tried / 4);
}

// A triangle that is not in the step is near nothing, wherever it is.
TEST(CullPacket, NegativeRadiusIsEmpty)
{
    LanesVec3 corners[6] = {};
    CullVolumes packet;
    EXPECT_EQ(cullVolumes(&packet, corners, -1.0f, 1, DRAPE_AUTOMATIC, nullptr), 0);
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        EXPECT_EQ(packet.m_low[i], DRAPE_INFINITY);
        EXPECT_EQ(packet.m_high[i], -DRAPE_INFINITY);
    }
}
}  // namespace drape::test
