// Row 5 of the stress table at random: triangles far longer than wide, turned at random, on the cloth's side, on the
// obstacle's or on both. tests/README.md has the table.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

#include "oracle/exact_predicates.h"
#include "tests/support/cases.h"
#include "tests/support/contact_oracle.h"

namespace drape::test
{
namespace
{
constexpr int kTriangles = 60;
// Positions in a pair's frame are rounded, closest points and heights over thin faces are made of a few dozen such
// roundings: 64 u of the pair's extent.
constexpr double kRounding = 64 * 5.97e-8;

struct Sides
{
    Side m_cloth, m_obstacle;
    std::vector<Contact> m_contacts;
};

Sides makeSides(const StepCase& step)
{
    Sides sides = {makeSide({step.m_cloth}), makeSide({step.m_obstacle}), {}};
    sides.m_cloth.m_end = step.m_end;
    sides.m_contacts = contactsOfAllPairs(sides.m_cloth, sides.m_obstacle, step.m_thickness);
    return sides;
}

// Returns the one loose triangle that owns the feature.
std::uint32_t triangleOfEdge(const Side& side, std::uint32_t edge)
{
    return side.m_pool.edges()[edge].m_vertices[0] / 3;
}
std::pair<std::uint32_t, std::uint32_t> trianglesOf(const Sides& sides, const Contact& contact)
{
    const std::uint32_t i = contact.m_clothFeature, j = contact.m_obstacleFeature;
    if (contact.m_kind == DRAPE_NODE_FACE) return {i / 3, j};
    if (contact.m_kind == DRAPE_FACE_VERTEX) return {i, j / 3};
    return {triangleOfEdge(sides.m_cloth, i), triangleOfEdge(sides.m_obstacle, j)};
}

std::array<Vector3, 3> cornersOf(const std::vector<float>& positions, std::uint32_t triangle)
{
    return {position(positions, 3 * triangle), position(positions, 3 * triangle + 1),
            position(positions, 3 * triangle + 2)};
}

double extentOf(const std::array<Vector3, 3>& a, const std::array<Vector3, 3>& b)
{
    double extent = 0;
    for (const Vector3& p : a)
    {
        for (const Vector3& q : b)
            extent = std::max(extent, length(p - q));
    }
    return extent;
}

Vector3 normalOf(const Contact& contact)
{
    return {contact.m_normal[0], contact.m_normal[1], contact.m_normal[2]};
}

// Returns true if the closest point is farther than `rounding` from every corner.
bool awayFromCorners(const Vector3& point, const std::array<Vector3, 3>& corners, double rounding)
{
    return std::all_of(corners.begin(), corners.end(),
                       [&](const Vector3& corner) { return length(point - corner) > rounding; });
}

// Finds the pairs of features that must have a contact. Around loose triangles every direction is open, so all pairs
// within 0.9 of the reach are required, whatever their shape. At a cloth's corner its node has the contact, at an
// edge's end the others.
class RequiredPairs
{
public:
    RequiredPairs(const Sides& sides, double reach) : m_sides(sides), m_reach(0.9 * reach)
    {
        for (const Contact& contact : sides.m_contacts)
            m_found.insert({contact.m_kind, contact.m_clothFeature, contact.m_obstacleFeature});
    }

    // Keeps only pairs of a thin face. Planes and edges of others may have passed something near by, which then has no
    // contact with them.
    void ofThinFaces(Thin thin)
    {
        m_edges = false;
        m_nodeFaces = thin != Thin::Cloth;
        m_faceVertices = thin != Thin::Obstacle;
    }

    // Fails the test for each that is not there. Returns their number.
    std::size_t expectFound()
    {
        for (std::uint32_t i = 0; i < kTriangles; ++i)
        {
            for (std::uint32_t j = 0; j < kTriangles; ++j)
                visit(i, j);
        }
        return m_count;
    }

private:
    void require(std::uint32_t kind, std::uint32_t i, std::uint32_t j, double distance)
    {
        if (distance < 10 * m_rounding || distance > m_reach) return;
        ++m_count;
        EXPECT_EQ(m_found.count({kind, i, j}), 1u)
            << "kind " << kind << " cloth " << i << " obstacle " << j << " at " << distance;
    }

    void visit(std::uint32_t i, std::uint32_t j)
    {
        const auto cloth = cornersOf(m_sides.m_cloth.m_end, i), obstacle = cornersOf(m_sides.m_obstacle.m_start, j);
        m_rounding = kRounding * extentOf(cloth, obstacle);
        for (std::uint32_t k = 0; k < 3; ++k)
        {
            if (m_nodeFaces)
                require(DRAPE_NODE_FACE, 3 * i + k, j, nearestOnTriangle(cloth[k], obstacle.data()).m_distance);
            const NearestOnTriangle nearest = nearestOnTriangle(obstacle[k], cloth.data());
            if (m_faceVertices && awayFromCorners(nearest.m_point, cloth, 10 * m_rounding))
                require(DRAPE_FACE_VERTEX, i, 3 * j + k, nearest.m_distance);
            for (std::uint32_t l = 0; l < 3 && m_edges; ++l)
                visitEdges(m_sides.m_cloth.m_pool.triangles()[i].m_edges[k],
                           m_sides.m_obstacle.m_pool.triangles()[j].m_edges[l]);
        }
    }

