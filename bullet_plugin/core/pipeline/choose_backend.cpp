// Chooses a scene's back end if the settings leave it to cost. The crossover is found when the pipeline is created, and
// compared with the scene's work when its pairs change.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "bullet_plugin/core/stopwatch.h"
#include "bullet_plugin/core/backend_choice/crossover_ladder.h"
#include "implementation.h"
#include "bullet_plugin/core/backend_choice/scene_work.h"

namespace drape
{
namespace
{
std::string rounded(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.0f", value);
    return text;
}

Surface surfaceOf(const PooledMesh& mesh)
{
    return mesh.m_vacant ? Surface() : Surface{mesh.m_topology.m_triangles.size(), mesh.m_area};
}
}  // namespace

bool Pipeline::Implementation::costDecides(const DeviceChoice& choice) const
{
    // A profile is of what runs on the device.
    return choice.m_byCost && !m_settings.m_profileKernels;
}

double Pipeline::Implementation::findCrossover(Pipeline& pipeline)
{
    const CrossoverCache cache(m_settings, m_openClDevice, device()->computeUnits());
    const char* const onBusy = ", on a busy machine";
    Crossover before, crossover;
    const bool known = cache.load(before);
    if (known && !isProvisional(before))
    {
        m_report.m_crossoverSource = std::string("measured before") + (before.m_busyStarts > 0 ? onBusy : "");
        return before.m_pairs;
    }
    Stopwatch watch;
    bool busy = false;
    const char* const why = measureLadder(
        pipeline, m_settings.m_activation, [&](bool onHost) { m_report.m_onHost = onHost || device()->failed(); },
        crossover.m_rungs, busy);
    // Hides these steps from the caller: their meshes' ids are given again.
    m_nextId = 0;
    m_statistics = StepStatistics();
    m_result = StepResult();
    if (!why && !device()->failed())
    {
        if (busy) crossover.m_rungs = leastTimes(crossover.m_rungs, before.m_rungs);
        crossover.m_busyStarts = busy ? before.m_busyStarts + 1 : 0;
        crossover.m_pairs = bestCrossover(crossover.m_rungs);
        m_report.m_crossoverSource = std::string("measured now") + (busy ? onBusy : "");
        cache.store(crossover);
    }
    else
    {
        m_report.m_crossoverSource = device()->failed() ? "" : why;
        if (!device()->failed()) m_error.m_call = m_openClDevice.m_name + " is not used: " + m_report.m_crossoverSource;
        crossover.m_pairs = std::numeric_limits<double>::infinity();
    }
    m_report.m_measureMs = watch.lapMs();
    return crossover.m_pairs;
}

bool Pipeline::Implementation::beginChoice(Pipeline& pipeline, Error& error)
{
    double pairs = -1;
    if (!wantedCrossover(m_settings, pairs, error)) return false;
    m_report.m_crossoverSource = "set";
    if (pairs < 0) pairs = findCrossover(pipeline);
    if (device()->failed()) return true;  // leaveDevice() has said so
    m_report.m_byCost = true;
    m_report.m_crossover = pairs;
    m_choice.begin(pairs);
    useChosen();
    return true;
}

void Pipeline::Implementation::useChosen()
{
    m_report.m_onHost = m_choice.isOnHost();
    m_report.m_expectedPairs = m_choice.pairs();
    m_report.m_device = DeviceInfo();
    m_report.m_device.m_name = "host";
    if (!m_report.m_onHost) m_report.m_device = m_openClDevice;
    const std::string source = " (" + m_report.m_crossoverSource + ")";
    const std::string work = "expected pairs of triangles: " + rounded(m_report.m_expectedPairs) + ", ";
    if (std::isinf(m_report.m_crossover))
        m_report.m_reason = work + "the host for any number, rather than " + m_openClDevice.m_name + source;
    else if (m_report.m_crossover == 0)
        m_report.m_reason = work + m_openClDevice.m_name + ", " + m_deviceReason + ", for any number" + source;
    else
        m_report.m_reason = work + "the host up to " + rounded(m_report.m_crossover) + ", else " +
                            m_openClDevice.m_name + ", " + m_deviceReason + source;
}

void Pipeline::Implementation::chooseBackend()
{
    if (!m_choice.active() || (m_pairs.empty() && m_selfCloths.empty())) return;
    if (m_pairs == m_notedPairs && m_selfCloths == m_notedSelf) return;
    m_notedPairs = m_pairs;
    m_notedSelf = m_selfCloths;
    const MeshPool& cloths = m_scene.m_cloths;
    const MeshPool& obstacles = m_scene.m_obstacles;
    const double reachOfThickness = 1 + double(m_settings.m_activation);
    for (const NamedPair& pair : m_pairs)
        m_choice.note(pair.m_cloth, pair.m_obstacle,
                      expectedPairs(surfaceOf(cloths.mesh(slotOf(cloths, pair.m_cloth))),
                                    surfaceOf(obstacles.mesh(slotOf(obstacles, pair.m_obstacle))),
                                    double(pair.m_thickness) * reachOfThickness));
    for (MeshId id : m_selfCloths)
    {
        const PooledMesh& cloth = cloths.mesh(slotOf(cloths, id));
        const Surface own = surfaceOf(cloth);
        m_choice.note(id, id,
                      kSelfPairWeight * expectedPairs(own, own, double(cloth.m_selfThickness) * reachOfThickness));
    }
    useChosen();
}

bool Pipeline::Implementation::mayStayOnHost() const
{
    const bool always = !m_choice.active() || std::isinf(m_report.m_crossover);
    if (!m_report.m_onHost || always) return m_report.m_onHost;
    const MeshPool& cloths = m_scene.m_cloths;
    const MeshPool& obstacles = m_scene.m_obstacles;
    double least = 0;
    for (std::size_t cloth = 0; cloth < cloths.meshCount() && least <= m_report.m_crossover; ++cloth)
    {
        const Surface own = surfaceOf(cloths.mesh(cloth));
        double most = cloths.mesh(cloth).m_selfThickness > 0.0f ? kSelfPairWeight * expectedPairs(own, own, 0) : 0;
        for (std::size_t obstacle = 0; obstacle < obstacles.meshCount(); ++obstacle)
            most = std::max(most, expectedPairs(own, surfaceOf(obstacles.mesh(obstacle)), 0));
        least += most;
    }
    return least <= m_report.m_crossover;
}
}  // namespace drape
