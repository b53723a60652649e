#include "scenes/shapes.h"

#include <cmath>

#include "scenes/mesh_builder.h"
#include "scenes/random.h"

namespace drape
{
namespace
{
constexpr double kPi = 3.14159265358979323846;

void spreadOverSphere(TriangleMesh& mesh, double radius)
{
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v)
    {
        float* p = &mesh.m_positions[3 * v];
        const double length = std::sqrt(static_cast<double>(p[0]) * p[0] + static_cast<double>(p[1]) * p[1] +
                                        static_cast<double>(p[2]) * p[2]);
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = static_cast<float>(p[axis] * radius / length);
    }
}

TriangleMesh icosahedron()
{
    TriangleMesh mesh;
    const double golden = 0.5 * (1 + std::sqrt(5.0));
    // The corners of three golden rectangles, one in each coordinate plane.
    for (int plane = 0; plane < 3; ++plane)
        for (int corner = 0; corner < 4; ++corner)
        {
            double p[3] = {0, 0, 0};
            p[(plane + 1) % 3] = corner & 1 ? 1 : -1;
            p[(plane + 2) % 3] = corner & 2 ? golden : -golden;
            addVertex(mesh, p[0], p[1], p[2]);
        }
    // Faces: every triple of corners at the edge length 2, wound so that the normal points outwards.
    const auto at = [&](int i, int axis) { return static_cast<double>(mesh.m_positions[3 * i + axis]); };
    const auto near = [&](int i, int j)
    {
        double sum = 0;
        for (int axis = 0; axis < 3; ++axis)
            sum += (at(i, axis) - at(j, axis)) * (at(i, axis) - at(j, axis));
        return sum < 4.5;
    };
    for (int a = 0; a < 12; ++a)
        for (int b = a + 1; b < 12; ++b)
            for (int c = b + 1; c < 12; ++c)
            {
                if (!near(a, b) || !near(b, c) || !near(c, a)) continue;
                const double volume = at(a, 0) * (at(b, 1) * at(c, 2) - at(b, 2) * at(c, 1)) -
                                      at(a, 1) * (at(b, 0) * at(c, 2) - at(b, 2) * at(c, 0)) +
                                      at(a, 2) * (at(b, 0) * at(c, 1) - at(b, 1) * at(c, 0));
                if (volume > 0)
                    addTriangle(mesh, a, b, c);
                else
                    addTriangle(mesh, a, c, b);
            }
    return mesh;
}
}  // namespace

TriangleMesh makeSphere(float radius, int levels)
{
    TriangleMesh mesh = icosahedron();
    spreadOverSphere(mesh, radius);
    for (int level = 0; level < levels; ++level)
    {
        mesh = subdivide(mesh);
        spreadOverSphere(mesh, radius);
    }
    return mesh;
}

TriangleMesh makeBox(float width, float height, float depth)
{
    TriangleMesh mesh;
    for (int corner = 0; corner < 8; ++corner)
        addVertex(mesh, (corner & 1 ? 0.5 : -0.5) * width, (corner & 2 ? 0.5 : -0.5) * height,
                  (corner & 4 ? 0.5 : -0.5) * depth);
    const int quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& quad : quads)
        addQuad(mesh, quad[0], quad[1], quad[2], quad[3]);
    return mesh;
}

TriangleMesh makeTorus(float ringRadius, float tubeRadius, int around, int across)
{
    TriangleMesh mesh;
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j)
        {
            const double u = 2 * kPi * i / around;
            const double v = 2 * kPi * j / across;
            const double r = ringRadius + tubeRadius * std::cos(v);
            addVertex(mesh, r * std::cos(u), tubeRadius * std::sin(v), r * std::sin(u));
        }
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j)
        {
            const int i1 = (i + 1) % around;
            const int j1 = (j + 1) % across;
            addQuad(mesh, i * across + j, i * across + j1, i1 * across + j1, i1 * across + j);
        }
    return mesh;
}

