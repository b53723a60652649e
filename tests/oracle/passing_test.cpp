// Compares motion with the truth: a node, face or edge that passes through another feature during the step is reported
// on the side it came from.
#include <gtest/gtest.h>

#include "tests/support/cases.h"
#include "tests/support/oracle.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
// A path crosses a face if it does so this far, in weights and in time, from every border: rounding moves both by about
// 1e-6.
constexpr double kCrossMargin = 1e-3;

struct Crossing
{
    std::uint32_t m_node, m_face;
    Vector3 m_cameFrom;  // unit normal of the face, to the node's side at the start
};

bool insideMargin(double value)
{
    return value > kCrossMargin && value < 1 - kCrossMargin;
}

// Returns true if the segment x0 x1 crosses the triangle within the margins.
bool crosses(const Vector3& x0, const Vector3& x1, const Vector3 corners[3], Vector3& cameFrom)
{
    const Vector3 u = corners[1] - corners[0], v = corners[2] - corners[0], area = cross(u, v);
    const double s0 = dot(area, x0 - corners[0]), s1 = dot(area, x1 - corners[0]);
    if (s0 * s1 >= 0 || !insideMargin(s0 / (s0 - s1))) return false;
    const Vector3 w = x0 + (s0 / (s0 - s1)) * (x1 - x0) - corners[0];
    const double second = dot(cross(w, v), area) / dot(area, area), third = dot(cross(u, w), area) / dot(area, area);
    if (!insideMargin(second) || !insideMargin(third) || !insideMargin(1 - second - third)) return false;
    cameFrom = (s0 > 0 ? 1.0 : -1.0) * normalized(area);
    return true;
}

std::vector<Crossing> crossings(const Side& cloth, const Side& obstacle)
{
    std::vector<Crossing> found;
    for (std::uint32_t node = 0; node < cloth.m_pool.vertexCount(); ++node)
    {
        for (std::uint32_t face = 0; face < obstacle.m_pool.triangles().size(); ++face)
        {
            Vector3 corners[3], cameFrom;
            for (int i = 0; i < 3; ++i)
                corners[i] = position(obstacle.m_start, obstacle.m_pool.triangles()[face].m_vertices[i]);
            if (crosses(position(cloth.m_start, node), position(cloth.m_end, node), corners, cameFrom))
            {
                found.push_back({node, face, cameFrom});
            }
        }
    }
    return found;
}

const Contact* find(const std::vector<Contact>& contacts, std::uint32_t kind, std::uint32_t cloth,
                    std::uint32_t obstacle)
{
    for (const Contact& contact : contacts)
    {
        if (contact.m_kind == kind && contact.m_clothFeature == cloth && contact.m_obstacleFeature == obstacle)
            return &contact;
    }
    return nullptr;
}

void expectCrossingsReported(const StepCase& step, std::size_t least)
{
    SCOPED_TRACE(step.trace());
    Side cloth = makeSide({step.m_cloth});
    const Side obstacle = makeSide({step.m_obstacle});
    cloth.m_end = step.m_end;
    const std::vector<Contact> contacts = contactsOfAllPairs(cloth, obstacle, step.m_thickness);
    const std::vector<Crossing> expected = crossings(cloth, obstacle);
    EXPECT_GE(expected.size(), least);
    for (const Crossing& crossing : expected)
    {
        const Contact* contact = find(contacts, DRAPE_NODE_FACE, crossing.m_node, crossing.m_face);
        ASSERT_TRUE(contact) << "node " << crossing.m_node << " through face " << crossing.m_face;
        const Vector3 normal = {contact->m_normal[0], contact->m_normal[1], contact->m_normal[2]};
        EXPECT_GT(dot(normal, crossing.m_cameFrom), 0.999) << describe(*contact);
        EXPECT_LT(contact->m_gap1, 0.0f) << describe(*contact);
        EXPECT_GT(contact->m_gap0, 0.0f) << describe(*contact);
        EXPECT_TRUE(contact->m_time > 0 && contact->m_time < 1) << describe(*contact);
    }
}
}  // namespace

TEST(PassingOracle, NodesThroughFaces)
{
    for (const char* shape : {"sphere", "bowl", "stairs", "torus", "terrain"})
    {
        expectCrossingsReported(fallingCase(shape, 20, 0.03f, 400), 20);
    }
    for (std::uint32_t seed = 401; seed < 411; ++seed)
        expectCrossingsReported(soupCase(200, 200, true, seed), 10);
}

