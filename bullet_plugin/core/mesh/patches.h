// Patches of the obstacles: connected triangles as far as there are, begun in leaf order, and the lists of features
// that they own (see kernels/shared/patch.h).
//
// Input: the joined triangles, leaf order and mesh slots. Output: per patch its blocks, per lane the feature. A patch
// never holds triangles of two meshes, and is full but for the last one of a mesh. Every triangle, and every vertex and
// edge of one, is in exactly one lane. O(n).
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/shared/patch.h"
#include "mesh_pool.h"

namespace drape
{
struct Patches
{
    std::vector<Patch> m_patches;
    std::vector<std::uint32_t> m_faceOwners;    // one block a patch
    std::vector<std::uint32_t> m_faceFeatures;  // per lane of those, see DRAPE_FEATURES_OWNED
    std::vector<std::uint32_t> m_vertexOwners;  // blocks in the patches' order
    std::vector<std::uint32_t> m_edgeOwners;
    std::vector<std::uint32_t> m_levels;  // first wide node of each level, lowest first, then the number of nodes
};

// The triangles of all patches, patch by patch. Runs of the leaf order alone, which follows a space-filling curve, are
// torn where the curve jumps: their volumes then overlap far more others.
// positions: m, x y z per joined vertex, of each mesh in one frame; any that are no numbers only make patches larger.
std::vector<std::uint32_t> clusteredOrder(const MeshPool& pool, const float* positions, std::uint32_t width);

// width: lanes in a block. positions: as above.
Patches makePatches(const MeshPool& obstacles, const float* positions, std::uint32_t width);
}  // namespace drape
