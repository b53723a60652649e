#include "tests/support/cases.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scenes/cloth_grid.h"
#include "scenes/shapes.h"
#include "scenes/vector3.h"

namespace drape::test
{
namespace
{
Vector3 cornerOf(const TriangleMesh& mesh, std::size_t triangle, int corner)
{
    const float* p = &mesh.m_positions[3 * std::size_t(mesh.m_triangles[3 * triangle + std::size_t(corner)])];
    return {p[0], p[1], p[2]};
}

Vector3 randomDirection(Random& random)
{
    Vector3 direction;
    do
    {
        direction = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    } while (length(direction) > 1 || length(direction) < 0.1);
    return normalized(direction);
}

// A triangle with its first corner at the origin, a point of it and the direction of its first edge.
struct RandomTriangle
{
    Vector3 m_corners[3], m_point, m_along;
};

RandomTriangle randomTriangle(float size, bool thin, Random& random)
{
    RandomTriangle result;
    const double longest = size * random.uniform(0.1f, 1.0f);
    const double width = longest * (thin ? std::pow(10.0, random.uniform(-7.0f, -3.0f)) : random.uniform(0.2f, 0.8f));
    result.m_along = randomDirection(random);
    const Vector3 across = normalized(cross(result.m_along, randomDirection(random)));
    const bool needle = random.below(2) == 0;
    result.m_corners[1] = longest * result.m_along;
    result.m_corners[2] =
        (needle && thin) ? result.m_corners[1] + width * normalized(across + random.uniform(-1, 1) * result.m_along)
                         : double(random.uniform(0.2f, 0.8f)) * result.m_corners[1] + width * across;
    if (random.below(2)) std::swap(result.m_corners[1], result.m_corners[2]);
    const double first = random.uniform(0, 1), second = (1 - first) * random.uniform(0, 1);
    result.m_point = first * result.m_corners[1] + second * result.m_corners[2];
    return result;
}

// Appends the triangle with its point moved to the place, its corners turned by `turn`.
void append(TriangleMesh& mesh, const RandomTriangle& triangle, const Vector3& place, std::uint32_t turn)
{
    for (std::uint32_t i = 0; i < 3; ++i)
    {
        const Vector3 p = triangle.m_corners[(i + turn) % 3] + (place - triangle.m_point);
        mesh.m_triangles.push_back(std::int32_t(mesh.vertexCount()));
        for (int axis = 0; axis < 3; ++axis)
            mesh.m_positions.push_back(float(p[axis]));
    }
}

// Computes the height of the highest surface over (x, z). Returns false if there is none.
bool surfaceHeight(const TriangleMesh& mesh, double x, double z, double& height)
{
    bool found = false;
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
    {
        const Vector3 a = cornerOf(mesh, t, 0), b = cornerOf(mesh, t, 1), c = cornerOf(mesh, t, 2);
        if (x < std::min({a.x, b.x, c.x}) || x > std::max({a.x, b.x, c.x})) continue;
        if (z < std::min({a.z, b.z, c.z}) || z > std::max({a.z, b.z, c.z})) continue;
        const double area = (b.x - a.x) * (c.z - a.z) - (b.z - a.z) * (c.x - a.x);
        if (area == 0) continue;
        const double v = ((x - a.x) * (c.z - a.z) - (z - a.z) * (c.x - a.x)) / area;
        const double w = ((b.x - a.x) * (z - a.z) - (b.z - a.z) * (x - a.x)) / area;
        if (v < 0 || w < 0 || v + w > 1) continue;
        const double y = a.y + v * (b.y - a.y) + w * (c.y - a.y);
        if (!found || y > height) height = y;
        found = true;
    }
    return found;
}
}  // namespace

namespace
{
TriangleMesh repeated(int count, const std::vector<float>& triangle)
{
    std::vector<float> corners;
    for (int i = 0; i < count; ++i)
        corners.insert(corners.end(), triangle.begin(), triangle.end());
    return looseTriangles(corners);
}

// Makes a line of triangles from x (m) on. Each centroid is farther than the one before by a third: a mean or a code
// splits off one triangle at a time.
TriangleMesh doublingLine(int count, float x)
{
    std::vector<float> corners;
    for (int i = 0; i < count; ++i, x *= 1.3f)
        corners.insert(corners.end(), {x, 0, 0, 1.1f * x, 0, 0, x, 1e-3f * x, 0});
    return looseTriangles(corners);
}

TriangleMesh evenLine(int count)
{
    std::vector<float> corners;
    for (int i = 0; i < count; ++i)
        corners.insert(corners.end(), {float(i), 0, 0, float(i) + 1.0f, 0, 0, float(i) + 0.5f, 1, 0});
    return looseTriangles(corners);
}

TriangleMesh withBadNodes(TriangleMesh mesh)
{
    mesh.m_positions[7] = std::numeric_limits<float>::quiet_NaN();
    mesh.m_positions[40] = std::numeric_limits<float>::infinity();
    mesh.m_positions[80] = 3e38f;
    return mesh;
}
}  // namespace

std::vector<NamedMesh> degenerateMeshes(int triangles)
{
    return {{"equal centroids", repeated(triangles, {0, 0, 0, 1, 0, 0, 0, 1, 0})},
            {"points", repeated(300, {1, 2, 3, 1, 2, 3, 1, 2, 3})},
            {"doubling line", doublingLine(300, 1e-30f)},
            {"doubling line backwards", doublingLine(300, -1e-30f)},
            {"even line", evenLine(triangles)},
            {"bad nodes", withBadNodes(makeSoup(1.0f, 0.1f, 500, 9))}};
}

TriangleMesh shapeNamed(const std::string& name)
{
    if (name == "sphere") return makeSphere(0.5f, 3);
    if (name == "box") return makeBox(1.0f, 0.6f, 0.8f);
    if (name == "torus") return makeTorus(0.5f, 0.2f, 32, 16);
    if (name == "bowl") return makeBowl(0.6f, 0.05f, 32, 8);
    if (name == "stairs") return makeStairs(1.0f, 0.6f, 1.0f, 5);
    return makeTerrain(1.4f, 0.2f, 24, 11);
}

TriangleMesh looseTriangles(const std::vector<float>& corners)
{
    TriangleMesh mesh;
    mesh.m_positions = corners;
    for (std::size_t i = 0; i < corners.size() / 3; ++i)
        mesh.m_triangles.push_back(std::int32_t(i));
    return mesh;
}

TriangleMesh coincidentTriangles(int count, float y)
{
    std::vector<float> corners;
    for (int i = 0; i < count; ++i)
        corners.insert(corners.end(), {0, y, 0, 1, y, 0, 0, y, 1});
    return looseTriangles(corners);
}

void drapeOver(const TriangleMesh& obstacle, TriangleMesh& cloth, float gapLow, float gapHigh, Random& random)
{
    for (std::size_t node = 0; node < cloth.vertexCount(); ++node)
    {
        float* p = &cloth.m_positions[3 * node];
        const float gap = random.uniform(gapLow, gapHigh);
        double height = 0;
        if (surfaceHeight(obstacle, p[0], p[2], height)) p[1] = float(height) + gap;
    }
}

void translate(std::vector<float>& positions, float x, float y, float z)
{
    for (std::size_t i = 0; i < positions.size(); i += 3)
    {
        positions[i] += x;
        positions[i + 1] += y;
        positions[i + 2] += z;
    }
}

void disturb(std::vector<float>& positions, float size, Random& random)
{
    for (float& coordinate : positions)
        coordinate += random.uniform(-size, size);
}

StepCase drapedCase(const std::string& shape, int nodes, float thickness, std::uint32_t seed)
{
    Random random(seed);
    StepCase step = {"cloth draped over " + shape,
                     seed,
                     makeClothGrid(nodes, nodes, 1.1f, 0.0f).m_mesh,
                     shapeNamed(shape),
                     {},
                     thickness};
    // The cloth is moved off the shape's symmetries and away from its vertices.
    translate(step.m_cloth.m_positions, random.uniform(-0.1f, 0.1f), 0.0f, random.uniform(-0.1f, 0.1f));
    disturb(step.m_cloth.m_positions, 0.005f, random);
    drapeOver(step.m_obstacle, step.m_cloth, 0.1f * thickness, 1.4f * thickness, random);
    step.m_end = step.m_cloth.m_positions;
    return step;
}

StepCase fallingCase(const std::string& shape, int nodes, float thickness, std::uint32_t seed)
{
    StepCase step = drapedCase(shape, nodes, thickness, seed);
    Random random(seed + 1);
    step.m_name = "cloth falling onto " + shape;
    translate(step.m_end, random.uniform(-0.01f, 0.01f), -1.5f * thickness, random.uniform(-0.01f, 0.01f));
    disturb(step.m_end, thickness, random);
    return step;
}

StepCase soupCase(int clothTriangles, int obstacleTriangles, bool moving, std::uint32_t seed)
{
    Random random(seed + 1);
    StepCase step = {moving ? "moving soup" : "soup",
                     seed,
                     makeSoup(1.0f, 0.2f, clothTriangles, seed),
                     makeSoup(1.0f, 0.2f, obstacleTriangles, seed + 2),
                     {},
                     0.02f};
    step.m_end = step.m_cloth.m_positions;
    if (moving) disturb(step.m_end, 0.1f, random);
    return step;
}

StepCase needleCase(Thin thin, int triangles, float size, bool moving, std::uint32_t seed)
{
    Random random(seed);
    StepCase step = {moving ? "moving needles" : "needles", seed, {}, {}, {}, 0.02f};
    for (int i = 0; i < triangles; ++i)
    {
        const RandomTriangle obstacle = randomTriangle(size, thin != Thin::Cloth, random);
        const RandomTriangle cloth = randomTriangle(size, thin != Thin::Obstacle, random);
        const Vector3 place = {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
        const Vector3 apart =
            random.below(3) ? normalized(cross(cloth.m_along, obstacle.m_along)) : randomDirection(random);
        append(step.m_obstacle, obstacle, place, random.below(3));
        append(step.m_cloth, cloth, place + double(step.m_thickness * random.uniform(0.01f, 1.2f)) * apart,
               random.below(3));
        const float far = moving ? 5.0f * step.m_thickness : 0.0f;
        const float way[3] = {random.uniform(-far, far), random.uniform(-far, far), random.uniform(-far, far)};
        for (std::size_t k = step.m_end.size(); k < step.m_cloth.m_positions.size(); ++k)
            step.m_end.push_back(step.m_cloth.m_positions[k] + way[k % 3]);
    }
    // Features that are near at the step's end are wanted.
    step.m_end.swap(step.m_cloth.m_positions);
    return step;
}

TriangleMesh partNear(const TriangleMesh& obstacle, const std::vector<float>& positions, float margin)
{
    float low[3] = {1e30f, 1e30f, 1e30f}, high[3] = {-1e30f, -1e30f, -1e30f};
    for (std::size_t i = 0; i < positions.size(); ++i)
    {
        low[i % 3] = std::min(low[i % 3], positions[i] - margin);
        high[i % 3] = std::max(high[i % 3], positions[i] + margin);
    }
    TriangleMesh part;
    std::vector<std::int32_t> renumbered(obstacle.vertexCount(), -1);
    for (std::size_t t = 0; t < obstacle.triangleCount(); ++t)
    {
        bool meets = true;
        for (int axis = 0; axis < 3; ++axis)
        {
            const double a = cornerOf(obstacle, t, 0)[axis], b = cornerOf(obstacle, t, 1)[axis],
                         c = cornerOf(obstacle, t, 2)[axis];
            meets = meets && std::max({a, b, c}) >= low[axis] && std::min({a, b, c}) <= high[axis];
        }
        for (int i = 0; meets && i < 3; ++i)
        {
            const std::int32_t vertex = obstacle.m_triangles[3 * t + std::size_t(i)];
            std::int32_t& number = renumbered[std::size_t(vertex)];
            if (number < 0)
            {
                number = std::int32_t(part.vertexCount());
                const float* p = &obstacle.m_positions[3 * std::size_t(vertex)];
                part.m_positions.insert(part.m_positions.end(), p, p + 3);
            }
            part.m_triangles.push_back(number);
        }
    }
    return part;
}
}  // namespace drape::test
