#include "bullet_plugin/adapter/substep_body.h"

#include <algorithm>
#include <cmath>

#include "bullet_plugin/adapter/cloth_parts.h"
#include "bullet_plugin/core/solver/link_strength.h"

namespace drape
{
namespace
{
// Minimum nodes for sharing a pass over them, and the nodes of a range: a pass takes 3 ns a node.
constexpr std::size_t kLeastShared = 8192, kRange = 2048;

// Calls work(first, last) for ranges of nodes.
template <class Work>
void forRanges(std::size_t count, ThreadTeam* threads, const Work& work)
{
    if (!threads || count < kLeastShared) return work(std::size_t(0), count);
    threads->run((count + kRange - 1) / kRange,
                 [&](std::size_t i) { work(i * kRange, std::min(count, (i + 1) * kRange)); });
}

std::size_t nodeCount(const btSoftBody& body)
{
    return static_cast<std::size_t>(body.m_nodes.size());
}

// Returns how far the end of a free path in substeps lies from Bullet's prediction, per unit of acceleration, s².
btScalar shiftOf(const btSoftBody& body)
{
    const btScalar share = btScalar(SolverNodes::pathShare(SubstepBody::substepsOf(body)));
    return (share - 1) * body.m_sst.sdt * body.m_sst.sdt;
}

// Converts to the core's float32.
void toFloat(const btVector3& vector, float out[3])
{
    for (int axis = 0; axis < 3; ++axis)
        out[axis] = static_cast<float>(vector[axis]);
}
// Returns the way from the node's start to its current position.
btVector3 wayOf(const btSoftBody::Node& node, const SubstepBody::Prediction& prediction)
{
    return node.m_x == prediction.m_end ? prediction.m_way : node.m_x - node.m_q;
}
}  // namespace

const char* SubstepBody::reasonForBullet(const btSoftBody& body)
{
    const btSoftBody::Config& config = body.m_cfg;
    if (sizeof(btScalar) != sizeof(float)) return "Bullet computes in double precision";
    if (body.m_reducedModel) return "the soft body is a reduced deformable model";
    if (body.m_clusters.size() > 0 || body.m_joints.size() > 0) return "the soft body has clusters or joints";
    if (body.m_anchors.size() > 0) return "the soft body has anchors";
    if (body.m_pose.m_bframe && config.kMT > 0) return "the soft body matches a pose (kMT)";
    if (config.viterations > 0) return "the soft body has velocity iterations (viterations)";
    if (config.diterations > 0) return "the soft body has drift iterations (diterations)";
    if (config.piterations < 1) return "the soft body has no position iterations (piterations)";
    const btSoftBody::tPSolverArray& sequence = config.m_psequence;
    if (sequence.findLinearSearch(btSoftBody::ePSolver::Linear) == sequence.size())
        return "the soft body's solver sequence has no links (m_psequence)";
    return nullptr;
}

const char* SubstepBody::reasonForBulletNow(const btSoftBody& body)
{
    if (const char* reason = reasonForBullet(body)) return reason;
    if (body.m_rcontacts.size() > 0 || body.m_scontacts.size() > 0)
        return "the soft body touches an object whose contacts Bullet's own algorithm found";
    return nullptr;
}

int SubstepBody::substepsOf(const btSoftBody& body)
{
    return std::max(kLeastSubsteps, body.m_cfg.piterations);
}

void SubstepBody::beforePrediction(const btSoftBody& body)
{
    m_isPredicted = false;
    m_velocities.clear();
    if (!body.isActive()) return;
    m_velocities.resize(nodeCount(body));
    for (std::size_t i = 0; i < m_velocities.size(); ++i)
        m_velocities[i] = body.m_nodes[static_cast<int>(i)].m_v;
}

void SubstepBody::afterPrediction(btSoftBody& body)
{
    m_isPredicted = body.m_sst.sdt > 0 && m_velocities.size() == nodeCount(body);
    if (!m_isPredicted) return;
    const btScalar shift = shiftOf(body), perSecond = body.m_sst.isdt;
    m_accelerations.resize(m_velocities.size());
    m_predictions.resize(m_velocities.size());
    for (std::size_t i = 0; i < m_accelerations.size(); ++i)
    {
        btSoftBody::Node& node = body.m_nodes[static_cast<int>(i)];
        m_accelerations[i] = (node.m_v - m_velocities[i]) * perSecond;
        node.m_x += m_accelerations[i] * shift;
        m_predictions[i] = {node.m_x, node.m_v * body.m_sst.sdt + m_accelerations[i] * shift};
    }
}

bool SubstepBody::fits(const btSoftBody& body) const
{
    return m_accelerations.size() == nodeCount(body);
}

void SubstepBody::leave(btSoftBody& body)
{
    m_isPredicted = false;
    const btScalar shift = shiftOf(body);
    for (std::size_t i = 0; fits(body) && i < m_accelerations.size(); ++i)
        body.m_nodes[static_cast<int>(i)].m_x -= m_accelerations[i] * shift;
}

// Sorts the links for sweeps: the cloth is cut where its nodes are now.
void SubstepBody::buildLinks(const btSoftBody& body)
{
    std::vector<btVector3> positions(nodeCount(body));
    for (std::size_t i = 0; i < positions.size(); ++i)
        positions[i] = body.m_nodes[static_cast<int>(i)].m_q;
    ClothParts parts;
    parts.cut(std::move(positions));
    for (LinkNodes& link : m_links)
    {
        const int nodes[3] = {static_cast<int>(link.m_nodes[0]), static_cast<int>(link.m_nodes[1]), -1};
        link.m_group = static_cast<std::uint32_t>(parts.groupOf(nodes));
    }
    m_sweep.build(nodeCount(body), parts.leafCount(), m_links);
}

// Reads which nodes the links join; sorts them again if that changed.
void SubstepBody::readTopology(const btSoftBody& body)
{
    const std::size_t count = static_cast<std::size_t>(body.m_links.size());
    bool isNew = m_links.size() != count || m_nodes.count() != nodeCount(body);
    m_links.resize(count);
    const btSoftBody::Node* const first = count > 0 ? &body.m_nodes[0] : nullptr;
    for (std::size_t i = 0; i < count; ++i)
    {
        const btSoftBody::Link& link = body.m_links[static_cast<int>(i)];
        for (int k = 0; k < 2; ++k)
        {
            const std::uint32_t node = static_cast<std::uint32_t>(link.m_n[k] - first);
            isNew = isNew || m_links[i].m_nodes[k] != node;
            m_links[i].m_nodes[k] = node;
        }
    }
    m_nodes.resize(nodeCount(body));
    if (isNew) buildLinks(body);
}

// Reads lengths and strengths of the links, whose nodes have their starts.
void SubstepBody::readLinks(const btSoftBody& body)
{
    // Neighbouring links mostly have one material.
    btScalar stiffness = -1;
    double factor = 0;
    for (std::size_t i = 0; i < m_links.size(); ++i)
    {
        const btSoftBody::Link& link = body.m_links[static_cast<int>(i)];
        if (link.m_material->m_kLST != stiffness)
        {
            stiffness = link.m_material->m_kLST;
            factor = stiffness > 0 ? visitShare(stiffness, body.m_cfg.piterations, substepsOf(body), kLinkSweeps) /
                                         double(stiffness)
                                   : 0;
        }
        // Bullet's m_c0 is the sum of the inverse masses divided by the stiffness.
        const bool acts = link.m_c0 > 0;
        float apart[3];
        toFloat(link.m_n[1]->m_q - link.m_n[0]->m_q, apart);
        m_sweep.set(i, apart, static_cast<float>(link.m_c1),
                    acts ? static_cast<float>(factor / double(link.m_c0)) : 0.0f);
    }
}

void SubstepBody::begin(btSoftBody& body, ThreadTeam* threads)
{
    readTopology(body);
    readLinks(body);
    m_nodes.begin(static_cast<float>(body.m_sst.sdt), substepsOf(body));
    const double damping = std::min(1.0, std::max(0.0, double(body.m_cfg.kDP)));
    m_kept = static_cast<float>(std::pow(1 - damping, 1.0 / substepsOf(body)));
    forRanges(m_nodes.count(), threads,
              [&](std::size_t from, std::size_t to)
              {
                  for (std::size_t i = from; i < to; ++i)
                  {
                      btSoftBody::Node& node = body.m_nodes[static_cast<int>(i)];
                      float start[3], way[3], acceleration[3];
                      toFloat(node.m_q, start);
                      toFloat(wayOf(node, m_predictions[i]), way);
                      toFloat(m_accelerations[i], acceleration);
                      m_nodes.setPath(i, start, way, acceleration, static_cast<float>(node.m_im));
                  }
              });
}

void SubstepBody::writeNodes(btSoftBody& body, ThreadTeam* threads) const
{
    forRanges(m_nodes.count(), threads,
              [&](std::size_t from, std::size_t to)
              {
                  for (std::size_t i = from; i < to; ++i)
                  {
                      btSoftBody::Node& node = body.m_nodes[static_cast<int>(i)];
                      const float* const velocity = m_nodes.velocity(i);
                      for (int axis = 0; axis < 3; ++axis)
                      {
                          node.m_x[axis] = m_nodes.position(i, axis);
                          node.m_v[axis] = velocity[axis];
                      }
                      node.m_f.setZero();
                  }
              });
}

// Takes the position of a node that contacts moved. The displacement of others is more precise than their position.
void SubstepBody::readPosition(std::size_t node, const btVector3& position)
{
    for (int axis = 0; axis < 3; ++axis)
        if (static_cast<float>(position[axis]) != m_nodes.position(node, axis))
            m_nodes.nodes()[node].m_displacement[axis] = static_cast<float>(position[axis]) - m_nodes.start(node)[axis];
}

// Moves the nodes by a substep and sweeps over the links.
void SubstepBody::moveNodes(ThreadTeam* threads)
{
    forRanges(m_nodes.count(), threads, [&](std::size_t from, std::size_t to) { m_nodes.advance(from, to); });
    for (int i = 0; i < kLinkSweeps; ++i)
        m_sweep.sweep(m_nodes.nodes(), threads);
}

void SubstepBody::advance(btSoftBody& body, ThreadTeam* threads)
{
    moveNodes(threads);
    writeNodes(body, threads);
}

void SubstepBody::endSubstep(btSoftBody& body, ThreadTeam* threads)
{
    forRanges(m_nodes.count(), threads,
              [&](std::size_t from, std::size_t to)
              {
                  for (std::size_t i = from; i < to; ++i)
                      readPosition(i, body.m_nodes[static_cast<int>(i)].m_x);
                  m_nodes.endSubstep(from, to, m_kept);
              });
    writeNodes(body, threads);
}

void SubstepBody::solveAlone(btSoftBody& body, ThreadTeam* threads)
{
    begin(body, threads);
    for (int i = 0; i < substepsOf(body); ++i)
    {
        moveNodes(threads);
        forRanges(m_nodes.count(), threads,
                  [&](std::size_t from, std::size_t to) { m_nodes.endSubstep(from, to, m_kept); });
    }
    writeNodes(body, threads);
}
}  // namespace drape
