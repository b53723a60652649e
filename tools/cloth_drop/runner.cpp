#include "tools/cloth_drop/runner.h"

#include <utility>

#include "drape/recorder.h"
#include "oracle/self_intersections.h"
#include "scenes/mesh_writer.h"
#include "tools/cloth_drop/obstacle_checks.h"

namespace drape
{
namespace
{
RunRecord startRecord(const Simulation& simulation, const RunSubject& subject)
{
    RunRecord record = recordOf(subject);
    record.m_prepareMs = simulation.prepareMs();
    return record;
}

// Keeps the obstacles' frames of each recorded frame, or of the last one.
void keepObstacles(const Simulation& simulation, bool all, RunRecord& record)
{
    if (!all) record.m_obstacles.clear();
    record.m_obstacles.push_back(simulation.obstacleFrames());
}

bool writeObstacles(const RunSubject& subject, const RunRecord& record, const std::string& folder, int number,
                    std::string& error)
{
    return !subject.m_obstaclesMove ||
           writeMesh(frameName(folder, "obstacle", number), subject.shown(record.m_obstacles.back()), error);
}

// Records the start and every step, if that is asked for.
class RunRecorder
{
public:
    RunRecorder(Simulation& simulation, double dt, const RunHooks& hooks) : m_simulation(simulation), m_hooks(hooks)
    {
        RecorderSettings settings;
        settings.m_frameTime = dt;
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

RunRecord recordOf(const RunSubject& subject)
{
    RunRecord record;
    record.m_clothTriangles = subject.m_cloths.triangleCount();
    record.m_clothNodes = subject.m_cloths.vertexCount();
    record.m_obstacleTriangles = subject.obstacleTriangles();
    record.m_thickness = subject.m_thickness;
    record.m_countsClothPairs = subject.m_countsClothPairs;
    record.m_obstacles = {subject.m_starts};
    return record;
}

bool runSimulation(Simulation& simulation, const RunSubject& subject, int steps, const std::string& framesFolder,
                   const RunHooks& hooks, RunRecord& record, std::string& error)
{
    record = startRecord(simulation, subject);
    TriangleMesh lastFrame = subject.m_cloths;
    ObstacleChecks checks(subject);
    SelfIntersections self(lastFrame);
    const StretchMeter stretch({subject.m_rest, lastFrame.m_triangles}, subject.m_lines);
    std::uint64_t hash = kHashStart;
    RunRecorder recorder(simulation, subject.m_dt, hooks);
    const bool frames = !framesFolder.empty();
    if (frames && !(writeMesh(framesFolder + "/obstacle.ply", subject.shown(subject.m_starts), error) &&
                    writeMesh(frameName(framesFolder, "cloth", 0), lastFrame, error, subject.m_lines)))
        return false;
    for (int number = 1; number <= steps; ++number)
    {
        if (hooks.m_beforeStep) hooks.m_beforeStep(number);
        StepRecord step;
        step.m_times = simulation.step();
        if (hooks.m_stepped) hooks.m_stepped(number);
        const std::vector<float>& positions = simulation.positions();
        step.m_speed = rmsSpeed(lastFrame.m_positions, positions, subject.m_dt);
        lastFrame.m_positions = positions;
        keepObstacles(simulation, hooks.m_records, record);
        step.m_measure = checks.measure(lastFrame.m_positions, record.m_obstacles.back());
        if (record.m_countsClothPairs) step.m_selfPairs = self.find(positions).size();
        step.m_stretch = stretch.measure(positions);
        step.m_nodesThrough = checks.nodesThrough();
        step.m_hash = hash = hashFloats(hash, lastFrame.m_positions);
        recorder.record();
        if (hooks.m_afterStep) hooks.m_afterStep(number, step);
        record.m_steps.push_back(std::move(step));
        const bool written =
            !frames || (writeMesh(frameName(framesFolder, "cloth", number), lastFrame, error, subject.m_lines) &&
                        writeObstacles(subject, record, framesFolder, number, error));
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
