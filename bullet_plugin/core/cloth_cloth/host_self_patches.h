// Finds contacts of cloths with themselves on the host, over patches of the cloths' own triangles. Does
// SelfContactStage's job with a CPU's kernels (cpu_kernels.h), on the threads of a team.
#pragma once

#include <vector>

#include "bullet_plugin/core/cpu/cpu_kernels.h"
#include "bullet_plugin/core/scene/patches.h"
#include "bullet_plugin/core/narrow_phase/host_contacts.h"
#include "bullet_plugin/core/threads/thread_team.h"
#include "self_step.h"
#include "smooth_pairs.h"

namespace drape
{
class HostSelfPatches
{
public:
    explicit HostSelfPatches(const CpuKernels& kernels = cpuKernels()) : m_kernels(&kernels) {}

    // Rebuilds all patches, as a step does after cloths were added or removed. rest: m, x y z per joined node.
    void update(const MeshPool& cloths, const float* rest);
    // Prepares steps that leave out smooth pairs, after update(). reach: m, see SmoothPairs::assign().
    void findSmoothPairs(const MeshPool& cloths, const float* rest, float reach, ThreadTeam& threads);
    SmoothPairs& smoothPairs() { return m_smooth; }
    // Lists the pairs of features whose volumes overlap. Call cull(), then findContacts(), each step.
    void cull(const SelfStep& step, std::uint64_t limit, ThreadTeam& threads);
    // Tests the listed pairs, unless they exceeded their limit. Appends the contacts in canonical order, unless they
    // exceed theirs.
    void findContacts(const SelfStep& step, SelfStepLimits limits, ThreadTeam& threads, std::vector<Contact>& contacts);

    // Computes which pairs of patches are smooth in the step, for isSmooth(); cull() does so, too.
    void checkSmooth(const SelfStep& step, ThreadTeam& threads);
    // Looks for pairs of patches that are smooth so far and are not with the step's ends. Returns how many there are.
    // isMoved: see SmoothPairs::recheck().
    std::size_t findLost(const SelfStep& step, const unsigned char* isMoved, ThreadTeam& threads);
    // Lists the pairs of features in pairs of patches that the last findLost() found, and maybe others, as cull() does.
    void cullLost(const SelfStep& step, std::uint64_t limit, ThreadTeam& threads);
    // Returns whether cull() leaves out a pair of features because their patches lie smoothly.
    bool isSmooth(const FeatureTest& pair) const;
    // Copies the pairs of the last cull(), in any order; false, with none copied, if they exceeded the limit.
    bool copyTests(std::uint64_t limit, std::vector<FeatureTest>& tests) const;

    // Returns how many pairs of features each cloth slot has, without listing them: exact up to the limit, and
    // one more than the limit where there are more. After update().
    std::vector<std::uint64_t> countTests(const SelfStep& step, std::uint64_t limit, ThreadTeam& threads);

    // Returns the step's counts.
    SelfCounts counts() const;
    // Releases the memory of the results.
    void giveBackRoom()
    {
        m_tests = std::vector<FeatureTest>();
        m_contacts.giveBackRoom();
    }

private:
    void listOwners(const MeshPool& cloths);
    bool isWorth(const SelfStep& step) const;  // to wake threads
    void pack(const SelfStep& step, ThreadTeam& threads);
    // Culls these patches against all, with room for as many tests as the list has. Returns how many tests there are.
    template <class PatchAt>
    std::size_t cullPatches(const SelfStep& step, std::size_t count, const PatchAt& patchAt, const TestList& list,
                            ThreadTeam& threads);
    template <class PatchAt>
    void fillTests(const SelfStep& step, std::size_t count, const PatchAt& patchAt, std::uint64_t limit,
                   ThreadTeam& threads);

    const CpuKernels* m_kernels;
    std::uint32_t m_revision = 0;
    Patches m_layout;
    std::vector<std::uint32_t> m_vertexIds, m_edgeIds;                         // a face's owner is the face itself
    std::vector<std::uint32_t> m_facePatches, m_vertexPatches, m_edgePatches;  // by feature
    std::vector<std::uint32_t> m_faceNodes, m_edgeNodes;
    std::vector<float> m_faceBoxes, m_vertexBoxes, m_edgeBoxes, m_wideNodes;
    SelfPatches m_patches = {};  // all of that, for kernels
    SmoothPairs m_smooth;
    std::vector<FeatureTest> m_tests;
    HostContactFinder m_contacts;
    StepCounters m_counters = {};
    std::size_t m_retries = 0;
    std::size_t m_testsBefore = 0;  // tests of the last cull
    std::size_t m_smoothPairs = 0;  // left out by the last cull
};
}  // namespace drape
