// Broad phase over patches: lists the feature tests of cloth triangles and obstacle features that may give a contact.
//
// Job: keep the obstacles' patches and the wide tree over them on the device. Each step traverses the tree with packets
// of cloth triangles and drops pairs that are certainly apart: a block of features at a time
// (kernels/broad_phase/patch_cull.cl), on a GPU parts of several (patch_traversal_gpu.cl and patch_cull_pairs.cl).
// Output: feature tests in no particular order, each at most once. Guarantee: no test that gives a contact is dropped.
// Cost: one launch per step, two on a GPU.
#pragma once

#include "bullet_plugin/core/device/buffer.h"
#include "bullet_plugin/core/device/program.h"
#include "bullet_plugin/core/scene/patches.h"
#include "kernels/shared/motion.h"

namespace drape
{
class PatchCullStage
{
public:
    // Returns the lanes in a block on this device.
    static std::uint32_t width(const Device& device);
    // Returns the definitions for building its kernels.
    static std::string defines(const Device& device);

    // The programs that it is made of.
    void create(Device& device, const ProgramLoader& load);

    // Sets new obstacles from that slot on, which must be packed next, even if there are none. Keeps the uploaded data
    // until the next call.
    void setTopology(Device& device, const MeshPool& obstacles, std::size_t firstSlot);
    // Packs the features of those obstacles at new positions. The buffers are the joined obstacles'; returns after
    // enqueueing.
    void pack(Device& device, SlotRange slots, Buffer<Triangle>& triangles, Buffer<float>& positions,
              Buffer<NormalCone>& vertexCones, Buffer<NormalCone>& edgeCones);
    // Releases data that only pack() reads; pack() uploads it again.
    void releasePacking();

    // Data of the cloths and pairs that a step reads.
    struct Cloths
    {
        Buffer<cl_uint>& m_order;
        Buffer<Triangle>& m_triangles;
        Buffer<float>& m_start;
        Buffer<float>& m_end;
        Buffer<float>& m_radius;
        Buffer<float>& m_thickness;
        std::size_t m_count;  // triangles
        std::size_t m_obstacleMeshes;
        float m_reachScale;
        std::uint32_t m_mode;               // DRAPE_DISCRETE …
        Buffer<ObstacleMotion>& m_motions;  // motions of the moving obstacles, in the order of slots
        std::size_t m_motionCount;
        // Limits of tests, and of pairs of triangles and patches. Counts are exact up to them; a greater one only says
        // that there are more.
        std::size_t m_limit, m_pairLimit;
    };
    // Returns after enqueueing. counters' candidates and invalid nodes must be zero before.
    void enqueue(Device& device, Cloths cloths, Buffer<StepCounters>& counters);

    // Returns the list of the last step; reserves room in it.
    Buffer<FeatureTest>& tests() { return m_tests; }
    void reserveTests(Device& device, std::size_t count) { m_tests.reserve(device, count); }
    // The list of pairs of cloth triangles and patches on a GPU. If it was too short, other counts are too low.
    Buffer<FeatureTest>& pairs() { return m_pairs; }
    void reservePairs(Device& device, std::size_t count) { m_pairs.reserve(device, count); }
    // Releases the memory of both lists, except the room of a new stage. Reserve tests again before use.
    void giveBackRoom(Device& device);

    // The packed features; ids name a lane's triangle, vertex or edge.
    struct Features
    {
        Buffer<float>& m_faces;
        Buffer<float>& m_vertices;
        Buffer<float>& m_edges;
        Buffer<cl_uint>& m_faceIds;
        Buffer<cl_uint>& m_vertexIds;
        Buffer<cl_uint>& m_edgeIds;
    };
    Features features() { return {m_faces, m_vertices, m_edges, m_faceOwners, m_vertexIds, m_edgeIds}; }

private:
    void reserveFirstPairs(Device& device);
    void bringOwners(Device& device, ItemRange vertices, ItemRange edges);
    void packFeatures(Device& device, ItemRange patches, Buffer<Triangle>& triangles, Buffer<float>& positions,
                      Buffer<NormalCone>& vertexCones, Buffer<NormalCone>& edgeCones);
    void packVolumes(Device& device, ItemRange patches, Buffer<Triangle>& triangles, Buffer<float>& positions,
                     Buffer<NormalCone>& vertexCones, Buffer<NormalCone>& edgeCones);

    void enqueueWalk(Device& device, Cloths cloths, Buffer<StepCounters>& counters);
    void enqueuePairs(Device& device, Cloths cloths, Buffer<StepCounters>& counters);

    Kernel m_walk, m_cull, m_packFaces, m_packVertices, m_packEdges, m_volumes, m_widen;
    Patches m_layout;
    bool m_levelsMoved = false;                                        // since the last pack()
    ItemRange m_vertexOwnersHeld = {0, 0}, m_edgeOwnersHeld = {0, 0};  // uploaded owners
    Buffer<Patch> m_patches{"obstacle patches"};
    Buffer<cl_uint> m_faceFeatures{"obstacle face features"};  // only on a GPU
    Buffer<cl_uint> m_vertexOwners{"obstacle packing"}, m_edgeOwners{"obstacle packing"};
    // Owners by lane; a face's owner is the face itself.
    Buffer<cl_uint> m_faceOwners{"obstacle face numbers"}, m_vertexIds{"obstacle vertex numbers"};
    Buffer<cl_uint> m_edgeIds{"obstacle edge numbers"};
    Buffer<cl_uint> m_levels{"obstacle wide nodes"};
    Buffer<FeatureTest> m_tests{"step candidates"}, m_pairs{"step candidates"};
    Buffer<float> m_faces{"obstacle faces"}, m_vertices{"obstacle vertices"}, m_edges{"obstacle edges"};
    Buffer<float> m_sizes{"obstacle patches"}, m_patchVolumes{"obstacle patches"}, m_wideNodes{"obstacle wide nodes"};
};
}  // namespace drape
