// Draws the cloth on the obstacle: soft key light, sky light with ambient occlusion, anti-aliased, on a studio floor.
// Uses all processor cores; the same input gives the same picture on one machine. Some seconds for the default size.
#pragma once

#include <string>

#include "scenes/mesh.h"

namespace drape
{
// Renders and writes a PNG. False with one line in `error`.
bool writePicture(const std::string& path, const TriangleMesh& cloth, const TriangleMesh& obstacle, std::string& error);
}  // namespace drape