    void visitEdges(std::uint32_t i, std::uint32_t j)
    {
        const std::uint32_t* ends = m_sides.m_cloth.m_pool.edges()[i].m_vertices;
        const std::uint32_t* others = m_sides.m_obstacle.m_pool.edges()[j].m_vertices;
        const Vector3 a = position(m_sides.m_cloth.m_end, ends[0]), b = position(m_sides.m_cloth.m_end, ends[1]);
        const Vector3 c = position(m_sides.m_obstacle.m_start, others[0]),
                      d = position(m_sides.m_obstacle.m_start, others[1]);
        // Rounding turns edges over their length, and moves their closest points by that over the squared sine.
        const double sine = length(cross(b - a, d - c)) / (length(b - a) * length(d - c));
        const NearestOnSegments nearest = nearestOnSegments(a, b, c, d);
        const double shorter = std::min(length(b - a), length(d - c));
        const double margin = m_rounding * (1 + nearest.m_distance / shorter) / (sine * sine);
        if (!(margin < shorter)) return;
        if (awayFromCorners(nearest.m_firstPoint, {a, b, a}, margin) &&
            awayFromCorners(nearest.m_secondPoint, {c, d, c}, margin))
            require(DRAPE_EDGE_EDGE, i, j, nearest.m_distance);
    }

