// Writes the plugin's lines in the log, and remembers enough that each appears once while its problem lasts.
#include <algorithm>
#include <cctype>
#include <cstdio>

#include "BulletCollision/CollisionDispatch/btCollisionDispatcher.h"
#include "LinearMath/btQuickprof.h"
#include "bullet_plugin/adapter/pairs/margins.h"
#include "bullet_plugin/adapter/wiring/plugin_state.h"
#include "bullet_plugin/adapter/wiring/wiring.h"
#include "bullet_plugin/core/device/missing_device.h"
#include "bullet_plugin/core/public_call.h"

namespace drape
{
namespace
{
// Shortest time for which compiled kernels are reported, ms. PoCL does not say whether kernels came from its own cache;
// those that did take less, also on a busy machine.
constexpr double kLongBuildMs = 500, kLongBuildMsOnPocl = 3000;

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

// Returns the collision configuration of a dispatcher, for comparison alone; null if it is not known.
const btCollisionConfiguration* configurationOf(btDispatcher* dispatcher)
{
    auto* const known = dynamic_cast<btCollisionDispatcher*>(dispatcher);
    return known ? known->getCollisionConfiguration() : nullptr;
}

btDispatcher* dispatcherOf(const btSoftBody& body)
{
    return body.m_worldInfo ? body.m_worldInfo->m_dispatcher : nullptr;
}
}  // namespace

void PluginState::log(const std::string& line) const
{
    // A failure of the log itself has nowhere to go.
    if (m_settings.m_log) runApps([&] { m_settings.m_log(line.c_str()); });
}

std::string PluginState::nameOf(const btCollisionObject& object) const
{
    std::string name;
    if (m_settings.m_nameOf) runApps([&] { name = m_settings.m_nameOf(object); });
    std::replace_if(
        name.begin(), name.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
    if (!name.empty()) return name;
    char text[48];
    std::snprintf(text, sizeof text, "%s %p", btSoftBody::upcast(&object) ? "soft body" : "object",
                  static_cast<const void*>(&object));
    return text;
}

std::string PluginState::namesOf(const btCollisionObject& a, const btCollisionObject& b) const
{
    return nameOf(a) + " and " + (&a == &b ? "itself" : nameOf(b));
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
    m_toldCompileMs = m_pipeline ? m_pipeline->compileMs() : 0;
    if (!report.m_fromCache) tellKernels("the kernels", report.m_buildMs);
}

void PluginState::tellCompiled()
{
    if (!ready()) return;
    const double ms = m_pipeline->compileMs();
    if (ms == m_toldCompileMs) return;
    tellKernels("further kernels", ms - m_toldCompileMs);
    m_toldCompileMs = ms;
}

void PluginState::tellKernels(const char* which, double ms) const
{
    if (!ready()) return;
    const DeviceInfo device = m_pipeline->openDevice();
    if (ms < (device.m_platform == kPoclPlatform ? kLongBuildMsOnPocl : kLongBuildMs)) return;
    char time[48];
    std::snprintf(time, sizeof time, " were compiled in %.1f s", ms / 1000);
    log(std::string(which) + " for " + device.m_name + time);
}

std::string PluginState::jumpRemark(const btCollisionObject& object) const
{
    const auto jumps = [&](const auto& mirror)
    { return mirror.first.m_object == &object && mirror.second.jumpsOften(); };
    if (std::none_of(m_obstacles.begin(), m_obstacles.end(), jumps)) return std::string();
    return "its pose changes beside cloth in step after step, and each change is a teleport, through which cloth may "
           "be lost: move it as a kinematic btRigidBody, by its motion state or its world transform alone";
}

void PluginState::tellJumps(const btCollisionObject& object)
{
    const auto jumps = [&](const auto& mirror)
    { return mirror.first.m_object == &object && mirror.second.jumpsOften(); };
    if (std::count_if(m_obstacles.begin(), m_obstacles.end(), jumps) == 1)
        log(nameOf(object) + ": " + jumpRemark(object));
}

void PluginState::tellThickness(const btSoftBody& body, double thickness) const
{
    char line[128];
    std::snprintf(line, sizeof(line), ": the thickness given to setSelfCollision() is %g m; twice the margin is used",
                  thickness);
    log(nameOf(body) + line);
}

void PluginState::tellNoEffect(const btCollisionShape& shape, const char* call, const char* whatFor) const
{
    char line[256];
    std::snprintf(line, sizeof(line), "Plugin::%s() has no effect on shape %p, a %s: it is for %s", call,
                  static_cast<const void*>(&shape), shape.getName(), whatFor);
    log(line);
}

bool PluginState::isToldOf(const void* place, const btDispatcher* dispatcher) const
{
    return std::any_of(m_toldWorlds.begin(), m_toldWorlds.end(),
                       [&](const ToldWorld& told) { return told.m_place == place && told.m_dispatcher == dispatcher; });
}

void PluginState::forgetWorlds(const void* gone)
{
    const auto has = [&](const ToldWorld& told)
    { return told.m_place == gone || told.m_dispatcher == gone || told.m_configuration == gone; };
    m_toldWorlds.erase(std::remove_if(m_toldWorlds.begin(), m_toldWorlds.end(), has), m_toldWorlds.end());
}

void PluginState::tellDispatcher(const btSoftBodySolver* solver, const btSoftBody& body)
{
    btDispatcher* const dispatcher = dispatcherOf(body);
    if (!dispatcher) return;
    if (pluginOf(*dispatcher) == this) return forgetWorlds(dispatcher);
    if (isToldOf(solver, dispatcher)) return;
    m_toldWorlds.push_back({solver, dispatcher, configurationOf(dispatcher)});
    log(nameOf(body) +
        ": its world's dispatcher does not have this plugin's algorithm, so that Bullet's own collision handles "
        "meshes; make the dispatcher with a drape::CollisionConfiguration, or call drape::install()");
}

void PluginState::tellDispatchers(const btSoftBodySolver* solver, const btAlignedObjectArray<btSoftBody*>& bodies)
{
    const auto stepped = m_stepped.find(solver);
    const btDispatcher* checked = nullptr;
    for (int i = 0; i < bodies.size(); ++i)
    {
        if (dispatcherOf(*bodies[i]) == checked) continue;
        const WorldBody* const known = stepped == m_stepped.end() ? nullptr : findIn(stepped->second, *bodies[i]);
        if (known && known->m_proxy == bodies[i]->getBroadphaseHandle()) continue;
        checked = dispatcherOf(*bodies[i]);
        tellDispatcher(solver, *bodies[i]);
    }
}

void PluginState::markUnstepped(const btSoftBody& body)
{
    m_unstepped[&body] = body.getBroadphaseHandle();
    btDispatcher* const dispatcher = dispatcherOf(body);
    if (ownsSolver(body.getSoftBodySolver()) || isToldOf(body.m_worldInfo, dispatcher)) return;
    m_toldWorlds.push_back({body.m_worldInfo, dispatcher, configurationOf(dispatcher)});
    log(nameOf(body) +
        ": its world's soft body solver is not a drape::SoftBodySolver of this plugin, so that Bullet's "
        "own collision handles meshes");
}
}  // namespace drape
