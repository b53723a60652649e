#include "scenes/lathe.h"

#include <cmath>

#include "scenes/mesh_builder.h"

namespace drape
{
namespace
{
constexpr double kPi = 3.14159265358979323846;

void addRing(TriangleMesh& mesh, double radius, double height, int around)
{
    for (int i = 0; i < around; ++i)
    {
        const double angle = 2 * kPi * i / around;
        addVertex(mesh, radius * std::cos(angle), height, radius * std::sin(angle));
    }
}

// Joins two rings of vertices, the one below first.
void joinRings(TriangleMesh& mesh, int below, int above, int around)
{
    for (int i = 0; i < around; ++i)
    {
        const int next = (i + 1) % around;
        addQuad(mesh, below + i, above + i, above + next, below + next);
    }
}

// Appends a quarter of a circle around (distance, height), between two angles above the horizontal.
void addArc(LatheProfile& profile, double distance, double height, double radius, double from, double to, int parts)
{
    for (int i = 0; i <= parts; ++i)
    {
        const double angle = from + (to - from) * i / parts;
        const double off = distance + radius * std::cos(angle);
        profile.emplace_back(off > 1e-9 * radius ? off : 0.0, height + radius * std::sin(angle));
    }
}
}  // namespace

TriangleMesh makeLathe(const LatheProfile& profile, int around)
{
    TriangleMesh mesh;
    addVertex(mesh, 0, profile.front().second, 0);
    for (std::size_t k = 1; k + 1 < profile.size(); ++k)
        addRing(mesh, profile[k].first, profile[k].second, around);
    addVertex(mesh, 0, profile.back().second, 0);
    const int rings = static_cast<int>(profile.size()) - 2, top = 1 + rings * around;
    for (int i = 0; i < around; ++i)
    {
        const int next = (i + 1) % around;
        addTriangle(mesh, 0, 1 + i, 1 + next);
        addTriangle(mesh, top, top - around + next, top - around + i);
    }
    for (int k = 0; k + 1 < rings; ++k)
        joinRings(mesh, 1 + k * around, 1 + (k + 1) * around, around);
    return mesh;
}

TriangleMesh makeRing(const LatheProfile& profile, int around)
{
    TriangleMesh mesh;
    for (const auto& [distance, height] : profile)
        addRing(mesh, distance, height, around);
    const int rings = static_cast<int>(profile.size());
    for (int k = 0; k < rings; ++k)
        joinRings(mesh, k * around, (k + 1) % rings * around, around);
    return mesh;
}

TriangleMesh makeCylinder(double radius, double length, double rounding, int around)
{
    const double half = length / 2 - rounding, inner = radius - rounding;
    LatheProfile profile = {{0, -length / 2}};
    addArc(profile, inner, -half, rounding, -kPi / 2, 0, 4);
    addArc(profile, inner, half, rounding, 0, kPi / 2, 4);
    profile.emplace_back(0, length / 2);
    return makeLathe(profile, around);
}

TriangleMesh makeCapsule(double radius, double length, int around)
{
    LatheProfile profile;
    addArc(profile, 0, -length / 2, radius, -kPi / 2, 0, around / 4);
    addArc(profile, 0, length / 2, radius, 0, kPi / 2, around / 4);
    return makeLathe(profile, around);
}
}  // namespace drape
