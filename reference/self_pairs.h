// Contacts of cloths with themselves by a walk over a hierarchy of their triangles, on the calling thread: what tests
// and benchmarks hold a step against.
#pragma once

#include <cstdint>
#include <vector>

#include "bullet_plugin/core/bvh/bvh_layout.h"
#include "kernels/shared/contact.h"
#include "bullet_plugin/core/self_collision/self_step.h"

namespace drape
{
// Volumes of the cloths' nodes over the step; those of cloths that are not in it stay as they are.
void selfVolumes(const SelfStep& step, std::vector<Dop>& volumes);

// Finds the contacts of pairs of triangles that are handed to it, in any order, each once.
class SelfFinder
{
public:
    // volumes: by selfVolumes(). All must outlive it.
    SelfFinder(const SelfStep& step, const std::vector<Dop>& volumes, SelfStepLimits limits = {});

    void visit(const Candidate& pair);
    // Of candidates: beyond them nothing is tested.
    bool withinLimits() const { return m_counts.m_candidates <= m_limits.m_candidates; }
    const SelfCounts& counts() const { return m_counts; }
    // Appends the contacts in canonical order, none where there are more than a limit.
    void append(std::vector<Contact>& contacts);

private:
    void test(const FeatureTest& test);

    const SelfStep& m_step;
    SelfView m_view;
    const std::vector<Dop>& m_volumes;
    SelfStepLimits m_limits;
    std::uint32_t m_firstSlot;
    SelfCounts m_counts;
    std::vector<Contact> m_found;
};

class HostSelfTrees
{
public:
    // Appends the contacts in canonical order, unless there are more candidates or contacts than the limits; it stops
    // counting soon after those.
    SelfCounts run(const SelfStep& step, SelfStepLimits limits, std::vector<Contact>& contacts);

private:
    void update(const SelfStep& step);

    BvhLayout m_layout;
    std::vector<std::uint32_t> m_order;
    std::vector<BvhNode> m_nodes;
    std::vector<Dop> m_volumes;  // of the nodes
    std::uint32_t m_revision = 0;
};
}  // namespace drape
