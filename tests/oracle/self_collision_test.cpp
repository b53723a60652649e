// Self collision against every pair of features tested, on every back end.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

#include "kernels/lib/ccd/ccd.h"
#include "oracle/exact_predicates.h"
#include "tests/support/backends.h"
#include "tests/support/oracle.h"
#include "scenes/describe_mesh.h"
#include "tests/support/self_cases.h"

namespace drape::test
{
namespace
{
// A pair of features by kind and vertices, each feature's sorted, edges in order.
using FeatureKey = std::array<std::uint32_t, 5>;

FeatureKey keyOf(std::uint32_t kind, const std::uint32_t vertices[4])
{
    std::array<std::uint32_t, 4> v = {vertices[0], vertices[1], vertices[2], vertices[3]};
    if (kind == DRAPE_VERTEX_FACE)
    {
        std::sort(v.begin() + 1, v.end());
    }
    else
    {
        std::sort(v.begin(), v.begin() + 2);
        std::sort(v.begin() + 2, v.end());
        if (v[2] < v[0] || (v[2] == v[0] && v[3] < v[1])) std::swap_ranges(v.begin(), v.begin() + 2, v.begin() + 2);
    }
    return {kind, v[0], v[1], v[2], v[3]};
}

bool touches(const SelfCase& motion, std::uint32_t kind, const std::uint32_t vertices[4], const CcdSettings& settings)
{
    Vec3 start[4], end[4];
    for (int i = 0; i < 4; ++i)
    {
        start[i] = vec3Load(motion.m_mesh.m_positions.data(), vertices[i]);
        end[i] = vec3Load(motion.m_end.data(), vertices[i]);
    }
    return ccdOfKind(kind, start, end, settings).m_hit != 0;
}

// Tests all vertices against all faces and all edges against all edges, apart from those that share a vertex.
std::set<FeatureKey> bruteForce(const SelfCase& motion, const CcdSettings& settings)
{
    const std::vector<std::int32_t>& indices = motion.m_mesh.m_triangles;
    std::set<std::uint32_t> used;
    std::set<std::array<std::uint32_t, 2>> edges;
    std::set<FeatureKey> found;
    for (std::size_t i = 0; i < indices.size(); ++i)
    {
        const std::uint32_t a = std::uint32_t(indices[i]), b = std::uint32_t(indices[i % 3 == 2 ? i - 2 : i + 1]);
        used.insert(a);
        edges.insert({std::min(a, b), std::max(a, b)});
    }
    for (std::uint32_t vertex : used)
    {
        for (std::size_t t = 0; t < indices.size(); t += 3)
        {
            const std::uint32_t v[4] = {vertex, std::uint32_t(indices[t]), std::uint32_t(indices[t + 1]),
                                        std::uint32_t(indices[t + 2])};
            if (vertex == v[1] || vertex == v[2] || vertex == v[3]) continue;
            if (touches(motion, DRAPE_VERTEX_FACE, v, settings)) found.insert(keyOf(DRAPE_VERTEX_FACE, v));
        }
    }
    for (auto a = edges.begin(); a != edges.end(); ++a)
    {
        for (auto b = std::next(a); b != edges.end(); ++b)
        {
            const std::uint32_t v[4] = {(*a)[0], (*a)[1], (*b)[0], (*b)[1]};
            if (v[0] == v[2] || v[0] == v[3] || v[1] == v[2] || v[1] == v[3]) continue;
            if (touches(motion, DRAPE_EDGES, v, settings)) found.insert(keyOf(DRAPE_EDGES, v));
        }
    }
    return found;
}

void cornersOf(const TriangleMesh& mesh, std::size_t triangle, Vector3 corners[3])
{
    for (int i = 0; i < 3; ++i)
        corners[i] = position(mesh.m_positions, std::uint32_t(mesh.m_triangles[3 * triangle + std::size_t(i)]));
}

bool shareVertex(const TriangleMesh& mesh, std::size_t a, std::size_t b)
{
    for (int i = 0; i < 9; ++i)
        if (mesh.m_triangles[3 * a + std::size_t(i / 3)] == mesh.m_triangles[3 * b + std::size_t(i % 3)]) return true;
    return false;
}
}  // namespace

class SelfOracle : public BackendTest
{
};

TEST_P(SelfOracle, TouchingFeaturesAreThoseOfAllPairs)
{
    const std::unique_ptr<Queries> queries = makeQueries(GetParam().m_settings);
    ASSERT_TRUE(queries);
    for (const SelfCase& motion : selfCases())
    {
        for (float separation : {0.0f, 0.01f})
        {
            SCOPED_TRACE(motion.m_name + ", separation " + std::to_string(separation));
            CcdSettings settings = defaultCcdSettings();
            settings.m_separation = separation;
            MeshMotion found;
            ASSERT_TRUE(queries->meshMotion(describeMesh(motion.m_mesh), motion.m_end.data(), settings, found));
            std::set<FeatureKey> keys;
            for (const TouchingFeatures& touching : found.m_touching)
                keys.insert(keyOf(touching.m_kind, touching.m_vertices));
            EXPECT_EQ(keys.size(), found.m_touching.size()) << "no pair twice";
            const std::set<FeatureKey> truth = bruteForce(motion, settings);
            EXPECT_TRUE(std::includes(keys.begin(), keys.end(), truth.begin(), truth.end()));
            // The brute force tests edges in another order, which may decide pairs that nearly touch differently.
            EXPECT_LE(keys.size(), truth.size() + truth.size() / 500);
            EXPECT_LE(found.m_touching.size(), found.m_vertexFaceCandidates + found.m_edgeCandidates);
            EXPECT_GE(truth.size(), motion.m_mesh.triangleCount() > 100 ? 50u : 0u) << "the case says something";
        }
    }
}

TEST_P(SelfOracle, PairsOfTrianglesAreThoseOfAllPairs)
{
    const std::unique_ptr<Queries> queries = makeQueries(GetParam().m_settings);
    ASSERT_TRUE(queries);
    for (const SelfCase& motion : selfCases())
    {
        const TriangleMesh& mesh = motion.m_mesh;
        if (mesh.triangleCount() > 400) continue;
        SCOPED_TRACE(motion.m_name);
        const float radius = 0.013f;
        MeshPairs found;
        ASSERT_TRUE(queries->meshPairs(describeMesh(mesh), nullptr, radius, found));
        std::vector<NearTriangles> within, intersecting;
        for (std::uint32_t a = 0; a < mesh.triangleCount(); ++a)
        {
            for (std::uint32_t b = a + 1; b < mesh.triangleCount(); ++b)
            {
                Vector3 p[3], q[3];
                cornersOf(mesh, a, p);
                cornersOf(mesh, b, q);
                if (shareVertex(mesh, a, b)) continue;
                if (trianglesIntersect(p, q)) intersecting.push_back(NearTriangles{a, b});
                if (triangleDistance(p, q) <= radius) within.push_back(NearTriangles{a, b});
            }
        }
        const auto same = [](const std::vector<NearTriangles>& a, const std::vector<NearTriangles>& b)
        {
            return a.size() == b.size() &&
                   (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(NearTriangles)) == 0);
        };
        EXPECT_TRUE(same(found.m_within, within)) << found.m_within.size() << " for " << within.size();
        EXPECT_TRUE(same(found.m_intersecting, intersecting));
        EXPECT_GE(found.m_candidates, within.size());
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, SelfOracle, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
