// Obstacle meshes of the random worlds: plain triangle meshes, and random ones that draw their sizes.
//
// scenes/shapes.h has similar shapes; these keep the vertices and the order that the seeds of the worlds stand for.
// Lengths in metres. A function that draws several numbers says in which order.
#pragma once

#include <functional>

#include "scenes/mesh.h"
#include "tests/worlds/world_random.h"

namespace drape::test
{
// Height over a point of the floor.
using Height = std::function<double(double x, double z)>;

// Waves along x and z, and a ripple that is not aligned with either.
struct Hills
{
    double m_height = 0;
    double m_frequencyX = 0, m_phaseX = 0, m_frequencyZ = 0, m_phaseZ = 0;
    double m_ripple = 0, m_rippleFrequency = 1, m_ripplePhase = 0;

    double operator()(double x, double z) const;
};
// Draws hills without a ripple, with frequencies from 2 to `frequency` radians a metre.
Hills randomHills(WorldRandom& random, const Range& height, double frequency);

// Open, centred at the origin, sizeX by sizeZ; flat without a height.
TriangleMesh gridMesh(int cellsX, int cellsZ, double sizeX, double sizeZ, const Height& height = nullptr);

// Closed, centred at the origin, twelve triangles.
TriangleMesh boxMesh(double x, double y, double z);
// Draws the edge lengths along z, y and x, in this order.
TriangleMesh randomBox(WorldRandom& random, const Range& edge);

TriangleMesh sphereMesh(double radius, int around, int rings);
// A sphere whose radius varies by the share `bumps`.
TriangleMesh bumpySphere(WorldRandom& random, double radius, int around, int rings, double bumps);
// Draws the bumps, the rings (5 and fewer than `moreRings` more), the triangles around (8 and fewer than `moreAround`
// more) and the radius, in this order.
TriangleMesh randomBlob(WorldRandom& random, const Range& radius, int moreAround, int moreRings, double mostBumps);

TriangleMesh torusMesh(double ringRadius, double tubeRadius, int around, int across);

// A part of a cone along y, from radius0 at y0 to radius1 at y1.
TriangleMesh frustumMesh(double radius0, double y0, double radius1, double y1, int around, bool caps);

// Appends the other mesh's triangles; vertices are not shared.
void append(TriangleMesh& mesh, const TriangleMesh& other);
void shift(TriangleMesh& mesh, double x, double y, double z);
}  // namespace drape::test
