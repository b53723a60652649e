#include "tools/cloth_drop/runner.h"

#include <utility>

#include "drape/recorder.h"
#include "oracle/crossings.h"
#include "oracle/self_intersections.h"
#include "scenes/mesh_writer.h"

namespace drape
{
namespace
{
RunRecord startRecord(const Simulation& simulation, const DropScene& scene, const TriangleMesh& sheets)
{
    RunRecord record;
    record.m_prepareMs = simulation.prepareMs();
    record.m_clothTriangles = sheets.triangleCount();
    record.m_clothNodes = sheets.vertexCount();
    record.m_obstacleTriangles = scene.m_obstacle.triangleCount();
    record.m_thickness = scene.m_thickness;
    record.m_countsClothPairs = countsClothPairs(scene);
    return record;
}

// Records the start and every step, if that is asked for.
class RunRecorder
{
public:
    RunRecorder(Simulation& simulation, const DropScene& scene, const RunHooks& hooks)
        : m_simulation(simulation), m_hooks(hooks)
    {
        RecorderSettings settings;
        settings.m_frameTime = scene.m_dt;
        if (hooks.m_records) m_recorder = std::make_unique<Recorder>(simulation.world(), settings);
        record();
    }

    void record()
    {
        if (!m_recorder) return;
        m_recorder->record();
        m_simulation.addContacts(*m_recorder);
        if (m_hooks.m_recorded) m_hooks.m_recorded(m_recorder->recording());
    }

    Recording take() { return m_recorder ? std::move(m_recorder->recording()) : Recording(); }

private:
    Simulation& m_simulation;
    const RunHooks& m_hooks;
    std::unique_ptr<Recorder> m_recorder;
};
}  // namespace

bool runSimulation(Simulation& simulation, const DropScene& scene, int steps, const std::string& framesFolder,
                   const RunHooks& hooks, RunRecord& record, std::string& error)
{
    const TriangleMesh sheets = sheetsOf(scene);
    record = startRecord(simulation, scene, sheets);
    TriangleMesh lastFrame = sheets;
    PenetrationMeter meter(scene.m_obstacle, sheets);
    Crossings crossings(scene.m_obstacle, sheets.m_positions);
    SelfIntersections self(sheets);
    const StretchMeter stretch(sheets);
    std::uint64_t hash = kHashStart;
    RunRecorder recorder(simulation, scene, hooks);
    const bool frames = !framesFolder.empty();
    if (frames && !(writeMesh(framesFolder + "/obstacle.ply", scene.m_obstacle, error) &&
                    writeMesh(frameName(framesFolder, "cloth", 0), lastFrame, error)))
        return false;
    for (int number = 1; number <= steps; ++number)
    {
        if (hooks.m_beforeStep) hooks.m_beforeStep(number);
        StepRecord step;
        step.m_times = simulation.step();
        if (hooks.m_stepped) hooks.m_stepped(number);
        const std::vector<float>& positions = simulation.positions();
        step.m_speed = rmsSpeed(lastFrame.m_positions, positions, scene.m_dt);
        lastFrame.m_positions = positions;
        step.m_measure = meter.measure(lastFrame.m_positions.data());
        if (record.m_countsClothPairs) step.m_selfPairs = self.find(positions).size();
        step.m_stretch = stretch.measure(positions);
        crossings.follow(positions);
        step.m_nodesThrough = crossings.nodes();
        step.m_hash = hash = hashFloats(hash, lastFrame.m_positions);
        recorder.record();
        if (hooks.m_afterStep) hooks.m_afterStep(number, step);
        record.m_steps.push_back(std::move(step));
        const bool written = !frames || writeMesh(frameName(framesFolder, "cloth", number), lastFrame, error);
        if (written && (number == steps || !hooks.m_goesOn || hooks.m_goesOn())) continue;
        record.m_capped = true;
        break;
    }
    // With the automatic choice only the steps show which back end ran.
    record.m_backend = simulation.backend();
    record.m_solver = simulation.solver();
    record.m_device = simulation.device();
    record.m_deviceReason = simulation.deviceReason();
    record.m_trouble = simulation.trouble();
    record.m_lastPositions = std::move(lastFrame.m_positions);
    record.m_recording = recorder.take();
    return error.empty();
}
}  // namespace drape
