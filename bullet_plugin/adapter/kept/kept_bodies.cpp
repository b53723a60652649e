#include "bullet_plugin/adapter/kept/kept_bodies.h"

#include <algorithm>
#include <iterator>

#include "bullet_plugin/adapter/kept/kept_boxes.h"
#include "bullet_plugin/adapter/kept/stock_pairs.h"
#include "bullet_plugin/adapter/mirrors/solid_links.h"
#include "bullet_plugin/adapter/pairs/eligibility.h"
#include "bullet_plugin/adapter/wiring/plugin_state.h"
#include "bullet_plugin/adapter/motion/prediction.h"
#include "bullet_plugin/adapter/solver/substep_body.h"
#include "bullet_plugin/adapter/vectors.h"
#include "bullet_plugin/core/public_call.h"
#include "bullet_plugin/core/solver/device/solve_stage.h"

namespace drape
{
namespace
{
btVector3 corner(const float numbers[3])
{
    return btVector3(btScalar(numbers[0]), btScalar(numbers[1]), btScalar(numbers[2]));
}

KeptStep stepOver(const btSoftBody& body, int substeps, KeptId id)
{
    KeptStep step;
    step.m_id = id;
    step.m_gravity = vec3Of(body.m_worldInfo->m_gravity * body.m_sst.sdt);
    step.m_time = float(body.m_sst.sdt);
    step.m_perSecond = float(body.m_sst.isdt);
    step.m_shift = float(SubstepBody::pathShift(body, substeps));
    step.m_supportShift = float(SubstepBody::supportShift(body, substeps));
    return step;
}

bool isSameStep(const KeptStep& a, const KeptStep& b)
{
    return a.m_gravity.x == b.m_gravity.x && a.m_gravity.y == b.m_gravity.y && a.m_gravity.z == b.m_gravity.z &&
           a.m_time == b.m_time && a.m_perSecond == b.m_perSecond && a.m_shift == b.m_shift &&
           a.m_supportShift == b.m_supportShift;
}

// Adds the normals of faces to those of their nodes, as Bullet does.
void writeNormals(const btSoftBody& body, const KeptNode* nodes, float* normals)
{
    const std::size_t count = static_cast<std::size_t>(body.m_nodes.size());
    std::vector<btVector3> sums(count, btVector3(0, 0, 0));
    for (int f = 0; f < body.m_faces.size(); ++f)
    {
        int at[3];
        for (int k = 0; k < 3; ++k)
            at[k] = nodeIndex(body, body.m_faces[f].m_n[k]);
        if (std::count(at, at + 3, kForeign) > 0) continue;  // a node of another body
        const btVector3 first = vectorOf(nodes[at[0]].m_position);
        const btVector3 normal =
            (vectorOf(nodes[at[1]].m_position) - first).cross(vectorOf(nodes[at[2]].m_position) - first);
        for (const int node : at)
            sums[static_cast<std::size_t>(node)] += normal;
    }
    for (std::size_t i = 0; i < count; ++i)
    {
        const btScalar length = sums[i].length();
        if (length > SIMD_EPSILON) sums[i] /= length;
        std::copy(sums[i].m_floats, sums[i].m_floats + 3, normals + 3 * i);
    }
}

// Returns the number of nodes that both the body and the device have.
int countOf(const btSoftBody& body, std::size_t stored)
{
    return std::min(body.m_nodes.size(), static_cast<int>(stored));
}

bool anyPinned(const btSoftBody& body)
{
    for (int i = 0; i < body.m_nodes.size(); ++i)
        if (!(body.m_nodes[i].m_im > 0)) return true;
    return false;
}

void write(const Vec3& v, float* to)
{
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
}
}  // namespace

KeptBodies::Kept* KeptBodies::find(const btSoftBody& body)
{
    const auto found = m_bodies.find(&body);
    return found == m_bodies.end() ? nullptr : &found->second;
}

const KeptBodies::Kept* KeptBodies::find(const btSoftBody& body) const
{
    const auto found = m_bodies.find(&body);
    return found == m_bodies.end() ? nullptr : &found->second;
}

// Returns the stage that holds the nodes; null without a device.
SolveStage* KeptBodies::stage() const
{
    return m_state.ready() ? m_state.pipeline().solveStage(SIZE_MAX) : nullptr;
}

const char* KeptBodies::keep(btSoftBody& body)
{
    if (const char* reason = reasonForBulletsLinks(m_state, body)) return reason;
    if (const char* reason = reasonForBulletsPrediction(body)) return reason;
    m_state.takeDevice(true);
    SolveStage* const solver = stage();
    if (!solver) return "no OpenCL device solves cloth (Settings::m_solverPlace)";
    if (body.m_anchors.size() > 0) return "the soft body has anchors";
    const Kept* const known = find(body);
    if (!known || known->m_revision != solver->revision()) makeRoom(body, m_bodies[&body]);
    return nullptr;
}

// Gives the body memory on the device. It is on the host then.
void KeptBodies::makeRoom(const btSoftBody& body, Kept& kept)
{
    kept = Kept();
    kept.m_count = static_cast<std::size_t>(body.m_nodes.size());
    kept.m_id = stage()->kept().add(kept.m_count);
    kept.m_revision = stage()->revision();
}

void KeptBodies::freeRoom(const Kept& kept)
{
    SolveStage* const solver = stage();
    if (solver && kept.m_revision == solver->revision()) solver->kept().remove(kept.m_id);
}

void KeptBodies::takeNodes(const btSoftBody& body)
{
    Kept* const kept = find(body);
    if (kept) kept->m_isOnDevice = kept->m_isReading = false;
}

void KeptBodies::forgetRemoved(const btSoftBodySolver* solver, const btAlignedObjectArray<btSoftBody*>& bodies)
{
    const auto isRemoved = [&](const auto& entry)
    {
        return entry.second.m_solver == solver &&
               bodies.findLinearSearch(const_cast<btSoftBody*>(entry.first)) == bodies.size();
    };
    for (auto entry = m_bodies.begin(); entry != m_bodies.end();)
    {
        if (isRemoved(*entry)) freeRoom(entry->second);
        entry = isRemoved(*entry) ? m_bodies.erase(entry) : std::next(entry);
    }
    for (auto entry = m_supports.begin(); entry != m_supports.end();)
        entry = isRemoved(*entry) ? m_supports.erase(entry) : std::next(entry);
}

void KeptBodies::release(btSoftBody& body)
{
    Kept* const kept = find(body);
    if (!kept) return;
    kept->m_isReading = false;  // a transfer of an earlier step's nodes
    fetch(body);
    freeRoom(*kept);
    m_bodies.erase(&body);
}

void KeptBodies::abandon() noexcept
{
    SolveStage* const solver = guardedOr(static_cast<SolveStage*>(nullptr), [this] { return stage(); });
    for (auto& entry : m_bodies)
    {
        Kept& kept = entry.second;
        if (!kept.m_isOnDevice || !solver || kept.m_revision != solver->revision()) continue;
        guarded([&] { bringToHost(*const_cast<btSoftBody*>(entry.first)); }, [](const CaughtException&) {});
    }
    m_bodies.clear();
}

void KeptBodies::beginFetch(const btSoftBody& body)
{
    Kept* const kept = find(body);
    SolveStage* const solver = stage();
    if (!kept || !kept->m_isOnDevice || !solver) return;
    solver->kept().beginRead(kept->m_id);
    kept->m_isReading = true;
    kept->m_waitsBefore = m_state.pipeline().deviceWaits();
}

// Returns the nodes of beginFetch(), or those of now; null if the device lost them.
const KeptNode* KeptBodies::read(Kept& kept)
{
    SolveStage* const solver = stage();
    if (!solver || kept.m_revision != solver->revision()) return nullptr;
    const bool arrived = kept.m_isReading && m_state.pipeline().deviceWaits() > kept.m_waitsBefore;
    if (!kept.m_isReading) solver->kept().beginRead(kept.m_id);
    kept.m_isReading = false;
    if (!arrived && !m_state.pipeline().waitForDevice()) return nullptr;
    return solver->kept().nodesRead(kept.m_id);
}

bool KeptBodies::fetch(btSoftBody& body)
{
    Kept* const kept = find(body);
    if (!kept || !kept->m_isOnDevice) return false;
    const KeptNode* const nodes = read(*kept);
    if (!nodes) return false;
    for (int i = 0; i < countOf(body, kept->m_count); ++i)
    {
        btSoftBody::Node& node = body.m_nodes[i];
        node.m_x = node.m_q = vectorOf(nodes[i].m_position);
        node.m_v = vectorOf(nodes[i].m_velocity);
    }
    body.updateNormals();
    m_state.leaveNodeTree(body);
    for (std::size_t k = 0; k < kept->m_pins.size(); ++k)
        kept->m_pinnedAt[k] = body.m_nodes[kept->m_pins[k]].m_x;
    takeSupports(body, *kept, nodes);
    return true;
}

bool KeptBodies::fetch(const btSoftBody& body, const NodeArrays& arrays)
{
    Kept* const kept = find(body);
    const KeptNode* const nodes = kept && kept->m_isOnDevice ? read(*kept) : nullptr;
    if (!nodes || kept->m_count != static_cast<std::size_t>(body.m_nodes.size())) return false;
    for (std::size_t i = 0; i < kept->m_count; ++i)
    {
        if (arrays.m_positions) write(nodes[i].m_position, arrays.m_positions + 3 * i);
        if (arrays.m_velocities) write(nodes[i].m_velocity, arrays.m_velocities + 3 * i);
    }
    if (arrays.m_normals) writeNormals(body, nodes, arrays.m_normals);
    return true;
}

bool KeptBodies::isOnDevice(const btSoftBody& body) const
{
    const Kept* const kept = find(body);
    return kept && kept->m_isOnDevice;
}

bool KeptBodies::anyBegun() const
{
    return std::any_of(m_bodies.begin(), m_bodies.end(), [](const auto& entry) { return entry.second.m_isBegun; });
}

bool KeptBodies::hasPins(const btSoftBody& body) const
{
    const Kept* const kept = find(body);
    return kept && !kept->m_pins.empty();
}

bool KeptBodies::anyPinMoved(const btSoftBody& body, const Kept& kept) const
{
    for (std::size_t k = 0; k < kept.m_pins.size(); ++k)
        if (body.m_nodes[kept.m_pins[k]].m_x != kept.m_pinnedAt[k]) return true;
    return false;
}

bool KeptBodies::begin(btSoftBody& body, int substeps, btScalar dt)
{
    Kept& kept = *find(body);
    kept.m_isBegun = false;
    if (m_isRetired || kept.m_count != static_cast<std::size_t>(body.m_nodes.size())) return false;
    if (kept.m_faces != body.m_faces.size() || kept.m_links != body.m_links.size()) return false;
    if (!isPlain(body, dt) || body.m_anchors.size() > 0 || anyPinMoved(body, kept)) return false;
    beginPlain(body, dt);
    const KeptStep step = stepOver(body, substeps, kept.m_id);
    if (!isSameStep(step, kept.m_step)) return false;
    const KeptBoxes& boxes = boxesOf(body);
    if (!boxes.m_areFinite) return false;
    setBounds(body, corner(boxes.m_low[1]), corner(boxes.m_high[1]));
    if (anyStockPair(m_state, body)) return false;
    body.m_rcontacts.resizeNoInitialize(0);
    body.m_scontacts.resizeNoInitialize(0);
    kept.m_isBegun = true;
    return true;
}

bool KeptBodies::isRead(const btSoftBody& body, const btCollisionObject& object) const
{
    return isStockPair(m_state, body, object);
}

const KeptStep* KeptBodies::stepOf(const btSoftBody& body) const
{
    const Kept* const kept = find(body);
    return kept && kept->m_isOnDevice && kept->m_isBegun ? &kept->m_step : nullptr;
}

const KeptBoxes& KeptBodies::boxesOf(const btSoftBody& body) const
{
    return stage()->kept().boxes(find(body)->m_id);
}

void KeptBodies::beginBringing(const btSoftBody& body)
{
    beginFetch(body);
    Kept& kept = *find(body);
    kept.m_isBringing = kept.m_isReading;
}

// Pinned nodes stay where Bullet has them if the app moved them.
void KeptBodies::bringToHost(btSoftBody& body)
{
    Kept& kept = *find(body);
    if (!kept.m_isBringing) kept.m_isReading = false;  // a transfer of an earlier step's nodes
    kept.m_isBringing = false;
    const KeptNode* const nodes = read(kept);
    kept.m_isOnDevice = kept.m_isBegun = false;
    if (!nodes) return;
    std::size_t pin = 0;
    for (int i = 0; i < countOf(body, kept.m_count); ++i)
    {
        btSoftBody::Node& node = body.m_nodes[i];
        const bool isPin = pin < kept.m_pins.size() && kept.m_pins[pin] == i;
        const bool isMoved = isPin && node.m_x != kept.m_pinnedAt[pin];
        if (isPin) ++pin;
        node.m_q = vectorOf(nodes[i].m_position);
        node.m_f.setZero();  // the app added these while the body was on the device
        if (isMoved) continue;
        node.m_x = node.m_q;
        node.m_v = vectorOf(nodes[i].m_velocity);
    }
    if (!isPlain(body)) body.updateNormals();  // for Bullet's prediction
    takeSupports(body, kept, nodes);
}

void KeptBodies::takeSupports(const btSoftBody& body, const Kept& kept, const KeptNode* nodes)
{
    std::vector<Vec3>& values = m_supports[&body].m_values;
    values.resize(kept.m_count);
    for (std::size_t i = 0; i < kept.m_count; ++i)
        values[i] = nodes[i].m_support;
}

bool KeptBodies::hadPair(const btSoftBody& body) const
{
    const Kept* const kept = find(body);
    return kept && kept->m_hadPair;
}

void KeptBodies::giveSupports(const btSoftBody& body, SubstepBody* substeps)
{
    const auto found = m_supports.find(&body);
    if (found == m_supports.end()) return;
    std::vector<Vec3>& values = found->second.m_values;
    if (substeps && !values.empty()) substeps->setSupports(values);
    values.clear();
    if (!find(body)) m_supports.erase(found);
}

void KeptBodies::store(btSoftBody& body, Kept& kept, const SubstepBody* substeps)
{
    if (kept.m_count != static_cast<std::size_t>(body.m_nodes.size()))
    {
        freeRoom(kept);
        kept.m_count = static_cast<std::size_t>(body.m_nodes.size());
        kept.m_id = stage()->kept().add(kept.m_count);
    }
    Supports& supports = m_supports[&body];
    supports.m_values.reserve(kept.m_count);
    supports.m_solver = kept.m_solver;
    std::vector<KeptNode> nodes(kept.m_count);
    const bool isSupported = substeps && substeps->isSupported() && substeps->supports().size() == nodes.size();
    kept.m_pins.clear();
    kept.m_pinnedAt.clear();
    for (std::size_t i = 0; i < nodes.size(); ++i)
    {
        const btSoftBody::Node& node = body.m_nodes[static_cast<int>(i)];
        const Vec3 support = isSupported ? substeps->supports()[i] : vec3(0, 0, 0);
        nodes[i] = {vec3Of(node.m_x), float(node.m_im), vec3Of(node.m_v), 0, support, 0};
        if (node.m_im > 0) continue;
        kept.m_pins.push_back(static_cast<int>(i));
        kept.m_pinnedAt.push_back(node.m_x);
    }
    kept.m_faces = body.m_faces.size();
    kept.m_links = body.m_links.size();
    kept.m_step = stepOver(body, substeps ? substeps->count() : SubstepBody::leastSubstepsOf(body), kept.m_id);
    stage()->kept().write(kept.m_id, nodes, boxesAround(body, kept.m_step, nodes));
    kept.m_isOnDevice = true;
}

void KeptBodies::endStep(btSoftBody& body, const btSoftBodySolver* bulletSolver, bool hasPair,
                         const SubstepBody* substeps)
{
    Kept* const kept = find(body);
    if (!kept) return;
    const SolveStage* const solver = stage();
    if (!solver || kept->m_revision != solver->revision())
    {
        m_bodies.erase(&body);
        return;
    }
    kept->m_solver = bulletSolver;
    kept->m_hadPair = hasPair;
    // The next step would bring a free body to the host.
    if (!m_isRetired && !kept->m_isOnDevice && (hasPair || anyPinned(body))) store(body, *kept, substeps);
    kept->m_isBegun = false;
}
}  // namespace drape
