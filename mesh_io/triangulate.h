// Splits the polygons of a mesh file into triangles.
//
// A polygon of n corners becomes n − 2 triangles with its winding and no new vertices. Triangles keep the order of
// their faces. Quadrilaterals are split at corner 0 unless that would leave them; larger polygons are projected along
// their normal's largest axis and split by ear clipping (Meisters, Polygons have ears, 1975). A polygon that meets
// itself is split, too; where no ear is left, a note says that triangles may overlap. Cost: about n log n for outlines
// as they are drawn; a polygon that takes much longer is refused.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mesh_io/mesh_file.h"

namespace drape
{
// Fills `triangles` with three vertex indices per triangle and adds to `notes`. Positions of corners must be finite.
// Returns "" or which face could not be split in bounded time.
std::string triangulate(const MeshFile& mesh, std::vector<std::int32_t>& triangles, std::vector<std::string>& notes);
}  // namespace drape
