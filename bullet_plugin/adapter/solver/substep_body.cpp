#include "bullet_plugin/adapter/solver/substep_body.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include "bullet_plugin/adapter/mirrors/mirrors.h"
#include "bullet_plugin/adapter/solver/body_jobs.h"
#include "bullet_plugin/adapter/solver/body_nodes.h"
#include "bullet_plugin/core/solver/link_strength.h"
#include "bullet_plugin/core/solver/topology/cloth_parts.h"

namespace drape
{
namespace
{
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
    return readLinks(body, threads);
}

int SubstepBody::leastSubstepsOf(const btSoftBody& body)
{
    return std::max(kLeastSubsteps, body.m_cfg.piterations);
}

btScalar SubstepBody::pathShift(const btSoftBody& body, int substeps)
{
    const btScalar share = btScalar(Substeps::pathShare(substeps));
    return (share - 1) * body.m_sst.sdt * body.m_sst.sdt;
}

btScalar SubstepBody::supportShift(const btSoftBody& body, int substeps)
{
    return btScalar(Substeps::pathShare(substeps)) * body.m_sst.sdt * body.m_sst.sdt;
}

void SubstepBody::setSupports(const std::vector<Vec3>& supports)
{
    m_isSupported = supports.size() == m_supports.size();
    if (m_isSupported) m_supports = supports;
}

void SubstepBody::reserve(const btSoftBody& body)
{
    m_isPredicted = m_isOnDevice = false;
    m_count = leastSubstepsOf(body);
    const std::size_t count = body.isActive() ? nodeCount(body) : 0;
    if (m_velocities.size() != count) m_velocities.clear();
    if (count == 0) return;
    m_accelerations.resize(count);
    m_predictions.resize(count);
    if (m_supports.size() != count) m_isSupported = false;
    m_supports.resize(count);
    m_velocities.resize(count);  // last: where it has its size, the others have theirs
}

void SubstepBody::beforePrediction(const btSoftBody& body, ThreadTeam* threads)
{
    if (m_velocities.size() != nodeCount(body)) return;
    std::atomic<bool> hasForces{body.m_cfg.kVC > 0 || body.m_cfg.kPR != 0};
    const auto record = [&](std::size_t first, std::size_t last)
    {
        bool any = false;
        for (std::size_t i = first; i < last; ++i)
        {
            const btSoftBody::Node& node = body.m_nodes[static_cast<int>(i)];
            m_velocities[i] = node.m_v;
            any = any || !node.m_f.isZero();
        }
        if (any) hasForces = true;
    };
    forRanges(m_velocities.size(), threads, record);
    m_hasForces = hasForces;
}

void SubstepBody::afterPrediction(btSoftBody& body, ThreadTeam* threads)
{
    if (!(body.m_sst.sdt > 0) || m_velocities.size() != nodeCount(body)) return;
    const btScalar shift = spread() * pathShift(body, m_count);
    const btScalar supportShift = SubstepBody::supportShift(body, m_count);
    const btScalar perSecond = body.m_sst.isdt;
    const btVector3 fall = body.m_worldInfo->m_gravity * body.m_sst.sdt;
    if (!m_isSupported) std::fill(m_supports.begin(), m_supports.end(), vec3(0, 0, 0));
    m_isSupported = false;
    m_isPredicted = true;
    m_isOnDevice = false;
    const auto bring = [&](std::size_t first, std::size_t last)
    {
        for (std::size_t i = first; i < last; ++i)
        {
            btSoftBody::Node& node = body.m_nodes[static_cast<int>(i)];
            // Forces act at the step's start, as with Bullet, and gravity with them, so that they may balance. A force
            // of volume, pressure or a spring depends on the positions; spread over the substeps it would add energy in
            // every step. What cloth rests under is gravity.
            if (m_hasForces && node.m_im > 0) m_velocities[i] = node.m_v - fall;
            const btVector3 acceleration = (node.m_v - m_velocities[i]) * perSecond;
            m_accelerations[i] = vec3Of(acceleration);
            const btVector3 moved = acceleration * shift + vectorOf(m_supports[i]) * supportShift;
            node.m_x += moved;
            m_predictions[i] = {node.m_x, node.m_v * body.m_sst.sdt + moved};
        }
    };
    forRanges(m_velocities.size(), threads, bring);
}

bool SubstepBody::fits(const btSoftBody& body) const
{
    return m_accelerations.size() == nodeCount(body);
}

void SubstepBody::leave(btSoftBody& body)
{
    m_isPredicted = false;
    changeOver();
    const btScalar shift = spread() * pathShift(body, m_count);
    const btScalar supportShift = SubstepBody::supportShift(body, m_count);
    for (std::size_t i = 0; fits(body) && i < m_accelerations.size(); ++i)
        body.m_nodes[static_cast<int>(i)].m_x -=
            vectorOf(m_accelerations[i]) * shift + vectorOf(m_supports[i]) * supportShift;
}

// Sorts the links by parts of the cloth, which is cut where its nodes are now.
void SubstepBody::cutLinks(const btSoftBody& body)
{
    std::vector<Vec3> positions(nodeCount(body));
    for (std::size_t i = 0; i < positions.size(); ++i)
        positions[i] = vec3Of(body.m_nodes[static_cast<int>(i)].m_q);
    m_parts.cut(std::move(positions));
    sortLinks();
    m_noFaces = ClothFaces({}, nodeCount(body));
}

// Sorts the links for sweeps.
void SubstepBody::sortLinks()
{
    m_isSorted = m_isSet = false;
    std::vector<LinkNodes> links;
    links.reserve(m_links.size());
    for (const LinkInput& link : m_links)
    {
        const int nodes[3] = {static_cast<int>(link.m_nodes[0]), static_cast<int>(link.m_nodes[1]), -1};
        const std::uint32_t group = static_cast<std::uint32_t>(m_parts.groupOf(nodes));
        links.push_back({{link.m_nodes[0], link.m_nodes[1]}, group});
    }
    m_substeps.links().build(m_parts.nodeCount(), m_parts.leafCount(), links, m_parts.revision());
    m_isSorted = true;
}

// Reads the links; sorts or sets those of the sweeps again if anything changed. Returns false if one joins another
// body's node.
bool SubstepBody::readLinks(const btSoftBody& body, ThreadTeam* threads)
{
    const std::size_t count = static_cast<std::size_t>(body.m_links.size());
    std::atomic<bool> isNew{!m_isSorted || m_links.size() != count || m_parts.nodeCount() != nodeCount(body)};
    const bool isCounted = m_iterations == body.m_cfg.piterations && m_setCount == m_count;
    std::atomic<bool> isOther{!m_isSet || !isCounted}, joinsOthers{false};
    m_links.resize(count);
    const auto read = [&](std::size_t first, std::size_t last)
    {
        bool moved = false, changed = false, foreign = false;
        for (std::size_t i = first; i < last; ++i)
        {
            const btSoftBody::Link& link = body.m_links[static_cast<int>(i)];
            LinkInput& known = m_links[i];
            for (int k = 0; k < 2; ++k)
            {
                const std::ptrdiff_t at = nodeAt(body, link.m_n[k]);
                const std::uint32_t node = static_cast<std::uint32_t>(at);
                foreign = foreign || at < 0;
                moved = moved || known.m_nodes[k] != node;
                known.m_nodes[k] = node;
            }
            const float c0 = float(link.m_c0), c1 = float(link.m_c1), stiffness = float(link.m_material->m_kLST);
            changed = changed || known.m_c0 != c0 || known.m_c1 != c1 || known.m_stiffness != stiffness;
            known.m_c0 = c0;
            known.m_c1 = c1;
            known.m_stiffness = stiffness;
        }
        if (moved) isNew = true;
        if (changed) isOther = true;
        if (foreign) joinsOthers = true;
    };
    forRanges(count, threads, read);
    m_isSorted = !isNew;
    m_isSet = !isNew && !isOther;
    if (joinsOthers) return false;
    if (isNew) cutLinks(body);
    if (!m_isSet) setLinks(body, threads);
    return true;
}

// Gives the sweeps the links' lengths and strengths.
void SubstepBody::setLinks(const btSoftBody& body, ThreadTeam* threads)
{
    const auto set = [&](std::size_t first, std::size_t last)
    {
        // Neighbouring links mostly have one material.
        float stiffness = -1;
        double factor = 0;
        for (std::size_t i = first; i < last; ++i)
        {
            const LinkInput& link = m_links[i];
            if (link.m_stiffness != stiffness)
            {
                stiffness = link.m_stiffness;
                const double share = visitShare(stiffness, body.m_cfg.piterations, m_count, Substeps::kLinkSweeps);
                factor = stiffness > 0 ? share / double(stiffness) : 0;
            }
            // Bullet's m_c0 is the sum of the inverse masses divided by the stiffness.
            const float strength = link.m_c0 > 0 ? static_cast<float>(factor / double(link.m_c0)) : 0.0f;
            m_substeps.links().set(i, link.m_c1, strength);
        }
    };
    forRanges(m_links.size(), threads, set);
    m_substeps.links().changed();
    m_iterations = body.m_cfg.piterations;
    m_setCount = m_count;
    m_isSet = true;
}

void SubstepBody::begin(const btSoftBody& body, ClothContacts* recorded, const ClothMirror* mirror, ThreadTeam* threads)
{
    // Links and contacts have the same parts. A cloth of one part is the same however it is cut.
    if (recorded && recorded->m_parts->revision() != m_parts.revision())
    {
        const bool isNew = std::max(recorded->m_parts->leafCount(), m_parts.leafCount()) > 1;
        ClothParts parts = *recorded->m_parts;
        m_parts = std::move(parts);  // the copy may fail, the move cannot
        if (isNew)
        {
            sortLinks();
            setLinks(body, threads);
        }
    }
    if (!recorded)
    {
        m_alone.m_nodes.resize(nodeCount(body));
        const bool isKnown = mirror && mirror->id() != kNoMesh && mirror->order().partsRevision() == m_parts.revision();
        m_alone.start(isKnown ? mirror->id() : kNoMesh, m_parts, isKnown ? &mirror->order() : nullptr);
        m_alone.m_limit.startStep(m_noFaces);
        m_alone.m_perSecond = static_cast<float>(body.m_sst.isdt);
    }
    m_substeps.prepare(static_cast<float>(body.m_sst.sdt), m_count, static_cast<float>(body.m_cfg.kDP), m_accelerations,
                       m_supports, float(spread()));
}

void SubstepBody::readPaths(const btSoftBody& body, ClothContacts* recorded, ThreadTeam* threads)
{
    if (m_isOnDevice) return;
    SolverNodes& nodes = recorded ? recorded->m_nodes : m_alone.m_nodes;
    const auto read = [&](std::size_t first, std::size_t last)
    {
        for (std::size_t i = first; i < last; ++i)
        {
            const btSoftBody::Node& node = body.m_nodes[static_cast<int>(i)];
            if (!recorded) recordPath(node, i, nodes);
            // The prediction's vector is more precise than the difference of two positions.
            if (node.m_x == m_predictions[i].m_end)
                nodes.setEnd(i, vec3Of(m_predictions[i].m_vector), nodes.velocity(i));
        }
    };
    forRanges(nodes.count(), threads, read);
}

void SubstepBody::addRows(const btSoftBody& body, const SolverNodes& nodes, RigidBodies& bodies)
{
    m_rigidRows.clear();
    bodies.addRows(body, m_count, nodes, m_rigidRows);
}

std::size_t SubstepBody::end(ClothContacts& cloth, btSoftBody& body, ThreadTeam* threads)
{
    cloth.addSlides();
    const SolverNodes& nodes = cloth.m_nodes;
    const float perSecond = float(body.m_sst.isdt);
    std::atomic<std::size_t> invalid{0};
    m_isSupported = true;
    const auto write = [&](std::size_t first, std::size_t last)
    {
        std::size_t count = 0;
        for (std::size_t i = first; i < last; ++i)
        {
            btSoftBody::Node& node = body.m_nodes[static_cast<int>(i)];
            writeNode(nodes, i, node);
            m_supports[i] = nodeSupport(nodes.states() + i, vec3Of(m_velocities[i]), m_accelerations[i], perSecond,
                                        cloth.m_leastThickness);
            node.m_f.setZero();
            count += !positionIsValid(vec3Of(node.m_x));
        }
        if (count > 0) invalid += count;
    };
    forRanges(nodes.count(), threads, write);
    return invalid;
}
}  // namespace drape
