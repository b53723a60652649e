// Identifies meshes.
#pragma once

#include <cstdint>

namespace drape
{
using MeshId = std::uint32_t;  // never reused while the pipeline lives
constexpr MeshId kNoMesh = 0xffffffffu;
}  // namespace drape
