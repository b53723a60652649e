// Broad phase over patches on the host. Does PatchCullStage's job with a CPU's kernels (cpu_kernels.h), on the threads
// of a team.
#pragma once

#include <vector>

#include "bullet_plugin/core/cpu/cpu_kernels.h"
#include "bullet_plugin/core/scene/patches.h"
#include "bullet_plugin/core/threads/thread_team.h"

namespace drape
{
class HostPatchCull
{
public:
    explicit HostPatchCull(const CpuKernels& kernels = cpuKernels()) : m_kernels(&kernels) {}

    // Sets new obstacles from that slot on, which must be packed next, even if there are none.
    void setTopology(const MeshPool& obstacles, std::size_t firstSlot);
    // Packs the features of those obstacles at the view's positions.
    void pack(SlotRange slots, const ObstacleView& obstacle);

    // Lists the step's feature tests, and counts them and invalid nodes. limit: of tests; beyond it the list is
    // incomplete, and counters only say that there are more. Returns how often the list was too short and grew.
    std::size_t run(const StepCloths& cloths, std::size_t limit, ThreadTeam& threads, StepCounters& counters);
    // Returns how many feature tests the cloths have, without listing them: exact up to the limit, and one more than
    // the limit where there are more.
    std::uint64_t count(const StepCloths& cloths, std::size_t limit, ThreadTeam& threads);
    // Tests of the last run: the first ones up to its count; the rest is old.
    const std::vector<FeatureTest>& tests() const { return m_tests; }

    // Releases memory that only earlier, larger scenes needed.
    void giveBackRoom();

    PackedPatches packed() const;
    const CpuKernels& kernels() const { return *m_kernels; }

private:
    void packFeatures(ItemRange patches, const ObstacleView& obstacle);
    // Culls every packet once, with room for as many tests as the list has. Returns how many tests there are.
    std::size_t cull(const StepCloths& cloths, TestList list, ThreadTeam& threads, StepCounters& counters) const;

    const CpuKernels* m_kernels;
    Patches m_layout;
    bool m_levelsMoved = false;  // since the last pack()
    std::vector<float> m_faces, m_vertices, m_edges, m_sizes, m_volumes, m_wideNodes;
    std::vector<std::uint32_t> m_vertexIds, m_edgeIds;  // a face's owner is the face itself
    std::vector<FeatureTest> m_tests;
    std::size_t m_testsBefore = 0;  // tests of the last run
};
}  // namespace drape
