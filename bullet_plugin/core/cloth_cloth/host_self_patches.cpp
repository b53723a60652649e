#include "host_self_patches.h"

#include <algorithm>

namespace drape
{
namespace
{
constexpr std::uint32_t kWidth = DRAPE_PATCH_WIDTH;
constexpr std::size_t kFirstTests = 1 << 12;
// Minimum triangles of the cloths, or tests of the step before, for waking threads: they take a tenth of a millisecond.
constexpr std::size_t kLeastTriangles = 1 << 8;
constexpr std::size_t kLeastTests = 1 << 9;

SelfRadii radiiOf(const SelfStep& step)
{
    return {step.m_reach.m_radius.data(), step.m_reach.m_thickness.data(), step.m_obstacleRadius.data()};
}
}  // namespace

void HostSelfPatches::update(const MeshPool& cloths, const float* rest)
{
    if (m_revision == cloths.revision()) return;
    m_revision = cloths.revision();
    m_layout = makePatches(cloths, rest, kWidth);
    m_patches = {};
    if (m_layout.m_patches.empty()) return;
    m_vertexIds = vertexIdsOf(m_layout.m_vertexOwners, cloths.triangles());
    m_edgeIds = edgeIdsOf(m_layout.m_edgeOwners, cloths.triangles());
    listOwners(cloths);
    m_faceNodes = faceNodesOf(m_layout.m_faceOwners, cloths.triangles(), kWidth);
    m_edgeNodes = edgeNodesOf(m_edgeIds, cloths.edges(), kWidth);
    m_faceBoxes.resize(m_layout.m_faceOwners.size() * DRAPE_BOX_FLOATS);
    m_vertexBoxes.resize(m_vertexIds.size() * DRAPE_BOX_FLOATS);
    m_edgeBoxes.resize(m_edgeIds.size() * DRAPE_BOX_FLOATS);
    m_wideNodes.resize(std::size_t(m_layout.m_levels.back()) * DRAPE_WIDE_NODE_FLOATS * kWidth);
    m_patches = {m_layout.m_patches.data(),
                 std::uint32_t(m_layout.m_patches.size()),
                 m_layout.m_levels[1] * kWidth,
                 m_layout.m_faceOwners.data(),
                 m_vertexIds.data(),
                 m_edgeIds.data(),
                 m_faceNodes.data(),
                 m_edgeNodes.data(),
                 m_layout.m_levels.data(),
                 std::uint32_t(m_layout.m_levels.size() - 1),
                 m_faceBoxes.data(),
                 m_vertexBoxes.data(),
                 m_edgeBoxes.data(),
                 m_wideNodes.data(),
                 {}};
}

// Lists the patch that owns each feature.
void HostSelfPatches::listOwners(const MeshPool& cloths)
{
    m_facePatches.assign(cloths.triangles().size(), 0);
    m_vertexPatches.assign(cloths.vertexCount(), 0);
    m_edgePatches.assign(cloths.edges().size(), 0);
    for (std::uint32_t patch = 0; patch < m_layout.m_patches.size(); ++patch)
    {
        const auto own = [&](const std::vector<std::uint32_t>& ids, std::uint32_t block, std::uint32_t blocks,
                             std::vector<std::uint32_t>& owners)
        {
            for (std::uint32_t lane = block * kWidth; lane < (block + blocks) * kWidth; ++lane)
                if (ids[lane] != DRAPE_NO_FEATURE) owners[ids[lane]] = patch;
        };
        const Patch& of = m_layout.m_patches[patch];
        own(m_layout.m_faceOwners, patch, 1, m_facePatches);
        own(m_vertexIds, of.m_vertexBlock, of.m_vertexBlocks, m_vertexPatches);
        own(m_edgeIds, of.m_edgeBlock, of.m_edgeBlocks, m_edgePatches);
    }
}

void HostSelfPatches::findSmoothPairs(const MeshPool& cloths, const float* rest, float reach, ThreadTeam& threads)
{
    m_smooth.assign(cloths, m_layout, rest, reach, threads);
}

bool HostSelfPatches::isWorth(const SelfStep& step) const
{
    return m_testsBefore >= kLeastTests || step.m_view.m_cloth.m_triangleCount >= kLeastTriangles;
}

// Computes the volumes of the patches, the tree's lowest level, and of the nodes above.
void HostSelfPatches::pack(const SelfStep& step, ThreadTeam& threads)
{
    const SelfRadii radii = radiiOf(step);
    runShared(threads, isWorth(step), m_patches.m_entries,
              [&](std::size_t entry)
              { m_kernels->m_self->m_pack(std::uint32_t(entry), step.m_view.m_cloth, radii, m_patches, &m_counters); });
    const std::vector<std::uint32_t>& levels = m_layout.m_levels;
    for (std::size_t level = 1; level + 1 < levels.size(); ++level)
        m_kernels->m_widen(m_wideNodes.data(), levels[level - 1], levels[level] - levels[level - 1], levels[level], 0,
                           (levels[level + 1] - levels[level]) * kWidth);
}

template <class PatchAt>
std::size_t HostSelfPatches::cullPatches(const SelfStep& step, std::size_t count, const PatchAt& patchAt,
                                         const TestList& list, ThreadTeam& threads)
{
    const SelfRadii radii = radiiOf(step);
    m_counters.m_selfTests = 0;
    runShared(threads, isWorth(step), count,
              [&](std::size_t i)
              { m_kernels->m_self->m_cull(patchAt(i), step.m_view.m_cloth, radii, m_patches, list); });
    return m_counters.m_selfTests;
}

// Lists the pairs of features of some patches with all.
template <class PatchAt>
void HostSelfPatches::fillTests(const SelfStep& step, std::size_t count, const PatchAt& patchAt, std::uint64_t limit,
                                ThreadTeam& threads)
{
    if (m_tests.empty()) m_tests.resize(kFirstTests);
    const auto fill = [&]
    {
        const TestList list = {m_tests.data(), std::uint32_t(m_tests.size()), std::uint32_t(limit),
                               &m_counters.m_selfTests};
        return m_testsBefore = cullPatches(step, count, patchAt, list, threads);
    };
    m_retries = fillGrowing(m_tests, limit, fill);
}

void HostSelfPatches::cull(const SelfStep& step, std::uint64_t limit, ThreadTeam& threads)
{
    m_counters = {};
    m_retries = m_smoothPairs = 0;
    if (m_patches.m_patchCount == 0) return;
    checkSmooth(step, threads);
    pack(step, threads);
    fillTests(
        step, m_patches.m_patchCount, [](std::size_t patch) { return std::uint32_t(patch); }, limit, threads);
}

void HostSelfPatches::cullLost(const SelfStep& step, std::uint64_t limit, ThreadTeam& threads)
{
    m_counters = {};
    m_retries = 0;
    pack(step, threads);
    m_patches.m_smooth = m_smooth.viewOfLost();
    const std::vector<std::uint32_t> patches = m_smooth.patchesOfLost();
    fillTests(
        step, patches.size(), [&](std::size_t i) { return patches[i]; }, limit, threads);
    m_patches.m_smooth = m_smooth.view();
}

std::size_t HostSelfPatches::findLost(const SelfStep& step, const unsigned char* isMoved, ThreadTeam& threads)
{
    if (!(step.m_smoothShare > 0)) return 0;
    return m_smooth.recheck(step.start(), step.m_view.m_cloth.m_end, step.m_smoothShare, isMoved, threads);
}

void HostSelfPatches::checkSmooth(const SelfStep& step, ThreadTeam& threads)
{
    m_smoothPairs = 0;
    m_patches.m_smooth = {};
    if (!(step.m_smoothShare > 0)) return;
    m_smoothPairs = m_smooth.check(step.start(), step.m_view.m_cloth.m_end, step.m_smoothShare, threads);
    m_patches.m_smooth = m_smooth.view();
}

bool HostSelfPatches::isSmooth(const FeatureTest& pair) const
{
    const bool ofNode = pair.m_motion == DRAPE_SELF_TEST_NODE;
    const std::uint32_t first = (ofNode ? m_vertexPatches : m_edgePatches)[pair.m_cloth];
    const std::uint32_t second = (ofNode ? m_facePatches : m_edgePatches)[pair.m_lane];
    return liesSmoothly(&m_patches.m_smooth, std::min(first, second), std::max(first, second)) != 0;
}

bool HostSelfPatches::copyTests(std::uint64_t limit, std::vector<FeatureTest>& tests) const
{
    tests.clear();
    if (m_counters.m_selfTests > limit) return false;
    tests.assign(m_tests.begin(), m_tests.begin() + std::ptrdiff_t(m_counters.m_selfTests));
    return true;
}

std::vector<std::uint64_t> HostSelfPatches::countTests(const SelfStep& step, std::uint64_t limit, ThreadTeam& threads)
{
    std::vector<std::uint64_t> counts(step.m_cloths.meshCount(), 0);
    m_counters = {};
    if (m_patches.m_patchCount == 0) return counts;
    pack(step, threads);
    const TestList nowhere = {m_tests.data(), 0, std::uint32_t(limit), &m_counters.m_selfTests};
    for (std::size_t slot = 0; slot < counts.size(); ++slot)
    {
        if (!(step.m_reach.m_radius[slot] >= 0.0f)) continue;
        const ItemRange patches = patchesOf(m_layout, {slot, slot + 1});
        const auto patchAt = [&](std::size_t i) { return patches.first() + std::uint32_t(i); };
        counts[slot] =
            std::min<std::uint64_t>(cullPatches(step, patches.count(), patchAt, nowhere, threads), limit + 1);
    }
    return counts;
}

void HostSelfPatches::findContacts(const SelfStep& step, SelfStepLimits limits, ThreadTeam& threads,
                                   std::vector<Contact>& contacts)
{
    if (m_counters.m_selfTests > limits.m_candidates) return;
    const ClothView& cloth = step.m_view.m_cloth;
    const std::uint32_t firstFeature =
        featureCountOf(cloth.m_nodeCount, cloth.m_triangleCount, std::uint32_t(step.m_cloths.edges().size()));
    const SelfInput input = {m_tests.data(), m_counters.m_selfTests, step.m_view, firstFeature};
    const CpuSelfKernels& kernels = *m_kernels->m_self;
    m_retries += m_contacts.find(kernels.m_findContacts, kernels.m_findSwept, &StepCounters::m_selfSwept, input,
                                 2 * std::size_t(firstFeature), {limits.m_contacts, SIZE_MAX}, threads, m_counters);
    if (m_counters.m_contactsFound <= limits.m_contacts)
        m_contacts.order(m_counters.m_contactsFound, contacts, threads);
}

SelfCounts HostSelfPatches::counts() const
{
    return {m_counters.m_selfTests,
            m_counters.m_contactsFound,
            m_counters.m_selfSwept,
            m_counters.m_invalidNodes,
            m_retries,
            m_smoothPairs};
}
}  // namespace drape
