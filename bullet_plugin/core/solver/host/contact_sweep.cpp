#include "contact_sweep.h"

#include <algorithm>
#include <limits>

namespace drape
{
namespace
{
// Bound, as a share of the coordinates, on the rounding difference between the two computations of a violation.
constexpr float kRounding = 256 * std::numeric_limits<float>::epsilon();

// Minimum contact blocks for sharing a step's sweeps among threads. A sweep over that many takes 15 us. Waking
// threads takes up to 50 us per step on a virtual machine.
constexpr std::size_t kLeastShared = 512;
// Minimum nodes for sharing the passes over nodes. A step makes a dozen such passes, at 3 ns a node.
constexpr std::size_t kLeastNodesShared = 8192;
}  // namespace

void ContactSweep::assign(const SolverCloth& cloth, const ContactSource& source, bool records)
{
    m_cloth.m_records = records;
    m_owner = &cloth;
    m_cloth.m_contacts = cloth.m_contacts;
    m_cloth.m_source = &source;
    m_parts = cloth.m_contacts->m_parts;
}

void ContactSweep::begin()
{
    const std::size_t groups = m_parts->groupCount();
    if (m_groups.size() < groups)
    {
        m_halfDone.reset(new std::atomic<bool>[groups]);
        m_groups.resize(groups);
    }
    for (std::size_t group = 0; group < groups; ++group)
    {
        m_groups[group].clear();
        m_halfDone[group] = false;
    }
    m_worst.assign(groups, 0);
    m_near.assign(groups, 0);
    m_blocks = 0;
    for (const FeatureContacts& feature : contacts().m_features)
    {
        m_groups[feature.m_feature->m_group].add(feature);
        m_blocks += ContactGroup::blocksOf(feature.m_count);
    }
    m_cloth.m_margin = levelMargin(contacts());
    m_cloth.m_retreat = contacts().m_limit.mostCarried(nodes());
}

float levelMargin(float farthest, float mostThickness)
{
    return kRounding * (farthest + mostThickness);
}

float levelMargin(const ClothContacts& contacts)
{
    const SolverNodes& nodes = contacts.m_nodes;
    float farthest = 0;
    for (std::size_t i = 0; i < nodes.count(); ++i)
    {
        const float far = drapeMax(vec3NormMax(nodes.start(i)), vec3NormMax(nodes.end(i)));
        if (far <= DRAPE_FARTHEST) farthest = std::max(farthest, far);  // other nodes have no contacts
    }
    return levelMargin(farthest, contacts.m_mostThickness);
}

// Limits the motion of a leaf's nodes. Only for cloths whose limit needs no other nodes.
void ContactSweep::keepNear(std::size_t leaf)
{
    for (std::size_t i = m_parts->firstNode(leaf); i < m_parts->firstNode(leaf + 1); ++i)
        contacts().m_limit.keepNear(nodes(), std::size_t(m_parts->order()[i]));
}

void ContactSweep::work(std::size_t index, Pass pass)
{
    ContactGroup& group = m_groups[index];
    switch (pass)
    {
        case Pass::MakeBlocks:
            return group.makeBlocks(m_cloth);
        case Pass::Nodes:
            m_worst[index] = group.sweep(m_cloth, ContactGroup::Kinds::Nodes);
            return;
        case Pass::NodesAndFaces:
        case Pass::LimitNodesAndFaces:
            m_worst[index] = group.sweep(m_cloth, ContactGroup::Kinds::NodesAndFaces);
            return;
        case Pass::Edges:
            m_worst[index] = std::max(m_worst[index], group.sweep(m_cloth, ContactGroup::Kinds::Edges));
            if (m_cloth.m_actingSweeps > 0) group.sweepActing(m_cloth);
            return;
        case Pass::LimitSpeeds:
            return group.limitSpeeds(m_cloth, ContactGroup::Kinds::NodesAndFaces);
        case Pass::LimitEdgeSpeeds:
            group.limitSpeeds(m_cloth, ContactGroup::Kinds::Edges);
            m_near[index] = group.mayHavePassed(m_cloth);
            return;
    }
}

void ContactSweep::climb(std::size_t leaf, Pass pass)
{
    if (pass == Pass::LimitNodesAndFaces) keepNear(leaf);
    for (std::size_t group = m_parts->firstLeaf() + leaf;; group /= 2)
    {
        if (!m_groups[group].empty()) work(group, pass);
        // The second half to finish continues, and sees what the first one wrote.
        if (group == 1 || !m_halfDone[group / 2].exchange(true, std::memory_order_acq_rel)) return;
        m_halfDone[group / 2].store(false, std::memory_order_relaxed);
    }
}

bool ContactSweep::hasPushed() const
{
    const auto pushed = [](const ContactGroup& group) { return group.hasPushed(); };
    return std::any_of(m_groups.begin(), m_groups.begin() + std::ptrdiff_t(m_parts->groupCount()), pushed);
}

float ContactSweep::worst() const
{
    return *std::max_element(m_worst.begin(), m_worst.end());
}

bool ContactSweep::mayHavePassed() const
{
    return std::find(m_near.begin(), m_near.end(), 1) != m_near.end();
}

void SweepTeam::pass(const Cloths& cloths, ContactSweep::Pass pass)
{
    m_leaves.clear();
    std::size_t blocks = 0;
    for (ContactSweep* cloth : cloths)
    {
        blocks += cloth->m_blocks;
        for (std::size_t leaf = 0; leaf < cloth->m_parts->leafCount(); ++leaf)
            m_leaves.push_back(Leaf{cloth, leaf});
    }
    const auto climb = [&](std::size_t i) { m_leaves[i].m_cloth->climb(m_leaves[i].m_leaf, pass); };
    if (blocks >= kLeastShared) return m_threads.run(m_leaves.size(), climb);
    for (std::size_t i = 0; i < m_leaves.size(); ++i)
        climb(i);
}

bool SweepTeam::areLarge(const Cloths& cloths)
{
    std::size_t nodes = 0;
    for (const ContactSweep* cloth : cloths)
        nodes += cloth->m_parts->nodeCount();
    return nodes >= kLeastNodesShared;
}

void SweepTeam::start(const Cloths& cloths)
{
    pass(cloths, ContactSweep::Pass::MakeBlocks);
}

void SweepTeam::run(const Cloths& cloths)
{
    pass(cloths, ContactSweep::Pass::NodesAndFaces);
    pass(cloths, ContactSweep::Pass::Edges);
}

void SweepTeam::limitAndRun(const Cloths& cloths)
{
    pass(cloths, ContactSweep::Pass::LimitNodesAndFaces);
    pass(cloths, ContactSweep::Pass::Edges);
}

void SweepTeam::runNodes(const Cloths& cloths)
{
    pass(cloths, ContactSweep::Pass::Nodes);
}

void SweepTeam::limitSpeeds(const Cloths& cloths)
{
    pass(cloths, ContactSweep::Pass::LimitSpeeds);
    pass(cloths, ContactSweep::Pass::LimitEdgeSpeeds);
}
}  // namespace drape
