#include "bullet_plugin/adapter/contact_rounds.h"

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

float largestCoordinate(const btVector3& v)
{
    return static_cast<float>(std::max(btFabs(v.x()), std::max(btFabs(v.y()), btFabs(v.z()))));
}
}  // namespace

void ContactRounds::assign(BodyContacts& contacts, const FoundContacts& found)
{
    m_contacts = &contacts;
    m_parts = contacts.m_parts;
    m_nodes.m_contacts = &contacts;
    m_nodes.m_found = &found;
    m_nodes.m_body = contacts.m_body;
}

void ContactRounds::begin()
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
    m_settles.assign(groups, 0);
    m_near.assign(groups, 0);
    m_nodes.m_movedOfNode.assign(m_parts->nodeCount(), -1);
    m_blocks = 0;
    for (const FeatureContacts& feature : m_contacts->m_features)
    {
        m_groups[m_parts->groupOf(feature.m_nodes)].add(feature);
        m_blocks += (feature.m_count + kLanes - 1) / kLanes;
        for (int k = 0; k < 3 && feature.m_nodes[k] >= 0; ++k)
            m_nodes.m_movedOfNode[static_cast<std::size_t>(feature.m_nodes[k])] = 0;
    }
    numberMoved();
}

// Numbers the moved nodes leaf by leaf, so that threads on different leaves seldom write to the same cache line.
void ContactRounds::numberMoved()
{
    const NodePaths& paths = m_contacts->m_limit.paths();
    float farthest = 0;
    m_nodes.m_moved.clear();
    m_firstMoved.assign(1, 0);
    for (std::size_t leaf = 0; leaf < m_parts->leafCount(); ++leaf)
    {
        for (std::size_t i = m_parts->firstNode(leaf); i < m_parts->firstNode(leaf + 1); ++i)
        {
            const int node = m_parts->order()[i];
            const std::size_t at = static_cast<std::size_t>(node);
            if (m_nodes.m_movedOfNode[at] < 0) continue;
            m_nodes.m_movedOfNode[at] = static_cast<int>(m_nodes.m_moved.size());
            m_nodes.m_moved.push_back(RoundsNodes::Moved{paths.m_inverseMass[at], node});
            farthest =
                std::max(farthest, std::max(largestCoordinate(paths.m_start[at]), largestCoordinate(paths.m_end[at])));
        }
        m_firstMoved.push_back(m_nodes.m_moved.size());
    }
    m_nodes.m_places.resize(m_nodes.m_moved.size());
    m_nodes.m_shifted.assign(m_nodes.m_moved.size(), 0);
    m_nodes.m_margin = kRounding * (farthest + static_cast<float>(m_contacts->m_mostThickness));
}

// Reads the nodes' positions. One thread handles a body: Bullet has written its nodes and reads them next.
void ContactRounds::gather()
{
    for (std::size_t i = 0; i < m_nodes.m_moved.size(); ++i)
        m_nodes.m_places[i] = m_nodes.m_body->m_nodes[m_nodes.m_moved[i].m_node].m_x;
}

void ContactRounds::scatter()
{
    const btSoftBody& body = *m_nodes.m_body;
    const btScalar velocityScale = body.m_sst.isdt * (1 - body.m_cfg.kDP);
    for (std::size_t i = 0; i < m_nodes.m_moved.size(); ++i)
    {
        if (!m_nodes.m_shifted[i]) continue;
        m_nodes.m_shifted[i] = 0;
        btSoftBody::Node& node = m_nodes.m_body->m_nodes[m_nodes.m_moved[i].m_node];
        node.m_v += (m_nodes.m_places[i] - node.m_x) * velocityScale;
        node.m_x = m_nodes.m_places[i];
    }
}

// Limits the motion of a leaf's nodes. Only for bodies whose limit needs no other nodes.
void ContactRounds::keepNear(std::size_t leaf)
{
    for (std::size_t i = m_firstMoved[leaf]; i < m_firstMoved[leaf + 1]; ++i)
    {
        const std::size_t node = static_cast<std::size_t>(m_nodes.m_moved[i].m_node);
        if (m_contacts->m_limit.keepNear(node, m_nodes.m_places[i])) m_nodes.m_shifted[i] = 1;
    }
}

