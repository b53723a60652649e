// The cull of single features, a lane at a time. It keeps every feature pair that gives a contact. Triangles may be
// thin, tiny against the reach or the other, or far longer than one of their edges.
#include "kernels/lib/broad_phase/feature_cull.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "reference/pair_tests.h"
#include "tests/support/cases.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
constexpr float kReach = 0.03f;     // m
constexpr float kFarReach = 0.25f;  // m, more than the triangles of the meshes are large

// One lane of a block: positions, then a cone.
struct Lane
{
    float m_values[10];

    void put(int first, Vec3 v)
    {
        m_values[first] = v.x;
        m_values[first + 1] = v.y;
        m_values[first + 2] = v.z;
    }
};

// A loose triangle of a step's cloth and one of its obstacle.
class PairOfTriangles
{
public:
    PairOfTriangles(const Side& cloth, const Side& obstacle, const std::vector<float>& spreads, std::uint32_t mode,
                    float reach = kReach)
        : m_cloth(cloth.cloth()), m_obstacle(obstacle.obstacle()), m_spreads(spreads), m_pairReach(reach)
    {
        m_cloth.m_mode = mode;
        m_cloth.m_searches = &m_searches;
    }
    PairOfTriangles(const PairOfTriangles&) = delete;  // m_cloth points here

    void choose(Candidate pair)
    {
        m_pair = pair;
        m_triangle = m_obstacle.m_triangles + pair.m_obstacle;
        prepareCull(&m_cull, m_cloth.m_start, m_cloth.m_end, m_cloth.m_triangles + pair.m_cloth, m_cloth.m_mode,
                    nullptr);
        Vec3 low = corner(0), high = low;
        for (int i = 1; i < 3; ++i)
        {
            low = vec3Least(low, corner(i));
            high = vec3Most(high, corner(i));
        }
        m_reach = cullReach(&m_cull, m_pairReach, vec3Norm1(vec3Sub(high, low)), m_cloth.m_mode);
    }

    bool isContact(int test)
    {
        Contact contact;
        return pairContact(test, &m_cloth, &m_obstacle, m_pair, m_pairReach, &contact) == DRAPE_IS_CONTACT;
    }

    // Returns true if the cull of faces keeps any test of the pair.
    bool isNear() const
    {
        Lane face = {};
        for (int i = 0; i < 3; ++i)
            face.put(3 * i, corner(i));
        face.m_values[9] = m_spreads[m_pair.m_obstacle];
        return cullFaces(&m_cull, m_reach, face.m_values);
    }

    bool isKept(int test) const
    {
        Lane lane = {};
        if (test < 3)
        {
            for (int i = 0; i < 3; ++i)
                lane.put(3 * i, corner(i));
            lane.m_values[9] = m_spreads[m_pair.m_obstacle];
            return cullNodeFace(&m_cull, test, m_reach, lane.m_values);
        }
        if (test < 6)
        {
            const NormalCone cone = m_obstacle.m_vertexCones[m_triangle->m_vertices[test - 3]];
            lane.put(0, corner(test - 3));
            lane.put(3, cone.m_axis);
            lane.m_values[6] = cone.m_cosine;
            return cullFaceVertex(&m_cull, m_reach, lane.m_values);
        }
        const int place = (test - 6) % 3;
        const NormalCone cone = m_obstacle.m_edgeCones[m_triangle->m_edges[place]];
        lane.put(0, corner(place));
        lane.put(3, corner((place + 1) % 3));
        lane.put(6, cone.m_axis);
        lane.m_values[9] = cone.m_cosine;
        const CullEdges edges = loadCullEdges(&m_cull, lane.m_values);
        return cullEdgeEdge(&m_cull, (test - 6) / 3, m_reach, &edges);
    }

private:
    Vec3 corner(int i) const { return vec3Load(m_obstacle.m_positions, m_triangle->m_vertices[i]); }

    std::uint32_t m_searches = 0;
    ClothView m_cloth;
    ObstacleView m_obstacle;
    const std::vector<float>& m_spreads;
    float m_pairReach;  // m
    Candidate m_pair = {};
    const Triangle* m_triangle = nullptr;
    CullTriangle m_cull = {};
    CullReach m_reach = {};
};

struct Counts
{
    std::size_t m_pairs = 0, m_near = 0;     // pairs of triangles
    std::size_t m_kept = 0, m_contacts = 0;  // pairs of features
};

