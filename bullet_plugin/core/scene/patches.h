// Patches of the obstacles: triangles that are connected as far as possible, begun in leaf order, and the lists of
// features that they own (see kernels/shared/patch.h).
//
// Input: meshes' triangles and leaf order. Output: per patch its blocks, per lane the feature. A patch never contains
// triangles of two meshes, and is full except the last one of a mesh. Every triangle, and every vertex and edge of
// one, is in exactly one lane. O(n); appending meshes costs in proportion to the new meshes alone.
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

// Positions of a list from m_first up to m_last.
struct ItemRange
{
    std::size_t m_first, m_last;
    std::size_t count() const { return m_last - m_first; }
    bool empty() const { return m_last <= m_first; }
    std::uint32_t first() const { return std::uint32_t(m_first); }
    std::uint32_t last() const { return std::uint32_t(m_last); }
};

// Returns the mesh's own triangles, patch by patch. Runs of the leaf order alone, which follows a space-filling curve,
// are torn where the curve jumps: their volumes then overlap far more others. positions: m, x y z per vertex of the
// mesh, in any one frame; NaN only makes patches larger.
std::vector<std::uint32_t> clusteredOrder(const PooledMesh& mesh, const float* positions, std::uint32_t width);
// Completes the joined triangles of the pool's meshes in that order; triangles before slot `first` exist already.
void clusterMeshes(const MeshPool& pool, std::size_t first, std::uint32_t width, std::vector<std::uint32_t>& order);

// Keeps the patches of the first `slots` meshes; does not update the levels.
void keepPatches(Patches& patches, std::size_t slots, std::uint32_t width);
// Adds the patches of the pool's next mesh. positions: as above. Does not update the levels.
void appendPatches(Patches& patches, const MeshPool& pool, std::size_t slot, const float* positions,
                   std::uint32_t width);
void makeLevels(Patches& patches, std::uint32_t width);

// The patches of those meshes.
ItemRange patchesOf(const Patches& patches, SlotRange slots);
// The lanes of those patches, which must exist.
struct PatchLanes
{
    ItemRange m_faces, m_vertices, m_edges;
};
PatchLanes lanesOf(const Patches& patches, ItemRange range, std::uint32_t width);

// Positions of one level of the wide tree; `children` of them exist.
struct LevelPlaces
{
    std::size_t m_level, m_children;
    ItemRange m_entries;
};
// Returns the nodes to rebuild, lowest level first, after the patches `range` changed; all of the upper levels if
// levels have moved. A range that includes the last child includes the empty positions behind it.
std::vector<LevelPlaces> changedPlaces(const Patches& patches, ItemRange range, bool levelsMoved, std::uint32_t width);

// Returns the vertices, or edges, over all meshes, that the lanes' owners name; DRAPE_NO_FEATURE for unused lanes.
std::vector<std::uint32_t> vertexIdsOf(const std::vector<std::uint32_t>& owners,
                                       const std::vector<Triangle>& triangles);
std::vector<std::uint32_t> edgeIdsOf(const std::vector<std::uint32_t>& owners, const std::vector<Triangle>& triangles);
// Returns the features' nodes, by the ids of faces or edges: per block one row of lanes for each node of a feature.
std::vector<std::uint32_t> faceNodesOf(const std::vector<std::uint32_t>& ids, const std::vector<Triangle>& triangles,
                                       std::uint32_t width);
std::vector<std::uint32_t> edgeNodesOf(const std::vector<std::uint32_t>& ids, const std::vector<Edge>& edges,
                                       std::uint32_t width);

// Makes all patches. width: lanes in a block. positions: m, x y z per joined vertex.
Patches makePatches(const MeshPool& pool, const float* positions, std::uint32_t width);
}  // namespace drape
