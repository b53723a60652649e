#include "bullet_plugin/adapter/wiring/plugin_state.h"

#include <algorithm>

#include "BulletCollision/CollisionDispatch/btCollisionDispatcher.h"
#include "BulletSoftBody/btSoftBodySolvers.h"
#include "LinearMath/btQuickprof.h"
#include "bullet_plugin/adapter/mirrors/convex_reader.h"
#include "bullet_plugin/adapter/pairs/eligibility.h"
#include "bullet_plugin/adapter/wiring/wiring.h"
#include "bullet_plugin/core/scene/growing_arrays.h"
#include "bullet_plugin/core/public_call.h"

namespace drape
{
namespace
{
// Shortest time for which compiled kernels are reported, ms. Programs from a cache take less, also on a busy machine.
constexpr double kLongBuildMs = 3000;

std::string nameOf(const btSoftBody& body)
{
    char text[48];
    std::snprintf(text, sizeof text, "soft body %p", static_cast<const void*>(&body));
    return text;
}

// Calls the app's function in the app's floating-point environment. Returns false if it throws: the step goes on.
template <class Call>
bool runApps(const Call& call)
{
    const CallersFloats floats;
    try
    {
        call();
        return true;
    }
    catch (...)
    {
        return false;
    }
}
}  // namespace

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

void PluginState::log(const std::string& line) const
{
    // A failure of the log itself has nowhere to go.
    if (m_settings.m_log) runApps([&] { m_settings.m_log(line.c_str()); });
}

void PluginState::tellContacts(const btSoftBodySolver* solver, double timeStep)
{
    const std::shared_ptr<const ContactListener> listener = m_listener;  // the call may replace it
    if (!listener) return;
    BT_PROFILE("Drape listener");
    const StepContacts contacts = {solver, timeStep, m_records.list()};
    if (runApps([&] { (*listener)(contacts); }) || m_toldListener) return;
    m_toldListener = true;
    log("the contact listener threw an exception, which is dropped, as later ones are");
}

void PluginState::tellJobs()
{
    if (m_toldJobs || !m_threads->appFailed()) return;
    m_toldJobs = true;
    log("Settings::m_parallelFor threw an exception, which is dropped, as later ones are; the calling thread did the "
        "rest of its jobs");
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

void PluginState::tellDevice()
{
    const DeviceReport& report = device();
    m_toldError = error().failed();
    if (m_toldError)
    {
        const std::string detail = error().m_detail.substr(0, error().m_detail.find('\n'));
        return log((ready() ? "the host computes: " : "Drape is off: ") + error().m_call +
                   (detail.empty() ? "" : "; " + detail));
    }
    if (report.m_fromCache || report.m_buildMs < kLongBuildMs) return;
    char time[48];
    std::snprintf(time, sizeof time, " were compiled in %.1f s", report.m_buildMs / 1000);
    log("the kernels for " + m_pipeline->deviceName() + time);
}

void PluginState::tellDispatchers(const btAlignedObjectArray<btSoftBody*>& bodies)
{
    for (int i = 0; i < bodies.size(); ++i)
    {
        btDispatcher* const dispatcher = bodies[i]->m_worldInfo ? bodies[i]->m_worldInfo->m_dispatcher : nullptr;
        if (!dispatcher || !m_checkedWorlds.insert(dispatcher).second || pluginOf(*dispatcher) == this) continue;
        log(nameOf(*bodies[i]) +
            ": its world's dispatcher does not have this plugin's algorithm, so that Bullet's own collision handles "
            "meshes; make the dispatcher with a drape::CollisionConfiguration, or call drape::install()");
    }
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
    tellDispatchers(bodies);
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

void PluginState::markUnstepped(const btSoftBody& body)
{
    m_unstepped[&body] = body.getBroadphaseHandle();
    if (ownsSolver(body.getSoftBodySolver()) || !m_checkedWorlds.insert(body.m_worldInfo).second) return;
    log(nameOf(body) +
        ": its world's soft body solver is not a drape::SoftBodySolver of this plugin, so that Bullet's "
        "own collision handles meshes");
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
