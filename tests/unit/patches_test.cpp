// Patches: every triangle in one lane, full patches of one mesh each, and near each other on surfaces.
#include "bullet_plugin/core/scene/patches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "scenes/shapes.h"
#include "tests/support/cases.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
constexpr std::uint32_t kWidth = 32;

// Returns the clustered triangles of a side of one mesh.
std::vector<std::uint32_t> clustered(const Side& side)
{
    return clusteredOrder(side.m_pool.mesh(0), side.m_start.data(), kWidth);
}

void expectEachOnce(std::vector<std::uint32_t> order, std::size_t count)
{
    std::sort(order.begin(), order.end());
    std::vector<std::uint32_t> all(count);
    std::iota(all.begin(), all.end(), 0u);
    EXPECT_EQ(order, all);
}

// Returns the mean diagonal (m) of the boxes around runs of kWidth triangles.
double meanDiagonal(const Side& side, const std::vector<std::uint32_t>& order)
{
    double sum = 0;
    std::size_t patches = 0;
    for (std::size_t first = 0; first < order.size(); first += kWidth, ++patches)
    {
        Vec3 low = {1e30f, 1e30f, 1e30f}, high = {-1e30f, -1e30f, -1e30f};
        for (std::size_t i = first; i < std::min(order.size(), first + kWidth); ++i)
            for (std::uint32_t vertex : side.m_pool.triangles()[order[i]].m_vertices)
            {
                const Vec3 p = vec3Load(side.m_start.data(), vertex);
                low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
                high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
            }
        sum += std::hypot(high.x - low.x, high.y - low.y, high.z - low.z);
    }
    return sum / double(patches);
}
}  // namespace

TEST(PatchesTest, EveryTriangleIsInOnePatchOfItsMesh)
{
    const TriangleMesh sphere = makeSphere(1.0f, 3), soup = makeSoup(1.0f, 0.2f, 101, 31);
    const Side side = makeSide({sphere, soup, sphere, TriangleMesh()});
    const std::size_t count = side.m_pool.triangles().size();
    for (std::size_t slot = 0; slot < side.m_pool.meshCount(); ++slot)
    {
        const PooledMesh& mesh = side.m_pool.mesh(slot);
        expectEachOnce(clusteredOrder(mesh, mesh.m_positions.data(), kWidth), mesh.m_topology.m_triangles.size());
    }
    const Patches patches = makePatches(side.m_pool, side.m_start.data(), kWidth);
    std::size_t expected = 0;
    for (const TriangleMesh& mesh : {sphere, soup, sphere})
        expected += (mesh.triangleCount() + kWidth - 1) / kWidth;
    EXPECT_EQ(patches.m_patches.size(), expected) << "full but for each mesh's last";
    std::vector<std::uint32_t> faces;
    for (std::size_t lane = 0; lane < patches.m_faceOwners.size(); ++lane)
    {
        const std::uint32_t face = patches.m_faceOwners[lane];
        if (face == DRAPE_NO_FEATURE) continue;
        faces.push_back(face);
        EXPECT_EQ(side.m_pool.triangles()[face].m_mesh, patches.m_patches[lane / kWidth].m_mesh);
    }
    expectEachOnce(faces, count);
}

// Meshes that come behind others, and those that take the places of some that went.
TEST(PatchesTest, AppendedPatchesAreThoseOfAll)
{
    const TriangleMesh sphere = makeSphere(1.0f, 3), soup = makeSoup(1.0f, 0.2f, 101, 32), none;
    const std::vector<TriangleMesh> before = {sphere, soup, none, sphere},
                                    after = {sphere, soup, none, soup, none, soup};
    for (std::size_t kept = 0; kept <= 3; ++kept)
    {
        SCOPED_TRACE("seed 32, kept " + std::to_string(kept));
        const Side first = makeSide(before), second = makeSide(after);
        Patches patches = makePatches(first.m_pool, first.m_start.data(), kWidth);
        keepPatches(patches, kept, kWidth);
        for (std::size_t slot = kept; slot < after.size(); ++slot)
            appendPatches(patches, second.m_pool, slot, second.m_pool.mesh(slot).m_positions.data(), kWidth);
        makeLevels(patches, kWidth);
        const Patches all = makePatches(second.m_pool, second.m_start.data(), kWidth);
        EXPECT_TRUE(sameBytes(patches.m_patches, all.m_patches));
        EXPECT_EQ(patches.m_faceOwners, all.m_faceOwners);
        EXPECT_EQ(patches.m_faceFeatures, all.m_faceFeatures);
        EXPECT_EQ(patches.m_vertexOwners, all.m_vertexOwners);
        EXPECT_EQ(patches.m_edgeOwners, all.m_edgeOwners);
        EXPECT_EQ(patches.m_levels, all.m_levels);
    }
}

// A curve that fills space jumps; what it joins across a jump lies far apart.
TEST(PatchesTest, PatchesOfASurfaceAreFarSmallerThanRunsOfTheLeafOrder)
{
    const Side side = makeSide({makeSphere(1.0f, 5)});
    const std::vector<std::uint32_t> order = clustered(side);
    EXPECT_LT(meanDiagonal(side, order), 0.8 * meanDiagonal(side, side.m_order));
    // The bound is a disc of 32 triangles' area.
    const double area = 4 * 3.14159265 / double(side.m_pool.triangles().size()) * kWidth;
    EXPECT_LT(meanDiagonal(side, order), 2.0 * std::sqrt(area)) << "twice a square's side";
}

TEST(PatchesTest, PositionsThatAreNoNumbersLoseNothing)
{
    Side side = makeSide({makeSphere(1.0f, 3)});
    for (std::size_t i = 0; i < side.m_start.size(); i += 7)
        side.m_start[i] = std::numeric_limits<float>::quiet_NaN();
    expectEachOnce(clustered(side), side.m_pool.triangles().size());
    std::fill(side.m_start.begin(), side.m_start.end(), std::numeric_limits<float>::infinity());
    expectEachOnce(clustered(side), side.m_pool.triangles().size());
}
}  // namespace drape::test