TriangleMesh makeBowl(float radius, float wall, int around, int rings)
{
    // A closed profile turned around the y axis: outer pole, outer wall up to the rim, inner wall down to the inner
    // pole.
    TriangleMesh mesh;
    const int levels = 2 * rings;
    for (int level = 0; level < levels; ++level)
    {
        const bool outer = level < rings;
        const int ring = outer ? level + 1 : levels - level;
        const double angle = 0.5 * kPi * ring / rings;
        const double r = outer ? radius : radius - wall;
        for (int i = 0; i < around; ++i)
        {
            const double turn = 2 * kPi * i / around;
            addVertex(mesh, r * std::sin(angle) * std::cos(turn), ring == rings ? 0.0 : -r * std::cos(angle),
                      r * std::sin(angle) * std::sin(turn));
        }
    }
    const int outerPole = levels * around;
    addVertex(mesh, 0, -radius, 0);
    addVertex(mesh, 0, -(radius - wall), 0);
    for (int i = 0; i < around; ++i)
    {
        const int next = (i + 1) % around;
        addTriangle(mesh, outerPole, i, next);
        for (int level = 0; level + 1 < levels; ++level)
            addQuad(mesh, level * around + i, (level + 1) * around + i, (level + 1) * around + next,
                    level * around + next);
        addTriangle(mesh, outerPole + 1, (levels - 1) * around + next, (levels - 1) * around + i);
    }
    return mesh;
}

TriangleMesh makeTerrain(float size, float amplitude, int cells, std::uint32_t seed)
{
    TriangleMesh mesh;
    Random random(seed);
    struct Wave
    {
        double m_x, m_z, m_phase, m_height;
    };
    std::vector<Wave> waves(8);
    for (std::size_t i = 0; i < waves.size(); ++i)
    {
        const double frequency = kPi * (1 + static_cast<double>(i)) / size;
        const double direction = random.within(0, 2 * kPi);
        waves[i] = {frequency * std::cos(direction), frequency * std::sin(direction), random.within(0, 2 * kPi),
                    amplitude / (1.0 + static_cast<double>(i))};
    }
    for (int i = 0; i <= cells; ++i)
        for (int j = 0; j <= cells; ++j)
        {
            const double x = size * (static_cast<double>(i) / cells - 0.5);
            const double z = size * (static_cast<double>(j) / cells - 0.5);
            double height = 0;
            for (const Wave& wave : waves)
                height += wave.m_height * std::sin(wave.m_x * x + wave.m_z * z + wave.m_phase);
            addVertex(mesh, x, height, z);
        }
    const int row = cells + 1;
    for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j)
            addQuad(mesh, i * row + j, i * row + j + 1, (i + 1) * row + j + 1, (i + 1) * row + j);
    return mesh;
}

TriangleMesh makeSoup(float size, float edge, int count, std::uint32_t seed)
{
    TriangleMesh mesh;
    Random random(seed);
    for (int t = 0; t < count; ++t)
    {
        double centre[3];
        for (double& value : centre)
            value = random.within(-0.5 * size, 0.5 * size);
        for (int corner = 0; corner < 3; ++corner)
        {
            double p[3];
            for (int axis = 0; axis < 3; ++axis)
                p[axis] = centre[axis] + random.within(-0.6 * edge, 0.6 * edge);
            addVertex(mesh, p[0], p[1], p[2]);
        }
        addTriangle(mesh, 3 * t, 3 * t + 1, 3 * t + 2);
    }
    return mesh;
}

const std::vector<std::string>& shapeNames()
{
    static const std::vector<std::string> names = {"sphere", "bowl", "stairs", "box", "torus", "terrain", "soup"};
    return names;
}

bool makeShape(const std::string& name, TriangleMesh& mesh)
{
    if (name == "sphere")
        mesh = makeSphere(1.0f, 5);
    else if (name == "bowl")
        mesh = makeBowl(1.0f, 0.1f, 128, 48);
    else if (name == "stairs")
        mesh = makeStairs(2.0f, 1.2f, 2.0f, 6);
    else if (name == "box")
        mesh = makeBox(2.0f, 1.0f, 2.0f);
    else if (name == "torus")
        mesh = makeTorus(0.7f, 0.3f, 96, 48);
    else if (name == "terrain")
        mesh = makeTerrain(2.0f, 0.15f, 96, 1);
    else if (name == "soup")
        mesh = makeSoup(2.0f, 0.2f, 600, 1);
    else
        return false;
    return true;
}
}  // namespace drape