void ContactRounds::work(std::size_t index, Pass pass)
{
    ContactGroup& group = m_groups[index];
    switch (pass)
    {
        case Pass::MakeBlocks:
            return group.makeBlocks(m_nodes);
        case Pass::Nodes:
            m_worst[index] = group.look(m_nodes, m_stage, ContactGroup::Kinds::Nodes);
            return;
        case Pass::NodesAndFaces:
        case Pass::LimitNodesAndFaces:
            m_worst[index] = group.look(m_nodes, m_stage, ContactGroup::Kinds::NodesAndFaces);
            return;
        case Pass::Edges:
        case Pass::EdgesAndList:
            m_worst[index] = std::max(m_worst[index], group.look(m_nodes, m_stage, ContactGroup::Kinds::Edges));
            m_settles[index] = pass == Pass::EdgesAndList && group.listSettling();
            return;
        case Pass::Settle:
            return group.settle(m_nodes);
        case Pass::LimitSpeeds:
            group.limitSpeeds(m_nodes);
            m_near[index] = group.mayHavePassed(m_nodes);
            return;
    }
}

void ContactRounds::climb(std::size_t leaf, Pass pass)
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

btScalar ContactRounds::worst() const
{
    return *std::max_element(m_worst.begin(), m_worst.end());
}

bool ContactRounds::mayHavePassed() const
{
    return std::find(m_near.begin(), m_near.end(), 1) != m_near.end();
}

bool ContactRounds::anySettles() const
{
    return std::find(m_settles.begin(), m_settles.end(), 1) != m_settles.end();
}

void RoundsTeam::pass(const Bodies& bodies, ContactRounds::Pass pass)
{
    m_leaves.clear();
    std::size_t blocks = 0;
    for (ContactRounds* body : bodies)
    {
        blocks += body->m_blocks;
        for (std::size_t leaf = 0; leaf < body->m_parts->leafCount(); ++leaf)
            m_leaves.push_back(Leaf{body, leaf});
    }
    const auto climb = [&](std::size_t i) { m_leaves[i].m_body->climb(m_leaves[i].m_leaf, pass); };
    if (blocks >= kLeastShared) return m_threads.run(m_leaves.size(), climb);
    for (std::size_t i = 0; i < m_leaves.size(); ++i)
        climb(i);
}

bool RoundsTeam::areLarge(const Bodies& bodies)
{
    std::size_t nodes = 0;
    for (const ContactRounds* body : bodies)
        nodes += body->m_parts->nodeCount();
    return nodes >= kLeastNodesShared;
}

void RoundsTeam::gather(const Bodies& bodies)
{
    forBodies(bodies, [](ContactRounds& body) { body.gather(); });
}

void RoundsTeam::scatter(const Bodies& bodies)
{
    forBodies(bodies, [](ContactRounds& body) { body.scatter(); });
}

void RoundsTeam::start(const Bodies& bodies)
{
    pass(bodies, ContactRounds::Pass::MakeBlocks);
}

void RoundsTeam::run(const Bodies& bodies)
{
    pass(bodies, ContactRounds::Pass::NodesAndFaces);
    pass(bodies, ContactRounds::Pass::Edges);
}

void RoundsTeam::limitAndRun(const Bodies& bodies)
{
    pass(bodies, ContactRounds::Pass::LimitNodesAndFaces);
    pass(bodies, ContactRounds::Pass::Edges);
}

void RoundsTeam::runNodes(const Bodies& bodies)
{
    pass(bodies, ContactRounds::Pass::Nodes);
}

void RoundsTeam::runAndSettle(const Bodies& bodies)
{
    pass(bodies, ContactRounds::Pass::NodesAndFaces);
    pass(bodies, ContactRounds::Pass::EdgesAndList);
    m_settling.clear();
    for (ContactRounds* body : bodies)
        if (body->anySettles()) m_settling.push_back(body);
    for (int i = 0; i < kSettlingPasses; ++i)
        pass(m_settling, ContactRounds::Pass::Settle);
}

void RoundsTeam::limitSpeeds(const Bodies& bodies)
{
    pass(bodies, ContactRounds::Pass::LimitSpeeds);
}
}  // namespace drape
