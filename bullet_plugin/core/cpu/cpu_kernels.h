// A CPU's kernels as C++ functions: the same text that an OpenCL CPU device runs, compiled for several instruction
// sets. The machine's best set is used. Needs no OpenCL.
//
// Threads may run different items of a launch at once; results do not depend on it, except for the order of lists. The
// kernels document their arguments: kernels/scene/patch_pack.cl, patch_cull_simd.cl, narrow_phase_simd.cl and
// narrow_phase.cl; for cloths with themselves self_pack_simd.cl, self_cull_simd.cl, self_contact_simd.cl and
// self_contact.cl. All arguments of one call have DRAPE_PATCH_WIDTH lanes. The same bits with every instruction set.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/lib/narrow_phase/pair_contact.h"
#include "kernels/lib/cloth_cloth/self_views.h"
#include "kernels/lib/step_data/step_views.h"
#include "kernels/shared/contact.h"
#include "kernels/shared/patch.h"

namespace drape
{
// Runs work-item `item` of `items` and lists unsorted contacts. The first such kernel of a step lists the contacts
// that it is sure of. It puts the tests that the continuous test decides into `swept`, which has room for every test.
// The second kernel lists the contacts among these; it has at least as many items as there are kinds of features.
template <class Input>
using FeatureKernel = void (*)(std::uint32_t item, std::uint32_t items, const Input& input, const ContactSink& sink,
                               std::uint32_t* swept, StepCounters* counters);

// Items of a cull or a packing are patches; a packing also has the positions behind the last.
struct CpuSelfKernels
{
    void (*m_pack)(std::uint32_t item, const ClothView& cloth, const SelfRadii& radii, const SelfPatches& patches,
                   StepCounters* counters);
    void (*m_cull)(std::uint32_t item, const ClothView& cloth, const SelfRadii& radii, const SelfPatches& patches,
                   const TestList& tests);
    FeatureKernel<SelfInput> m_findContacts;
    FeatureKernel<SelfInput> m_findSwept;
};

// first, last: the lanes to pack, or the wide tree's positions; one call takes all of them.
struct CpuKernels
{
    const char* m_instructions;

    void (*m_packFaces)(const std::uint32_t* owners, std::uint32_t first, std::uint32_t last,
                        const ObstacleView& obstacle, float* faces);
    void (*m_packVertices)(const std::uint32_t* owners, std::uint32_t first, std::uint32_t last,
                           const ObstacleView& obstacle, float* vertices, std::uint32_t* ids);
    void (*m_packEdges)(const std::uint32_t* owners, std::uint32_t first, std::uint32_t last,
                        const ObstacleView& obstacle, float* edges, std::uint32_t* ids);
    void (*m_packVolumes)(const std::uint32_t* faceOwners, std::uint32_t patchCount, std::uint32_t first,
                          std::uint32_t last, const ObstacleView& obstacle, float* wideNodes, float* sizes,
                          float* volumes);
    void (*m_widen)(float* wideNodes, std::uint32_t below, std::uint32_t nodeCount, std::uint32_t level,
                    std::uint32_t first, std::uint32_t last);
    // Lists the feature tests of a packet, DRAPE_PATCH_WIDTH cloth triangles. Does not read the cloth's edges.
    void (*m_cull)(std::uint32_t packet, const StepCloths& cloths, const PackedPatches& patches, const TestList& tests,
                   StepCounters* counters);
    FeatureKernel<FeatureInput> m_findContacts;
    FeatureKernel<FeatureInput> m_findSwept;
    const CpuSelfKernels* m_self;
};

// Returns the kernels for this machine. allCpuKernels() returns every set that the machine can run, the best first,
// for tests.
const CpuKernels& cpuKernels();
const CpuKernels* const* allCpuKernels(std::size_t& count);
}  // namespace drape
