// Finds contacts of cloths with themselves on the host by traversing a hierarchy of their triangles, on the calling
// thread. Serves as a check of the product's method (host_self_patches.h), and counts triangle pairs.
#pragma once

#include <cstdint>
#include <vector>

#include "bullet_plugin/core/probe/bvh_layout.h"
#include "kernels/shared/contact.h"
#include "bullet_plugin/core/cloth_cloth/self_step.h"

namespace drape
{
// Updates the volumes of the cloths' nodes over the step; cloths outside it are unchanged.
void selfVolumes(const SelfStep& step, std::vector<Dop>& volumes);

// Finds the contacts of given pairs of triangles, in any order, each once.
class SelfFinder
{
public:
    // volumes: from selfVolumes(). All arguments must outlive this.
    SelfFinder(const SelfStep& step, const std::vector<Dop>& volumes, SelfStepLimits limits = {});

    void visit(const Candidate& pair);
    // Returns whether the candidates are within their limit; nothing is tested beyond it.
    bool withinLimits() const { return m_counts.m_candidates <= m_limits.m_candidates; }
    const SelfCounts& counts() const { return m_counts; }
    // Appends the contacts in canonical order; none if they exceed a limit.
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
    // Appends the contacts in canonical order, unless candidates or contacts exceed the limits. Counting stops soon
    // after the limits.
    SelfCounts run(const SelfStep& step, SelfStepLimits limits, std::vector<Contact>& contacts);

private:
    void update(const SelfStep& step);

    BvhLayout m_layout;
    std::vector<std::uint32_t> m_order;
    std::vector<BvhNode> m_nodes;
    std::vector<Dop> m_volumes;  // the nodes' volumes
    std::uint32_t m_revision = 0;
};
}  // namespace drape
