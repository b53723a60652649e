// A CPU's kernels as C++ functions: the same text that an OpenCL CPU device runs, compiled for several instruction
// sets. The machine's best set is used. Needs no OpenCL.
//
// Threads may run different items of a launch at once; results do not depend on it, except for the order of lists. The
// kernels document their arguments: kernels/scene/patch_pack.cl, patch_cull.cl, narrow_phase_simd.cl and
// narrow_phase.cl; for cloths with themselves self_pack_simd.cl, self_cull.cl, self_contact_simd.cl and
// self_contact.cl. All arguments of one call have DRAPE_PATCH_WIDTH lanes. The same bits with every instruction set.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/lib/pair_contact.h"
#include "kernels/lib/self_contact.h"
#include "kernels/shared/contact.h"
#include "kernels/shared/patch.h"

namespace drape
{
// The cloths of a step and their pairs. thickness: m, cloths × obstacles; radius: m, per cloth.
struct HostCloths
{
    const std::uint32_t* m_order;
    std::uint32_t m_count;  // triangles
    const float* m_radius;
    const float* m_thickness;
    std::uint32_t m_obstacleMeshes;
    float m_reachScale;
    const ObstacleMotion* m_motions;
    std::uint32_t m_motionCount;
};

// The obstacles' patches, packed.
struct PackedPatches
{
    const Patch* m_patches;
    const std::uint32_t* m_levels;
    std::uint32_t m_levelCount;
    const float* m_wideNodes;
    const float* m_sizes;
    const float* m_volumes;
    const float* m_faces;
    const float* m_vertices;
    const float* m_edges;
    const std::uint32_t* m_faceIds;
    const std::uint32_t* m_vertexIds;
    const std::uint32_t* m_edgeIds;
};

// Lists that a step fills; demands count on in the counters.
struct HostTests
{
    FeatureTest* m_tests;
    std::uint32_t m_capacity, m_limit;
};
struct HostHits
{
    Contact* m_hits;
    std::uint32_t m_capacity;
    std::uint32_t* m_slotCount;
};

// Input of the narrow phase. motions: see HostCloths.
struct HostFeatures
{
    const FeatureTest* m_tests;
    std::uint32_t m_count;
    ClothView m_cloth;
    ObstacleView m_obstacle;
    PackedPatches m_patches;
    const ObstacleMotion* m_motions;
};

// Cloths that collide with themselves: their own patches with the features of each, and the memory for the step's
// packed features.
struct SelfPatches
{
    const Patch* m_patches;
    std::uint32_t m_patchCount;
    std::uint32_t m_places;  // positions in the wide tree's first level
    const std::uint32_t* m_faceIds;
    const std::uint32_t* m_vertexIds;
    const std::uint32_t* m_edgeIds;
    const std::uint32_t* m_faceNodes;
    const std::uint32_t* m_edgeNodes;
    const std::uint32_t* m_levels;
    std::uint32_t m_levelCount;
    float* m_faceBoxes;
    float* m_vertexBoxes;
    float* m_edgeBoxes;
    float* m_wideNodes;
};

// m, per cloth: half the reach, negative for cloths outside the step; the thickness; the reach of the search for
// obstacles.
struct SelfRadii
{
    const float* m_radius;
    const float* m_thickness;
    const float* m_obstacleRadius;
};

// Input of the narrow phase of cloths with themselves.
struct HostSelfFeatures
{
    const FeatureTest* m_tests;
    std::uint32_t m_count;
    SelfView m_view;
    std::uint32_t m_firstSlot;
};

// Runs work-item `item` of `items` and lists unsorted contacts. The first such kernel of a step lists the contacts
// that it is sure of. It puts the tests that the continuous test decides into `swept`, which has room for every test.
// The second kernel lists the contacts among these; it has at least as many items as there are kinds of features.
template <class Features>
using HitKernel = void (*)(std::uint32_t item, std::uint32_t items, const Features& features, HostHits hits,
                           std::uint32_t* swept, StepCounters* counters);

// Items of a cull or a packing are patches; a packing also has the positions behind the last.
struct CpuSelfKernels
{
    void (*m_pack)(std::uint32_t item, const ClothView& cloth, const SelfRadii& radii, const SelfPatches& patches,
                   StepCounters* counters);
    void (*m_cull)(std::uint32_t item, const ClothView& cloth, const SelfRadii& radii, const SelfPatches& patches,
                   HostTests tests, StepCounters* counters);
    HitKernel<HostSelfFeatures> m_findHits;
    HitKernel<HostSelfFeatures> m_findSwept;
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
    void (*m_cull)(std::uint32_t packet, const ClothView& cloth, const HostCloths& cloths, const PackedPatches& patches,
                   HostTests tests, StepCounters* counters);
    HitKernel<HostFeatures> m_findHits;
    HitKernel<HostFeatures> m_findSwept;
    const CpuSelfKernels* m_self;
};

// Returns the kernels for this machine. allCpuKernels() returns every set that the machine can run, the best first,
// for tests.
const CpuKernels& cpuKernels();
const CpuKernels* const* allCpuKernels(std::size_t& count);
}  // namespace drape
