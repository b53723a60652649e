// Polygons become triangles that cover them once, in bounded time.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <random>

#include "mesh_io/triangulate.h"

namespace drape::test
{
namespace
{
using Points = std::vector<std::array<double, 2>>;

constexpr double kPi = 3.14159265358979323846;

// Makes one face in the plane that `axis` is normal to.
MeshFile faceOf(const Points& points, int axis = 2)
{
    MeshFile mesh;
    for (const auto& p : points)
    {
        double position[3] = {0, 0, 0};
        position[(axis + 1) % 3] = p[0];
        position[(axis + 2) % 3] = p[1];
        mesh.m_corners.push_back(static_cast<std::int32_t>(mesh.vertexCount()));
        mesh.addVertex(position[0], position[1], position[2]);
    }
    mesh.endFace();
    return mesh;
}

double areaOf(const Points& points, const std::int32_t* corners, std::size_t count)
{
    double area = 0;
    for (std::size_t i = 0; i < count; ++i)
    {
        const auto& p = points[std::size_t(corners[i])];
        const auto& q = points[std::size_t(corners[(i + 1) % count])];
        area += 0.5 * (p[0] * q[1] - p[1] * q[0]);
    }
    return area;
}

// Expects n − 2 triangles, none of them flipped, whose areas add up to the outline's: they cover it once.
void expectCovered(const Points& points, const MeshFile& mesh)
{
    std::vector<std::int32_t> triangles;
    std::vector<std::string> notes;
    ASSERT_EQ(triangulate(mesh, triangles, notes), "");
    EXPECT_TRUE(notes.empty());
    ASSERT_EQ(triangles.size(), 3 * (points.size() - 2));
    const double whole = areaOf(points, mesh.m_corners.data(), points.size());
    const double sign = whole < 0 ? -1 : 1;
    double sum = 0;
    for (std::size_t i = 0; i < triangles.size(); i += 3)
    {
        const double area = areaOf(points, &triangles[i], 3);
        EXPECT_GE(sign * area, -1e-12 * std::fabs(whole));
        sum += area;
    }
    EXPECT_NEAR(sum, whole, 1e-9 * std::fabs(whole));
}

Points star(std::size_t count, unsigned seed)
{
    std::mt19937 random(seed);
    Points points;
    for (std::size_t i = 0; i < count; ++i)
    {
        const double angle = 2 * kPi * double(i) / double(count);
        const double radius = 0.2 + double(random()) / double(std::mt19937::max());
        points.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    return points;
}

Points spiral(std::size_t count, double turns)
{
    Points points;
    for (std::size_t i = 0; i < 2 * count; ++i)
    {
        const double at = turns * double(i < count ? i : 2 * count - 1 - i) / double(count);
        const double radius = (i < count ? 1.5 : 1.0) + at;  // outwards on the outer side, back on the inner one
        points.push_back({radius * std::cos(2 * kPi * at), radius * std::sin(2 * kPi * at)});
    }
    return points;
}

Points comb(int teeth, double height)
{
    Points points = {{-1, -5}, {4.0 * teeth, -5}};
    for (int i = teeth; i-- > 0;)
        points.insert(points.end(), {{4.0 * i + 2, 0}, {4.0 * i + 2, height}, {4.0 * i, height}, {4.0 * i, 0}});
    return points;
}
}  // namespace

TEST(Triangulate, SplitsQuadrilateralsAtCornerZeroUnlessThatLeavesThem)
{
    const auto split = [](const Points& points)
    {
        std::vector<std::int32_t> triangles;
        std::vector<std::string> notes;
        EXPECT_EQ(triangulate(faceOf(points), triangles, notes), "");
        return triangles;
    };
    EXPECT_EQ(split({{0, 0}, {1, 0}, {1, 1}, {0, 1}}), std::vector<std::int32_t>({0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(split({{0, 0}, {1, 1}, {2, 0}, {1, 3}}), std::vector<std::int32_t>({1, 2, 3, 1, 3, 0}));
    EXPECT_EQ(split({{1, 1}, {2, 0}, {1, 3}, {0, 0}}), std::vector<std::int32_t>({0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(split({{0, 0}, {0, 0}, {0, 0}, {0, 0}}).size(), 6u);
}

TEST(Triangulate, CoversPolygonsOfEveryShapeInEveryPlane)
{
    std::vector<Points> shapes = {
        {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}},          // an L
        {{0, 0}, {1, 0}, {2, 0}, {2, 2}, {1, 2}, {0, 2}, {0, 1}},  // corners within straight edges
        {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}},  // a hole, cut open
        comb(5, 10),
        spiral(40, 3)};
    for (unsigned seed = 0; seed < 200; ++seed)
        shapes.push_back(star(5 + seed % 40, seed));
    for (std::size_t i = 0; i < shapes.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
        {
            SCOPED_TRACE("shape " + std::to_string(i) + ", axis " + std::to_string(axis));
            expectCovered(shapes[i], faceOf(shapes[i], axis));
            const Points turned(shapes[i].rbegin(), shapes[i].rend());
            expectCovered(turned, faceOf(turned, axis));
        }
}

// All of them take about a second on one core. A method whose cost is the square of the corners would take minutes.
TEST(Triangulate, IsQuickForManyThousandCorners)
{
    const auto start = std::chrono::steady_clock::now();
    for (const Points& shape : {star(50000, 1), spiral(25000, 100), comb(12500, 1e5)})
        expectCovered(shape, faceOf(shape));
    // Outlines without sense: any triangles, but soon.
    std::mt19937 random(1);
    Points scribble, line;
    for (int i = 0; i < 50000; ++i)
    {
        scribble.push_back({double(random()), double(random())});
        line.push_back({double(i), 0});
    }
    for (const Points& shape : {scribble, line, Points(50000, {1, 2})})
    {
        std::vector<std::int32_t> triangles;
        std::vector<std::string> notes;
        const bool isSplit = triangulate(faceOf(shape), triangles, notes).empty();
        EXPECT_TRUE(!isSplit || triangles.size() == 3 * (shape.size() - 2));
    }
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
}

TEST(Triangulate, SplitsAnOutlineThatMeetsItselfAndSaysSoWhereNoEarIsLeft)
{
    for (const Points& outline : {Points{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {1, 0}},
                                  Points{{0, 0}, {0, 4}, {3, 1}, {3, 4}, {0, 1}, {3, 0}, {1, 2}}})
    {
        std::vector<std::int32_t> triangles;
        std::vector<std::string> notes;
        EXPECT_EQ(triangulate(faceOf(outline), triangles, notes), "");
        EXPECT_EQ(triangles.size(), 3 * (outline.size() - 2));
        ASSERT_EQ(notes.size(), 1u);
        EXPECT_NE(notes[0].find("1 face"), std::string::npos) << notes[0];
    }
}
}  // namespace drape::test
