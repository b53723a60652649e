// The obstacles' patches and the wide tree over them, on a device (kernels/shared/patch.h).
//
// Input: the obstacles' topology, and their geometry in world coordinates. Output: packed patches. Cost: new obstacles
// are uploaded and packed, moved ones packed again; resting ones cost nothing.
#pragma once

#include "bullet_plugin/core/device/bound_kernel.h"
#include "device_views.h"
#include "kernels/scene/scene_bindings.h"
#include "kernels/shared/patch.h"
#include "patches.h"

namespace drape
{
class PatchPacking
{
public:
    void create(Device& device, const cl::Program& program);

    // Sets new obstacles from that slot on, which must be packed next, even if there are none. Keeps the uploaded data
    // until the next call.
    void setTopology(Device& device, const MeshPool& obstacles, std::size_t firstSlot);
    // Packs the features of those obstacles at new positions. Returns after enqueueing.
    void pack(Device& device, SlotRange slots, const ObstacleBuffers& obstacles);
    // Releases data that only pack() reads; pack() uploads it again.
    void releasePacking();

    PatchBuffers patches() const;
    // The packed features, and the ids of the lanes' triangles, vertices and edges.
    const ArenaArray<float>& faces() const { return m_faces; }
    const ArenaArray<float>& vertices() const { return m_vertices; }
    const ArenaArray<float>& edges() const { return m_edges; }
    const ArenaArray<cl_uint>& faceIds() const { return m_faceIds; }
    const ArenaArray<cl_uint>& vertexIds() const { return m_vertexIds; }
    const ArenaArray<cl_uint>& edgeIds() const { return m_edgeIds; }
    Arena<PatchWord>& arena() { return m_arena; }

private:
    void demandRoom(Device& device, std::size_t patches, const PatchLanes& kept);
    void bringOwners(Device& device, ItemRange vertices, ItemRange edges);
    void packFeatures(Device& device, ItemRange patches, const ObstacleBuffers& obstacles);
    void packVolumes(Device& device, ItemRange patches, const ObstacleBuffers& obstacles);
    PackValues packValues(const ObstacleBuffers& obstacles, ItemRange range, std::size_t count) const;
    PatchLayout layout() const;

    BoundKernel<kernels::patchPackFaces> m_packFaces;
    BoundKernel<kernels::patchPackVertices> m_packVertices;
    BoundKernel<kernels::patchPackEdges> m_packEdges;
    BoundKernel<kernels::patchVolumes> m_packVolumes;
    BoundKernel<kernels::patchWiden> m_widen;
    Patches m_layout;
    bool m_levelsMoved = false;                                        // since the last pack()
    ItemRange m_vertexOwnersHeld = {0, 0}, m_edgeOwnersHeld = {0, 0};  // uploaded owners
    Buffer<cl_uint> m_vertexOwners{"obstacle packing"}, m_edgeOwners{"obstacle packing"};
    Arena<PatchWord> m_arena;
    ArenaArray<Patch> m_patches{m_arena, "obstacle patches"};
    ArenaArray<float> m_sizes{m_arena, "obstacle patches"};
    ArenaArray<float> m_volumes{m_arena, "obstacle patches"};  // only on a CPU
    ArenaArray<float> m_wideNodes{m_arena, "obstacle wide nodes"};
    ArenaArray<cl_uint> m_levels{m_arena, "obstacle wide nodes"};
    ArenaArray<float> m_faces{m_arena, "obstacle faces"};
    ArenaArray<float> m_vertices{m_arena, "obstacle vertices"};
    ArenaArray<float> m_edges{m_arena, "obstacle edges"};
    // A face's owner is the face itself.
    ArenaArray<cl_uint> m_faceIds{m_arena, "obstacle face numbers"};
    ArenaArray<cl_uint> m_vertexIds{m_arena, "obstacle vertex numbers"};
    ArenaArray<cl_uint> m_edgeIds{m_arena, "obstacle edge numbers"};
    ArenaArray<cl_uint> m_faceFeatures{m_arena, "obstacle face features"};  // only on a GPU
};
}  // namespace drape
