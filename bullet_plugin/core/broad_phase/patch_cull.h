// Broad phase over patches: lists the feature tests of cloth triangles and obstacle features that may give a contact.
//
// Job: traverse the wide tree over the obstacles' patches with packets of cloth triangles, and drop pairs that are
// certainly apart. A CPU takes a block of features at a time (kernels/broad_phase/patch_cull_simd.cl), a GPU parts of
// several (patch_traversal_gpu.cl and patch_cull_pairs_gpu.cl). Output: feature tests in no particular order, each at
// most once. Guarantee: no test that gives a contact is dropped. Cost: one launch per step, two on a GPU.
#pragma once

#include "bullet_plugin/core/device/bound_kernel.h"
#include "bullet_plugin/core/lists/feature_test_list.h"
#include "bullet_plugin/core/scene/device_views.h"
#include "kernels/broad_phase/broad_phase_bindings.h"

namespace drape
{
class PatchCullStage
{
public:
    void create(Device& device, const ProgramLoader& load);

    struct Settings
    {
        float m_reachScale;
        std::uint32_t m_mode;  // DRAPE_DISCRETE …
        // Limits of tests, and of pairs of triangles and patches. Counts are exact up to them; a greater one only says
        // that there are more.
        std::size_t m_limit, m_pairLimit;
    };
    // Lists the tests. Returns after enqueueing. counters' candidates and invalid nodes must be zero before.
    void enqueue(Device& device, const ClothBuffers& cloths, const PairBuffers& pairs, const PatchBuffers& patches,
                 Settings settings, FeatureTestList& tests, Buffer<StepCounters>& counters);

    // The list of pairs of cloth triangles and patches on a GPU. If it was too short, other counts are too low.
    Buffer<FeatureTest>& pairs() { return m_pairs; }
    void reservePairs(Device& device, std::size_t count) { m_pairs.reserve(device, count); }
    // Releases the memory of the list, except the room of a new stage.
    void giveBackRoom(Device& device);

private:
    void reserveFirstPairs(Device& device);

    BoundKernel<kernels::patchCull> m_cull;  // on a CPU
    BoundKernel<kernels::patchWalk> m_walk;  // on a GPU
    BoundKernel<kernels::patchCullPairs> m_cullPairs;
    Buffer<FeatureTest> m_pairs{"step candidates"};
};
}  // namespace drape