    const Sides& m_sides;
    double m_reach;
    bool m_nodeFaces = true, m_faceVertices = true, m_edges = true;
    double m_rounding = 0;
    std::size_t m_count = 0;
    std::set<std::array<std::uint32_t, 3>> m_found;
};

// Normals point from the obstacle's nearest point to the cloth's, gaps are their distance.
void expectTrueDirections(const Sides& sides)
{
    for (const Contact& contact : sides.m_contacts)
    {
        const Vector3 offset = contactOffset(contact, sides.m_cloth, sides.m_obstacle);
        const double distance = length(offset);
        const auto triangles = trianglesOf(sides, contact);
        const double rounding = kRounding * extentOf(cornersOf(sides.m_cloth.m_end, triangles.first),
                                                     cornersOf(sides.m_obstacle.m_start, triangles.second));
        if (distance < 10 * rounding) continue;
        EXPECT_NEAR(contact.m_gap1, distance, rounding) << describe(contact);
        EXPECT_LE(length(normalOf(contact) - (1 / distance) * offset), 2 * rounding / distance + 1e-5)
            << describe(contact) << "\ndistance " << distance;
    }
}
// Returns how many pairs' features pass each other: a cloth's node a face, or a cloth's face an obstacle's vertex,
// which sees the face stand still and itself go the other way. Each must have a contact that tells from where.
std::size_t expectCrossingsFound(const Sides& sides)
{
    std::set<std::pair<std::uint32_t, std::uint32_t>> found;
    for (const Contact& contact : sides.m_contacts)
        found.insert(trianglesOf(sides, contact));
    std::size_t crossed = 0;
    for (std::uint32_t i = 0; i < kTriangles; ++i)
    {
        const auto start = cornersOf(sides.m_cloth.m_start, i), end = cornersOf(sides.m_cloth.m_end, i);
        for (std::uint32_t j = 0; j < kTriangles; ++j)
        {
            const auto obstacle = cornersOf(sides.m_obstacle.m_start, j);
            for (std::size_t k = 0; k < 3; ++k)
            {
                if (!segmentMeetsTriangle(start[k], end[k], obstacle.data())) continue;
                ++crossed;
                EXPECT_EQ(found.count({i, j}), 1u) << "cloth " << i << " corner " << k << " obstacle " << j;
            }
        }
    }
    return crossed;
}

// Expects of a contact that was met before the step's end that the cloth's point started in front of the normal.
void expectSidesOfMeetings(const Sides& sides)
{
    for (const Contact& contact : sides.m_contacts)
    {
        if (contact.m_time == 1.0f) continue;
        const auto triangles = trianglesOf(sides, contact);
        const auto start = cornersOf(sides.m_cloth.m_start, triangles.first);
        const double rounding = kRounding * extentOf(start, cornersOf(sides.m_obstacle.m_start, triangles.second));
        EXPECT_GE(contact.m_gap0, -rounding) << describe(contact);
    }
}
// A cloth triangle whose first node hangs over a strip's inside, and the direction from the strip to it.
struct StripCase
{
    StepCase m_step;
    Vector3 m_up;
};

Vector3 randomDirection(Random& random)
{
    const Vector3 direction = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    return length(direction) > 0.1 ? normalized(direction) : randomDirection(random);
}

StripCase nodeOverStrip(float size, float width, float height, bool moving, Random& random)
{
    StripCase result = {{"node over a strip", 0, {}, {}, {}, 2 * height}, randomDirection(random)};
    const Vector3 along = normalized(cross(result.m_up, randomDirection(random)));
    const Vector3 across = cross(result.m_up, along);
    const Vector3 corners[3] = {{0, 0, 0}, double(size) * along, double(size) * along + double(width) * across};
    const double place = random.uniform(0.3f, 0.9f);
    const Vector3 foot = place * (corners[1] + double(random.uniform(0.1f, 0.9f)) * (corners[2] - corners[1]));
    const Vector3 node = foot + double(height) * result.m_up;
    const Vector3 others[3] = {node, node + along + result.m_up, node - along + result.m_up};
    std::vector<float> obstacle, start, end;
    for (int i = 0; i < 9; ++i)
    {
        obstacle.push_back(float(corners[i / 3][i % 3]));
        end.push_back(float(others[i / 3][i % 3]));
        start.push_back(float((others[i / 3] + (moving ? double(height) : 0.0) * result.m_up)[i % 3]));
    }
    result.m_step.m_obstacle = looseTriangles(obstacle);
    result.m_step.m_cloth = looseTriangles(start);
    result.m_step.m_end = end;
    // The corners' rounding turns the strip: up is where the node is from what is left of it.
    const Side strip = makeSide({result.m_step.m_obstacle});
    const auto rounded = cornersOf(strip.m_start, 0);
    const Vector3 above = position(end, 0);
    result.m_up = normalized(above - nearestOnTriangle(above, rounded.data()).m_point);
    return result;
}
}  // namespace

TEST(Needles, RestingNeedlesLoseNoContactAndDirectionsAreTrue)
{
    std::size_t near = 0;
    for (const Thin thin : {Thin::Cloth, Thin::Obstacle, Thin::Both})
    {
        for (const float size : {0.1f, 1.0f, 10.0f, 100.0f})
        {
            for (std::uint32_t seed = 500; seed < 506; ++seed)
            {
                const StepCase step = needleCase(thin, kTriangles, size, false, seed);
                SCOPED_TRACE(step.trace() + ", thin " + std::to_string(int(thin)) + ", size " + std::to_string(size));
                const Sides sides = makeSides(step);
                near += RequiredPairs(sides, step.m_thickness).expectFound();
                expectTrueDirections(sides);
            }
        }
    }
    EXPECT_GT(near, 1000u);
}

// Near features have contacts, as at rest. A node whose path crosses a face has a contact of its triangle there. All
// features that met have normals to the side that they came from.
TEST(Needles, MovingNoneIsPassedAndSidesAreTrue)
{
    std::size_t near = 0, crossed = 0;
    for (const Thin thin : {Thin::Cloth, Thin::Obstacle, Thin::Both})
    {
        for (const float size : {0.1f, 1.0f, 10.0f, 100.0f})
        {
            for (std::uint32_t seed = 510; seed < 516; ++seed)
            {
                const StepCase step = needleCase(thin, kTriangles, size, true, seed);
                SCOPED_TRACE(step.trace() + ", thin " + std::to_string(int(thin)) + ", size " + std::to_string(size));
                const Sides sides = makeSides(step);
                RequiredPairs required(sides, step.m_thickness);
                required.ofThinFaces(thin);
                near += required.expectFound();
                crossed += expectCrossingsFound(sides);
                expectSidesOfMeetings(sides);
            }
        }
    }
    EXPECT_GT(near, 1000u);
    EXPECT_GT(crossed, 100u);
}

// Nodes over the inside of long strips, less than the thickness above or below them, that do not move or come nearer by
// as much again.
TEST(Needles, NodesOverStripsStayOnTheirSide)
{
    Random random(540);
    SCOPED_TRACE("seed 540");
    const float strips[][3] = {{100, 0.01f, 0.01f}, {100, 0.04f, 0.01f}, {10, 0.01f, 9e-4f}, {3, 1e-3f, 5e-4f},
                               {1, 1e-5f, 0.01f},   {1, 1e-3f, 1e-4f}};  // length, width, height: m
    for (const auto& strip : strips)
    {
        for (int trial = 0; trial < 300; ++trial)
        {
            const StripCase over = nodeOverStrip(strip[0], strip[1], strip[2], trial % 2 == 1, random);
            const Sides sides = makeSides(over.m_step);
            std::size_t found = 0;
            for (const Contact& contact : sides.m_contacts)
            {
                if (contact.m_kind != DRAPE_NODE_FACE || contact.m_clothFeature != 0) continue;
                ++found;
                EXPECT_GT(dot(normalOf(contact), over.m_up), 0.9) << describe(contact);
                EXPECT_NEAR(contact.m_gap1, strip[2], 0.01f * strip[2] + kRounding * strip[0]) << describe(contact);
            }
            ASSERT_EQ(found, 1u) << "strip " << strip[0] << " by " << strip[1] << ", trial " << trial;
        }
    }
}
}  // namespace drape::test