// A face falls flat over vertices. The case mirrors nodes through faces, in the cloth's frame.
TEST(PassingOracle, FacesOverVertices)
{
    std::size_t found = 0;
    for (std::uint32_t seed = 420; seed < 424; ++seed)
    {
        StepCase step = soupCase(200, 200, false, seed);
        SCOPED_TRACE(step.trace());
        Random random(seed + 9);
        const float motion[3] = {random.uniform(-0.1f, 0.1f), random.uniform(-0.1f, 0.1f), random.uniform(-0.1f, 0.1f)};
        translate(step.m_end, motion[0], motion[1], motion[2]);
        Side cloth = makeSide({step.m_cloth});
        const Side obstacle = makeSide({step.m_obstacle});
        cloth.m_end = step.m_end;
        // The obstacle's vertices move the other way in the cloth's frame.
        Side vertices = makeSide({step.m_obstacle});
        translate(vertices.m_end, -motion[0], -motion[1], -motion[2]);
        const std::vector<Contact> contacts = contactsOfAllPairs(cloth, obstacle, step.m_thickness);
        for (const Crossing& crossing : crossings(vertices, cloth))
        {
            ++found;
            const Contact* contact = find(contacts, DRAPE_FACE_VERTEX, crossing.m_face, crossing.m_node);
            ASSERT_TRUE(contact) << "face " << crossing.m_face << " over vertex " << crossing.m_node;
            const Vector3 normal = {contact->m_normal[0], contact->m_normal[1], contact->m_normal[2]};
            EXPECT_LT(dot(normal, crossing.m_cameFrom), -0.999) << describe(*contact);
            EXPECT_LT(contact->m_gap1, 0.0f) << describe(*contact);
        }
    }
    EXPECT_GT(found, 40u);
}

// Edges fall across edges: the quadrangle that the cloth's edge sweeps, as two triangles, crosses the obstacle's edge.
TEST(PassingOracle, EdgesOverEdges)
{
    std::size_t found = 0;
    for (std::uint32_t seed = 430; seed < 434; ++seed)
    {
        StepCase step = soupCase(150, 150, false, seed);
        SCOPED_TRACE(step.trace());
        Random random(seed + 9);
        translate(step.m_end, random.uniform(-0.1f, 0.1f), random.uniform(-0.1f, 0.1f), random.uniform(-0.1f, 0.1f));
        Side cloth = makeSide({step.m_cloth});
        const Side obstacle = makeSide({step.m_obstacle});
        cloth.m_end = step.m_end;
        const std::vector<Contact> contacts = contactsOfAllPairs(cloth, obstacle, step.m_thickness);
        for (std::uint32_t e = 0; e < cloth.m_pool.edges().size(); ++e)
        {
            const std::uint32_t* nodes = cloth.m_pool.edges()[e].m_vertices;
            const Vector3 a0 = position(cloth.m_start, nodes[0]), b0 = position(cloth.m_start, nodes[1]);
            const Vector3 a1 = position(cloth.m_end, nodes[0]), b1 = position(cloth.m_end, nodes[1]);
            const Vector3 sweeps[2][3] = {{a0, b0, b1}, {a0, b1, a1}};
            for (std::uint32_t o = 0; o < obstacle.m_pool.edges().size(); ++o)
            {
                const std::uint32_t* ends = obstacle.m_pool.edges()[o].m_vertices;
                const Vector3 c = position(obstacle.m_start, ends[0]), d = position(obstacle.m_start, ends[1]);
                Vector3 unused;
                if (!crosses(c, d, sweeps[0], unused) && !crosses(c, d, sweeps[1], unused)) continue;
                // Nearly parallel edges have no well-defined direction.
                if (length(cross(b0 - a0, d - c)) < 0.02 * length(b0 - a0) * length(d - c)) continue;
                ++found;
                const Contact* contact = find(contacts, DRAPE_EDGE_EDGE, e, o);
                ASSERT_TRUE(contact) << "edge " << e << " over edge " << o;
                EXPECT_LT(contact->m_gap1, 0.0f) << describe(*contact);
                EXPECT_GT(contact->m_gap0, 0.0f) << describe(*contact);
                EXPECT_LT(contact->m_time, 1.0f);
            }
        }
    }
    EXPECT_GT(found, 40u);
}
}  // namespace drape::test
