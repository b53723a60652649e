#include "tests/worlds/world_meshes.h"

#include <cmath>

#include "scenes/mesh_builder.h"

namespace drape::test
{
namespace
{
constexpr double kPi = 3.14159265358979;
}

double Hills::operator()(double x, double z) const
{
    return m_height * std::sin(m_frequencyX * x + m_phaseX) * std::cos(m_frequencyZ * z + m_phaseZ) +
           m_ripple * std::sin(m_rippleFrequency * x * z + m_ripplePhase);
}

Hills randomHills(WorldRandom& random, const Range& height, double frequency)
{
    Hills hills;
    hills.m_height = random.within(height);
    hills.m_frequencyX = random.within(2, frequency);
    hills.m_phaseX = random.within(0, 6);
    hills.m_frequencyZ = random.within(2, frequency);
    hills.m_phaseZ = random.within(0, 6);
    return hills;
}

TriangleMesh gridMesh(int cellsX, int cellsZ, double sizeX, double sizeZ, const Height& height)
{
    TriangleMesh mesh;
    for (int j = 0; j <= cellsZ; ++j)
        for (int i = 0; i <= cellsX; ++i)
        {
            const double x = sizeX * (static_cast<double>(i) / cellsX - .5);
            const double z = sizeZ * (static_cast<double>(j) / cellsZ - .5);
            addVertex(mesh, x, height ? height(x, z) : 0, z);
        }
    for (int j = 0; j < cellsZ; ++j)
        for (int i = 0; i < cellsX; ++i)
        {
            const int a = j * (cellsX + 1) + i, b = a + 1, c = a + cellsX + 1, d = c + 1;
            addTriangle(mesh, a, c, b);
            addTriangle(mesh, b, c, d);
        }
    return mesh;
}

TriangleMesh boxMesh(double x, double y, double z)
{
    TriangleMesh mesh;
    x /= 2;
    y /= 2;
    z /= 2;
    for (int i = 0; i < 8; ++i)
        addVertex(mesh, i & 1 ? x : -x, i & 2 ? y : -y, i & 4 ? z : -z);
    const int quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& quad : quads)
        addQuad(mesh, quad[0], quad[1], quad[2], quad[3]);
    return mesh;
}

TriangleMesh randomBox(WorldRandom& random, const Range& edge)
{
    const double z = random.within(edge), y = random.within(edge), x = random.within(edge);
    return boxMesh(x, y, z);
}

TriangleMesh sphereMesh(double radius, int around, int rings)
{
    TriangleMesh mesh;
    mesh.m_positions.reserve(3 * static_cast<std::size_t>((rings - 1) * around + 2));
    addVertex(mesh, 0, radius, 0);
    for (int j = 1; j < rings; ++j)
        for (int i = 0; i < around; ++i)
        {
            const double a = kPi * j / rings, b = 2 * kPi * i / around;
            addVertex(mesh, radius * std::sin(a) * std::cos(b), radius * std::cos(a),
                      radius * std::sin(a) * std::sin(b));
        }
    addVertex(mesh, 0, -radius, 0);
    const int bottom = 1 + (rings - 1) * around;
    const auto at = [=](int ring, int i) { return 1 + (ring - 1) * around + i % around; };
    for (int i = 0; i < around; ++i)
    {
        addTriangle(mesh, 0, at(1, i + 1), at(1, i));
        addTriangle(mesh, bottom, at(rings - 1, i), at(rings - 1, i + 1));
    }
    for (int j = 1; j + 1 < rings; ++j)
        for (int i = 0; i < around; ++i)
            addQuad(mesh, at(j, i), at(j, i + 1), at(j + 1, i + 1), at(j + 1, i));
    return mesh;
}

TriangleMesh bumpySphere(WorldRandom& random, double radius, int around, int rings, double bumps)
{
    TriangleMesh mesh = sphereMesh(radius, around, rings);
    const double a = random.within(1, 5), b = random.within(1, 5), phase = random.within(0, 6);
    for (std::size_t i = 0; i < mesh.m_positions.size(); i += 3)
    {
        float* p = &mesh.m_positions[i];
        const double factor = 1 + bumps * std::sin(a * p[0] / radius + phase) * std::cos(b * p[1] / radius + phase);
        for (int axis = 0; axis < 3; ++axis)
            p[axis] *= static_cast<float>(factor);
    }
    return mesh;
}

TriangleMesh randomBlob(WorldRandom& random, const Range& radius, int moreAround, int moreRings, double mostBumps)
{
    const double bumps = random.within(0, mostBumps);
    const int rings = 5 + random.below(moreRings), around = 8 + random.below(moreAround);
    return bumpySphere(random, random.within(radius), around, rings, bumps);
}

TriangleMesh torusMesh(double ringRadius, double tubeRadius, int around, int across)
{
    TriangleMesh mesh;
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j)
        {
            const double a = 2 * kPi * i / around, b = 2 * kPi * j / across;
            const double radius = ringRadius + tubeRadius * std::cos(b);
            addVertex(mesh, radius * std::cos(a), tubeRadius * std::sin(b), radius * std::sin(a));
        }
    const auto at = [=](int i, int j) { return (i % around) * across + j % across; };
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j)
            addQuad(mesh, at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
    return mesh;
}

TriangleMesh frustumMesh(double radius0, double y0, double radius1, double y1, int around, bool caps)
{
    TriangleMesh mesh;
    for (int end = 0; end < 2; ++end)
        for (int i = 0; i < around; ++i)
        {
            const double a = 2 * kPi * i / around, radius = end ? radius1 : radius0;
            addVertex(mesh, radius * std::cos(a), end ? y1 : y0, radius * std::sin(a));
        }
    for (int i = 0; i < around; ++i)
    {
        const int j = (i + 1) % around;
        addQuad(mesh, i, around + i, around + j, j);
    }
    if (!caps) return mesh;
    const int bottom = 2 * around, top = bottom + 1;
    addVertex(mesh, 0, y0, 0);
    addVertex(mesh, 0, y1, 0);
    for (int i = 0; i < around; ++i)
    {
        const int j = (i + 1) % around;
        addTriangle(mesh, bottom, i, j);
        addTriangle(mesh, top, around + j, around + i);
    }
    return mesh;
}

void append(TriangleMesh& mesh, const TriangleMesh& other)
{
    const std::int32_t base = static_cast<std::int32_t>(mesh.vertexCount());
    mesh.m_positions.insert(mesh.m_positions.end(), other.m_positions.begin(), other.m_positions.end());
    for (const std::int32_t vertex : other.m_triangles)
        mesh.m_triangles.push_back(vertex + base);
}

void shift(TriangleMesh& mesh, double x, double y, double z)
{
    const double by[3] = {x, y, z};
    for (std::size_t i = 0; i < mesh.m_positions.size(); ++i)
        mesh.m_positions[i] += static_cast<float>(by[i % 3]);
}
}  // namespace drape::test
