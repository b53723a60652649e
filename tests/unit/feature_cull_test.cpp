// The cull of single features, a lane at a time: what gives a contact is kept, also of triangles that are thin, tiny
// against the reach or the other, or far longer than an edge of theirs.
#include "kernels/lib/feature_cull.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bullet_plugin/core/mesh/patches.h"
#include "kernels/lib/pair_contact.h"
#include "tests/support/cases.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
constexpr float kReach = 0.03f;  // m

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
    PairOfTriangles(const Side& cloth, const Side& obstacle, const std::vector<float>& spreads, std::uint32_t mode)
        : m_cloth(cloth.cloth()), m_obstacle(obstacle.obstacle()), m_spreads(spreads)
    {
        m_cloth.m_mode = mode;
    }

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
        m_reach = cullReach(&m_cull, kReach, vec3Norm1(vec3Sub(high, low)), m_cloth.m_mode);
    }

    bool isContact(int test)
    {
        Contact contact;
        return pairContact(test, &m_cloth, &m_obstacle, m_pair, kReach, &contact) == DRAPE_IS_CONTACT;
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

    ClothView m_cloth;
    ObstacleView m_obstacle;
    const std::vector<float>& m_spreads;
    Candidate m_pair = {};
    const Triangle* m_triangle = nullptr;
    CullTriangle m_cull = {};
    CullReach m_reach = {};
};

// Of cloth triangle i and obstacle triangle i. kept and contacts count on.
void expectContactsKept(const StepCase& step, std::uint32_t mode, std::size_t& kept, std::size_t& contacts)
{
    Side cloth = makeSide({step.m_cloth});
    const Side obstacle = makeSide({step.m_obstacle});
    cloth.m_end = step.m_end;
    const std::vector<float> spreads =
        faceSpreads(obstacle.m_pool.triangles(), obstacle.m_start.data(), obstacle.m_vertexCones, obstacle.m_edgeCones);
    PairOfTriangles pair(cloth, obstacle, spreads, mode);
    for (std::uint32_t i = 0; i < cloth.m_pool.triangles().size(); ++i)
    {
        pair.choose({i, i});
        for (int test = 0; test < DRAPE_FEATURE_TESTS; ++test)
        {
            const bool isKept = pair.isKept(test);
            kept += isKept;
            if (!pair.isContact(test)) continue;
            ++contacts;
            EXPECT_TRUE(isKept) << step.trace() << ", mode " << mode << ", triangles " << i << ", test " << test;
        }
    }
}
}  // namespace

TEST(FeatureCull, KeepsWhatGivesContactsWhateverTheShape)
{
    std::size_t kept = 0, contacts = 0, tested = 0;
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
                    expectContactsKept(step, mode, kept, contacts);
                    tested += 400 * DRAPE_FEATURE_TESTS;
                }
            }
        }
    }
    EXPECT_GT(contacts, tested / 10);
    EXPECT_LT(kept, tested * 9 / 10);
}
}  // namespace drape::test
