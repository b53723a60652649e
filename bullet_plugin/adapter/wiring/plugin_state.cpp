#include "bullet_plugin/adapter/wiring/plugin_state.h"

#include <algorithm>

#include "BulletCollision/CollisionDispatch/btCollisionDispatcher.h"
#include "BulletSoftBody/btSoftBodySolvers.h"
#include "bullet_plugin/adapter/mirrors/convex_reader.h"
#include "bullet_plugin/adapter/pairs/eligibility.h"
#include "bullet_plugin/adapter/wiring/wiring.h"
#include "bullet_plugin/core/scene/growing_arrays.h"
#include "bullet_plugin/core/public_call.h"

namespace drape
{
PluginState::PluginState(const Settings& settings)
    : m_selfCollision(settings.m_solver != Solver::Bullet),
      m_settings(settings),
      m_create(*this, false),
      m_createSwapped(*this, true)
{
    m_stockCreateSwapped.m_swapped = m_stockConvexCreateSwapped.m_swapped = true;
    m_pipeline = guarded([&] { return Pipeline::create(settings, m_error); },
                         [&](const CaughtException& caught)
                         {
                             setError(m_error, "drape::Plugin", caught);
                             return std::unique_ptr<Pipeline>();
                         });
    if (!m_pipeline && !m_error.failed()) m_error.m_call = "drape::Plugin";
    m_threads = m_pipeline ? m_pipeline->threads() : std::make_shared<ThreadTeam>(1);
    m_failedDevice.m_device.m_name = "none";
    m_failedDevice.m_reason = m_error.m_call;
    tellDevice();
}

const DeviceReport& PluginState::device() const
{
    return m_pipeline ? m_pipeline->deviceReport() : m_failedDevice;
}

ThreadWatch::Call PluginState::beginCall()
{
    ThreadWatch::Call call(m_calls);
    if (call.isFirstOverlap())
        guardedOr(false,
                  [&]
                  {
                      log("two threads use one plugin at once, which is not safe: make a plugin for each thread");
                      return true;
                  });
    return call;
}

void PluginState::takeDevice(bool wait)
{
    if (!ready() || m_mustRestart || !device().m_isStarting || !(wait || m_pipeline->isStartDone())) return;
    m_found.keepList();
    m_pipeline->endStart();
    tellDevice();
}

void PluginState::forgetScene() noexcept
{
    m_notes.clear();
    m_noteOf.clear();
    m_owned.clear();
    m_cloths.clear();
    m_obstacles.clear();
    m_found.clear();
    m_records.clear();
    m_flagged.clear();
}

void PluginState::fail(const char* call, const CaughtException& caught) noexcept
{
    ++m_failures;
    m_kept.abandon();
    forgetScene();
    if (caught.m_isMemory)
    {
        m_mustRestart = true;
        return;
    }
    setError(m_error, call, caught);
    m_failedDevice.m_reason.swap(m_failedReason);
    m_pipeline.reset();
}

void PluginState::restart()
{
    if (!m_mustRestart) return;
    m_pipeline->restart();
    m_mustRestart = false;
}

btCollisionAlgorithmCreateFunc& PluginState::stockCreateFunction(int shapeType, bool swapped)
{
    if (isConvexType(shapeType)) return swapped ? m_stockConvexCreateSwapped : m_stockConvexCreate;
    if (swapped) return m_stockCreateSwapped;
    return m_stockCreate;
}

void PluginState::addSolver(const btSoftBodySolver* solver)
{
    m_solvers.push_back(solver);
}

void PluginState::removeSolver(const btSoftBodySolver* solver)
{
    dropNotes(solver);
    m_motions.erase(solver);
    m_stepped.erase(solver);
    forgetWorlds(solver);
    m_solvers.erase(std::remove(m_solvers.begin(), m_solvers.end(), solver), m_solvers.end());
}

bool PluginState::ownsSolver(const btSoftBodySolver* solver) const
{
    return std::find(m_solvers.begin(), m_solvers.end(), solver) != m_solvers.end();
}

void PluginState::beginStep(const btSoftBodySolver* solver, const btAlignedObjectArray<btSoftBody*>& bodies)
{
    takeDevice(false);
    if (ready() && m_pipeline->deviceFailed() && !m_toldError) tellDevice();
    tellDispatchers(solver, bodies);
    WorldBodies& before = m_stepped[solver];
    WorldBodies stepped;
    stepped.reserve(static_cast<std::size_t>(bodies.size()));
    for (int i = 0; i < bodies.size(); ++i)
    {
        const WorldBody* const known = findIn(before, *bodies[i]);
        stepped.push_back({bodies[i], bodies[i]->getBroadphaseHandle(), known ? known->m_tree : NodeTree::Bullets});
        m_unstepped.erase(bodies[i]);
    }
    std::sort(stepped.begin(), stepped.end(),
              [](const WorldBody& a, const WorldBody& b) { return std::less<const void*>()(a.m_body, b.m_body); });
    before.swap(stepped);
}

const PluginState::WorldBody* PluginState::findIn(const WorldBodies& bodies, const btSoftBody& body)
{
    const auto found = std::lower_bound(bodies.begin(), bodies.end(), &body,
                                        [](const WorldBody& listed, const btSoftBody* other)
                                        { return std::less<const void*>()(listed.m_body, other); });
    return found != bodies.end() && found->m_body == &body ? &*found : nullptr;
}

const btSoftBodySolver* PluginState::steppingSolver(const btSoftBody& body) const
{
    for (const auto& entry : m_stepped)
    {
        const WorldBody* const found = findIn(entry.second, body);
        if (found && found->m_proxy == body.getBroadphaseHandle()) return entry.first;
    }
    return nullptr;
}

NodeTree* PluginState::nodeTreeOf(const btSoftBodySolver* solver, const btSoftBody& body)
{
    const auto stepped = m_stepped.find(solver);
    const WorldBody* const found = stepped == m_stepped.end() ? nullptr : findIn(stepped->second, body);
    return found ? &found->m_tree : nullptr;
}

void PluginState::leaveNodeTree(const btSoftBody& body)
{
    for (const auto& entry : m_stepped)
    {
        const WorldBody* const found = findIn(entry.second, body);
        if (found && found->m_tree == NodeTree::Current) found->m_tree = NodeTree::Behind;
    }
}

void PluginState::updateNodeTree(btSoftBody& body)
{
    for (const auto& entry : m_stepped)
    {
        const WorldBody* const found = findIn(entry.second, body);
        if (!found || found->m_tree != NodeTree::Behind) continue;
        drape::updateNodeTree(body, m_threads.get());
        found->m_tree = NodeTree::Current;
    }
}

bool PluginState::steps(const btSoftBody& body) const
{
    if (steppingSolver(body)) return true;
    // Compared, never followed: a soft body may outlive its world's solver.
    if (!ownsSolver(body.getSoftBodySolver())) return false;
    const auto found = m_unstepped.find(&body);
    return found == m_unstepped.end() || found->second != body.getBroadphaseHandle();
}
}  // namespace drape