// A step's meshes as PairOfTriangles reads them.
struct CullCase
{
    explicit CullCase(const StepCase& step) : m_cloth(makeSide({step.m_cloth})), m_obstacle(makeSide({step.m_obstacle}))
    {
        m_cloth.m_end = step.m_end;
        for (const Triangle& triangle : m_obstacle.m_pool.triangles())
            m_spreads.push_back(spreadOf(triangle));
    }
    Side m_cloth, m_obstacle;
    std::vector<float> m_spreads;

private:
    float spreadOf(const Triangle& triangle) const
    {
        Vec3 corners[3];
        NormalCone cones[6];
        for (int i = 0; i < 3; ++i)
        {
            corners[i] = vec3Load(m_obstacle.m_start.data(), triangle.m_vertices[i]);
            cones[i] = m_obstacle.m_vertexCones[triangle.m_vertices[i]];
            cones[3 + i] = m_obstacle.m_edgeCones[triangle.m_edges[i]];
        }
        return faceSpread(faceCone(corners), cones);
    }
};

void expectContactsKept(PairOfTriangles& pair, Candidate triangles, Counts& counts)
{
    pair.choose(triangles);
    const bool isNear = pair.isNear();
    ++counts.m_pairs;
    counts.m_near += isNear;
    for (int test = 0; test < DRAPE_FEATURE_TESTS; ++test)
    {
        const bool isKept = isNear && pair.isKept(test);
        counts.m_kept += isKept;
        if (!pair.isContact(test)) continue;
        ++counts.m_contacts;
        EXPECT_TRUE(isKept) << "triangles " << triangles.m_cloth << " and " << triangles.m_obstacle << ", test " << test
                            << ", face near: " << isNear;
    }
}

// Tests cloth triangle i against obstacle triangle i.
void expectContactsKept(const StepCase& step, std::uint32_t mode, Counts& counts)
{
    SCOPED_TRACE(step.trace() + ", mode " + std::to_string(mode));
    const CullCase meshes(step);
    PairOfTriangles pair(meshes.m_cloth, meshes.m_obstacle, meshes.m_spreads, mode);
    for (std::uint32_t i = 0; i < meshes.m_cloth.m_pool.triangles().size(); ++i)
        expectContactsKept(pair, {i, i}, counts);
}
}  // namespace

TEST(FeatureCull, KeepsWhatGivesContactsWhateverTheShape)
{
    Counts counts;
    std::uint32_t seed = 570;
    for (const Thin thin : {Thin::Cloth, Thin::Obstacle, Thin::Both})
    {
        for (const float size : {1e-4f, 1e-3f, 1e-2f, 0.1f, 1.0f, 10.0f, 100.0f})
        {
            for (const std::uint32_t mode : {DRAPE_DISCRETE, DRAPE_CONTINUOUS, DRAPE_AUTOMATIC})
            {
                for (const bool moving : {false, true})
                {
                    const StepCase step = needleCase(thin, 400, size, moving, ++seed);
                    expectContactsKept(step, mode, counts);
                }
            }
        }
    }
    const std::size_t tested = counts.m_pairs * DRAPE_FEATURE_TESTS;
    EXPECT_GT(counts.m_contacts, tested / 10);
    EXPECT_LT(counts.m_kept, tested * 9 / 10);
}

// Meshes, whose cones are narrow: every cloth triangle with every obstacle triangle.
TEST(FeatureCull, KeepsWhatGivesContactsOfMeshes)
{
    std::uint32_t seed = 580;
    for (const char* shape : {"terrain", "sphere"})
    {
        for (const std::uint32_t mode : {DRAPE_DISCRETE, DRAPE_CONTINUOUS, DRAPE_AUTOMATIC})
        {
            const StepCase step = fallingCase(shape, 17, kReach, ++seed);
            SCOPED_TRACE(step.trace() + ", mode " + std::to_string(mode));
            const CullCase meshes(step);
            PairOfTriangles pair(meshes.m_cloth, meshes.m_obstacle, meshes.m_spreads, mode, kFarReach);
            Counts counts;
            for (std::uint32_t i = 0; i < meshes.m_cloth.m_pool.triangles().size(); ++i)
            {
                for (std::uint32_t j = 0; j < meshes.m_obstacle.m_pool.triangles().size(); ++j)
                    expectContactsKept(pair, {i, j}, counts);
            }
            EXPECT_GT(counts.m_contacts, 100u);
            EXPECT_LT(counts.m_near, counts.m_pairs / 2);
        }
    }
}
}  // namespace drape::test
