// Contacts of cloths with themselves in a step on a device (self_step.h).
//
// A list that is too small counts its true demand. Cost: four launches a step, on a GPU five, and one for each upper
// level of the tree; none without a cloth that collides with itself, and its kernels are not built then.
#pragma once

#include <cstdint>
#include <vector>

#include "bullet_plugin/core/device/bound_kernel.h"
#include "bullet_plugin/core/lists/feature_test_list.h"
#include "bullet_plugin/core/lists/unsorted_contacts.h"
#include "bullet_plugin/core/scene/device_views.h"
#include "bullet_plugin/core/scene/patches.h"
#include "kernels/cloth_cloth/cloth_cloth_bindings.h"
#include "kernels/scene/scene_bindings.h"
#include "self_step.h"

namespace drape
{
class SelfContactStage
{
public:
    // Step data that the stage reads.
    struct Input
    {
        ClothBuffers m_cloths;
        BufferView<float> m_obstacleRadius;  // m, reach of the search for obstacles, per cloth slot
        std::uint32_t m_mode;
        float m_reachScale;
        std::size_t m_limit;  // tests; the count is exact up to it
    };

    void create(Device& device, const ProgramLoader& load);
    bool created() const { return m_created; }

    // Sets new cloths. rest: m, x y z per joined node. Waits for the upload.
    void setTopology(Device& device, const MeshPool& cloths, const std::vector<float>& rest);
    // Enqueues changes of the reaches, which must stay unchanged until a wait for the device.
    void setReach(Device& device, const SelfReach& reach);

    // Lists the tests; their counters must be zero before. Both functions return after enqueueing.
    void enqueueCull(Device& device, const Input& input, Buffer<StepCounters>& counters);
    // Lists the contacts of the tests.
    void enqueueContacts(Device& device, const Input& input, UnsortedContacts& contacts,
                         Buffer<StepCounters>& counters);

    FeatureTestList& tests() { return m_tests; }
    // The list of pairs of patches on a GPU. If it was too short, other counts are too low.
    Buffer<Candidate>& pairs() { return m_pairs; }
    void reservePairs(Device& device, std::size_t count) { m_pairs.reserve(device, count); }

private:
    SelfPatchLayout layout() const;
    void enqueuePack(Device& device, const SelfCullValues& values, const Input& input, Buffer<StepCounters>& counters);

    BoundKernel<kernels::selfPack> m_pack;
    BoundKernel<kernels::patchWiden> m_widen;
    BoundKernel<kernels::selfCull> m_cull;  // on a CPU
    BoundKernel<kernels::selfWalk> m_walk;  // on a GPU
    BoundKernel<kernels::selfCullPairs> m_cullPairs;
    BoundKernel<kernels::selfFeature> m_feature;
    BoundKernel<kernels::selfSwept> m_swept;
    Patches m_layout;
    std::uint32_t m_entries = 0;  // positions in the wide tree's lowest level
    bool m_created = false;
    Arena<PatchWord> m_arena;
    ArenaArray<Patch> m_patches{m_arena, "self patches"};
    ArenaArray<cl_uint> m_faceIds{m_arena, "self patches"}, m_vertexIds{m_arena, "self patches"};
    ArenaArray<cl_uint> m_edgeIds{m_arena, "self patches"}, m_levels{m_arena, "self patches"};
    ArenaArray<cl_uint> m_faceNodes{m_arena, "self patches"}, m_edgeNodes{m_arena, "self patches"};  // on a CPU
    // Boxes of features; on a GPU those of nodes alone, by node.
    ArenaArray<float> m_faceBoxes{m_arena, "self boxes"}, m_vertexBoxes{m_arena, "self boxes"};
    ArenaArray<float> m_edgeBoxes{m_arena, "self boxes"}, m_wideNodes{m_arena, "self wide nodes"};
    Buffer<float> m_rest{"cloth positions"}, m_radius{"self patches"}, m_thickness{"self patches"};
    FeatureTestList m_tests{"self candidates"};
    Buffer<Candidate> m_pairs{"self candidates"};
    std::vector<float> m_sentRadius, m_sentThickness;
};
}  // namespace drape
