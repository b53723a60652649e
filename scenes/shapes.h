// Seeded, repeatable obstacle meshes: the same arguments give the same mesh (the same bits where the C library is the
// same).
//
// Every function returns vertices in metres, y up, triangles counter-clockwise from outside. "Closed" shapes are
// watertight 2-manifolds; terrain and soup are open. Sizes must be positive, counts at least what each comment says.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenes/mesh.h"

namespace drape
{
// Closed. Icosahedron split `levels` times (20·4^levels triangles, levels ≤ 8), vertices at `radius`, centre at 0.
TriangleMesh makeSphere(float radius, int levels);

// Closed. Box of the given edge lengths, centre at 0, 12 triangles.
TriangleMesh makeBox(float width, float height, float depth);

// Closed. Ring in the xz plane; `around` ≥ 3 by `across` ≥ 3 quads.
TriangleMesh makeTorus(float ringRadius, float tubeRadius, int around, int across);

// Closed. Half of a spherical shell, opening up, rim at y = 0; wall thickness in m < radius; `around` ≥ 3, `rings` ≥ 2.
TriangleMesh makeBowl(float radius, float wall, int around, int rings);

// Closed. A solid flight of `steps` ≥ 1 stairs with sharp edges, rising along +x from y = 0.
TriangleMesh makeStairs(float width, float height, float depth, int steps);

// Open. Height field of `cells` × `cells` squares over size × size, smooth seeded noise of the given amplitude (m).
TriangleMesh makeTerrain(float size, float amplitude, int cells, std::uint32_t seed);

// Open. `count` triangles with edges around `edge` m, placed at random in a cube of side `size`; none share vertices.
TriangleMesh makeSoup(float size, float edge, int count, std::uint32_t seed);

// Names that makeShape knows.
const std::vector<std::string>& shapeNames();

// Makes the named shape at a resolution for demonstrations. Returns false if the name is unknown.
bool makeShape(const std::string& name, TriangleMesh& mesh);
}  // namespace drape
