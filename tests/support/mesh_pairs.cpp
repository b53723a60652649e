#include "tests/support/mesh_pairs.h"

#include <gtest/gtest.h>

#include "scenes/describe_mesh.h"
#include "oracle/exact_predicates.h"
#include "tests/support/oracle.h"
#include "tests/support/self_cases.h"

namespace drape::test
{
MeshPairs meshPairsOn(const Settings& settings, const TriangleMesh& a, const TriangleMesh& b, float radius)
{
    MeshPairs found;
    const std::unique_ptr<Queries> queries = makeQueries(settings);
    if (!queries) return found;
    const MeshDescription other = describeMesh(b);
    if (!queries->meshPairs(describeMesh(a), &other, radius, found)) ADD_FAILURE() << queries->error().text();
    return found;
}

std::vector<NearTriangles> meetingPairs(const TriangleMesh& a, const TriangleMesh& b)
{
    const auto corners = [](const TriangleMesh& mesh, std::size_t triangle, Vector3 out[3])
    {
        for (std::size_t i = 0; i < 3; ++i)
            out[i] = position(mesh.m_positions, std::uint32_t(mesh.m_triangles[3 * triangle + i]));
    };
    std::vector<NearTriangles> pairs;
    for (std::size_t i = 0; i < a.triangleCount(); ++i)
    {
        for (std::size_t j = 0; j < b.triangleCount(); ++j)
        {
            Vector3 first[3], second[3];
            corners(a, i, first);
            corners(b, j, second);
            if (trianglesIntersect(first, second)) pairs.push_back({std::uint32_t(i), std::uint32_t(j)});
        }
    }
    return pairs;
}
}  // namespace drape::test
