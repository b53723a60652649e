#include "bullet_plugin/adapter/substep_body.h"

#include <algorithm>
#include <atomic>

#include "bullet_plugin/adapter/body_nodes.h"
#include "bullet_plugin/core/solver/cloth_parts.h"
#include "bullet_plugin/core/solver/link_strength.h"

namespace drape
{
namespace
{
// Minimum nodes or links for sharing a pass over them, and those of a range.
constexpr std::size_t kLeastShared = 8192, kRange = 2048;

std::size_t nodeCount(const btSoftBody& body)
{
    return static_cast<std::size_t>(body.m_nodes.size());
}

// Returns the index of a node; -1 for one of another body.
std::ptrdiff_t nodeAt(const btSoftBody& body, const btSoftBody::Node* node)
{
    const btSoftBody::Node* const first = body.m_nodes.size() > 0 ? &body.m_nodes[0] : nullptr;
    return node >= first && node < first + body.m_nodes.size() ? node - first : -1;
}

// Calls work(first, last) for ranges of `count` elements. threads: null for the caller alone.
template <class Work>
void forRanges(std::size_t count, ThreadTeam* threads, const Work& work)
{
    if (!threads || count < kLeastShared) return work(std::size_t(0), count);
    threads->run((count + kRange - 1) / kRange,
                 [&](std::size_t range) { work(range * kRange, std::min(count, (range + 1) * kRange)); });
}

// Returns how far the end of a free path in substeps lies from Bullet's prediction, per unit of acceleration, s².
btScalar shiftOf(const btSoftBody& body)
{
    const btScalar share = btScalar(Substeps::pathShare(SubstepBody::substepsOf(body)));
    return (share - 1) * body.m_sst.sdt * body.m_sst.sdt;
}
}  // namespace

const char* SubstepBody::reasonFromSettings(const btSoftBody& body)
{
    const btSoftBody::Config& config = body.m_cfg;
    if (sizeof(btScalar) != sizeof(float)) return "Bullet computes in double precision";
    if (body.m_reducedModel) return "the soft body is a reduced deformable model";
    if (body.m_clusters.size() > 0 || body.m_joints.size() > 0) return "the soft body has clusters or joints";
    if (body.m_pose.m_bframe && config.kMT > 0) return "the soft body matches a pose (kMT)";
    if (config.viterations > 0) return "the soft body has velocity iterations (viterations)";
    if (config.diterations > 0) return "the soft body has drift iterations (diterations)";
    if (config.piterations < 1) return "the soft body has no position iterations (piterations)";
    const btSoftBody::tPSolverArray& sequence = config.m_psequence;
    if (sequence.findLinearSearch(btSoftBody::ePSolver::Linear) == sequence.size())
        return "the soft body's solver sequence has no links (m_psequence)";
    return nullptr;
}

const char* SubstepBody::reasonForBullet(const btSoftBody& body)
{
    if (const char* reason = reasonFromSettings(body)) return reason;
    for (int i = 0; i < body.m_links.size(); ++i)
        if (nodeAt(body, body.m_links[i].m_n[0]) < 0 || nodeAt(body, body.m_links[i].m_n[1]) < 0)
            return "links join the soft body to another one";
    return nullptr;
}

bool SubstepBody::canSolveNow(const btSoftBody& body, ThreadTeam* threads)
{
    if (!fits(body) || reasonFromSettings(body)) return false;
    // Bullet's own algorithms found that it touches a soft body, or itself.
    if (body.m_scontacts.size() > 0 || RigidBodies::reasonForBullet(body)) return false;
    return readTopology(body, threads);
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
    if (!(body.m_sst.sdt > 0) || m_velocities.size() != nodeCount(body)) return;
    const btScalar shift = shiftOf(body), perSecond = body.m_sst.isdt;
    m_accelerations.resize(m_velocities.size());
    m_predictions.resize(m_velocities.size());
    m_isPredicted = true;
    for (std::size_t i = 0; i < m_accelerations.size(); ++i)
    {
        btSoftBody::Node& node = body.m_nodes[static_cast<int>(i)];
        const btVector3 acceleration = (node.m_v - m_velocities[i]) * perSecond;
        m_accelerations[i] = vec3Of(acceleration);
        node.m_x += acceleration * shift;
        m_predictions[i] = {node.m_x, node.m_v * body.m_sst.sdt + acceleration * shift};
    }
}

bool SubstepBody::fits(const btSoftBody& body) const
{
    return m_accelerations.size() == nodeCount(body);
}

void SubstepBody::leave(btSoftBody& body)
{
    m_isPredicted = false;
    changeOver();
    const btScalar shift = shiftOf(body);
    for (std::size_t i = 0; fits(body) && i < m_accelerations.size(); ++i)
        body.m_nodes[static_cast<int>(i)].m_x -= vectorOf(m_accelerations[i]) * shift;
}

// Sorts the links for sweeps: the cloth is cut where its nodes are now.
void SubstepBody::buildLinks(const btSoftBody& body)
{
    std::vector<Vec3> positions(nodeCount(body));
    for (std::size_t i = 0; i < positions.size(); ++i)
        positions[i] = vec3Of(body.m_nodes[static_cast<int>(i)].m_q);
    m_parts.cut(std::move(positions));
    for (LinkNodes& link : m_links)
    {
        const int nodes[3] = {static_cast<int>(link.m_nodes[0]), static_cast<int>(link.m_nodes[1]), -1};
        link.m_group = static_cast<std::uint32_t>(m_parts.groupOf(nodes));
    }
    m_substeps.links().build(nodeCount(body), m_parts.leafCount(), m_links);
    m_noFaces = ClothFaces({}, nodeCount(body));
    m_isSorted = true;
}

// Reads which nodes the links join; sorts them again if that changed. Returns false if one is another body's.
bool SubstepBody::readTopology(const btSoftBody& body, ThreadTeam* threads)
{
    const std::size_t count = static_cast<std::size_t>(body.m_links.size());
    std::atomic<bool> isNew{!m_isSorted || m_links.size() != count || m_parts.nodeCount() != nodeCount(body)};
    std::atomic<bool> joinsOthers{false};
    m_links.resize(count);
    const auto read = [&](std::size_t first, std::size_t last)
    {
        bool changed = false, foreign = false;
        for (std::size_t i = first; i < last; ++i)
        {
            for (int k = 0; k < 2; ++k)
            {
                const std::ptrdiff_t at = nodeAt(body, body.m_links[static_cast<int>(i)].m_n[k]);
                const std::uint32_t node = static_cast<std::uint32_t>(at);
                foreign = foreign || at < 0;
                changed = changed || m_links[i].m_nodes[k] != node;
                m_links[i].m_nodes[k] = node;
            }
        }
        if (changed) isNew = true;
        if (foreign) joinsOthers = true;
    };
    forRanges(count, threads, read);
    m_isSorted = !isNew;
    if (joinsOthers) return false;
    if (isNew) buildLinks(body);
    return true;
}

// Reads lengths and strengths of the links, whose nodes have their starts.
void SubstepBody::readLinks(const btSoftBody& body, ThreadTeam* threads)
{
    std::atomic<bool> isNew{false};
    const auto read = [&](std::size_t first, std::size_t last)
    {
        // Neighbouring links mostly have one material.
        btScalar stiffness = -1;
        double factor = 0;
        bool changed = false;
        for (std::size_t i = first; i < last; ++i)
        {
            const btSoftBody::Link& link = body.m_links[static_cast<int>(i)];
            if (link.m_material->m_kLST != stiffness)
            {
                stiffness = link.m_material->m_kLST;
                const double share =
                    visitShare(stiffness, body.m_cfg.piterations, substepsOf(body), Substeps::kLinkSweeps);
                factor = stiffness > 0 ? share / double(stiffness) : 0;
            }
            // Bullet's m_c0 is the sum of the inverse masses divided by the stiffness.
            const bool acts = link.m_c0 > 0;
            const float strength = acts ? static_cast<float>(factor / double(link.m_c0)) : 0.0f;
            const Vec3 apart = vec3Of(link.m_n[1]->m_q - link.m_n[0]->m_q);
            const bool isSet = m_substeps.links().set(i, apart, static_cast<float>(link.m_c1), strength);
            changed = changed || isSet;
        }
        if (changed) isNew = true;
    };
    forRanges(m_links.size(), threads, read);
    if (isNew) m_substeps.links().changed();
}

void SubstepBody::begin(const btSoftBody& body, SolverNodes* recorded, RigidBodies& bodies, ThreadTeam* threads)
{
    readLinks(body, threads);
    SolverNodes& nodes = recorded ? *recorded : m_alone.m_nodes;
    if (!recorded)
    {
        nodes.resize(nodeCount(body));
        m_alone.start(m_parts);
        m_alone.m_limit.startStep(m_noFaces);
        m_alone.m_perSecond = static_cast<float>(body.m_sst.isdt);
    }
    for (std::size_t i = 0; i < nodes.count(); ++i)
    {
        const btSoftBody::Node& node = body.m_nodes[static_cast<int>(i)];
        if (!recorded) recordPath(node, i, nodes);
        // The prediction's way is more precise than the difference of two positions.
        if (node.m_x == m_predictions[i].m_end) nodes.setEnd(i, vec3Of(m_predictions[i].m_way), nodes.velocity(i));
    }
    m_substeps.prepare(static_cast<float>(body.m_sst.sdt), substepsOf(body), static_cast<float>(body.m_cfg.kDP),
                       m_accelerations);
    m_rigidRows.clear();
    bodies.addRows(body, nodes, m_rigidRows);
}

void SubstepBody::end(const SolverNodes& nodes, btSoftBody& body, ThreadTeam* threads)
{
    const auto write = [&](std::size_t first, std::size_t last)
    {
        for (std::size_t i = first; i < last; ++i)
        {
            btSoftBody::Node& node = body.m_nodes[static_cast<int>(i)];
            writeNode(nodes, i, node);
            node.m_f.setZero();
        }
    };
    forRanges(nodes.count(), threads, write);
}
}  // namespace drape
