#include "tools/cloth_drop/built_in_child.h"

#include <cstdio>

#include "tools/cloth_drop/interruption.h"
#include "tools/cloth_drop/progress.h"
#include "tools/cloth_drop/runner.h"
#include "tools/cloth_drop/step_stream.h"

namespace drape
{
namespace
{
const char* modeName(BulletMode mode)
{
    return mode == BulletMode::Stock ? "stock" : mode == BulletMode::Tuned ? "tuned" : "vfss";
}

std::string exactText(double value)
{
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", value);
    return text;
}

// Returns the options of the scene: those of the drop, or those of a scene.
std::vector<std::string> sceneArguments(const Options& options)
{
    if (!options.m_scene.empty())
        return {"--scene=" + options.m_scene,     "--seed",   std::to_string(options.m_seed),  "--detail",
                std::to_string(options.m_detail), "--sheets", std::to_string(options.m_sheets)};
    std::vector<std::string> arguments = {
        "--obstacle=" + options.m_obstacle,  // which may begin with dashes
        "--obstacle-size",
        exactText(options.m_obstacleSize),
        "--cloth",
        std::to_string(options.m_clothColumns) + "x" + std::to_string(options.m_clothRows),
        "--cloth-size",
        exactText(options.m_clothSize),
        "--layers",
        std::to_string(options.m_layers),
        "--drop-height",
        exactText(options.m_dropHeight),
        "--drop-speed",
        exactText(options.m_dropSpeed),
        "--thickness",
        exactText(options.m_thickness)};
    if (options.m_self) arguments.emplace_back("--self");
    return arguments;
}

std::vector<std::string> childArguments(const Options& options, BulletMode mode)
{
    std::vector<std::string> arguments = sceneArguments(options);
    arguments.insert(arguments.begin(), "cloth_drop");
    for (const char* argument : {"--backend", "bullet", "--bullet-mode", modeName(mode), "--quiet", "--stream-steps"})
        arguments.emplace_back(argument);
    arguments.insert(arguments.end(), {"--steps", std::to_string(options.m_steps), "--dt", exactText(options.m_dt)});
    if (!options.m_picture.empty()) arguments.emplace_back("--stream-positions");
    if (options.records()) arguments.emplace_back("--stream-frames");
    return arguments;
}

void describe(RunRecord& record, BulletMode mode, const RunSubject& subject)
{
    record = recordOf(subject);
    record.m_backend = std::string("bullet (") + modeName(mode) + ")";
    record.m_device = "host";
    record.m_solver = "bullet";
    record.m_deviceReason = "Bullet's own collision runs on the host";
    record.m_lastPositions = subject.m_cloths.m_positions;
    record.m_recording.m_frameTime = subject.m_dt;
}
}  // namespace

bool runBuiltInChild(const Options& options, BulletMode mode, const ChildCap& cap, const RunPlan& plan,
                     RunRecord& record, std::string& error)
{
    describe(record, mode, plan.m_subject);
    Progress progress(record.m_backend, options.m_steps, options.m_quiet);
    const ChildEnd end = runCappedChild(
        childArguments(options, mode), cap,
        [&](int step, const std::string& line)
        {
            if (step > 0)
                record.m_steps.push_back(stepFromLine(line, record));
            else
                startFromLine(line, record.m_recording);
            progress.show(step);
        },
        [] { return interruption().empty(); });
    record.m_capped = end.m_capped;
    if (!end.m_error.empty()) error = record.m_backend + ": " + end.m_error;
    return error.empty();
}

void streamBuiltIn(const Options& options, const RunPlan& plan)
{
    const std::unique_ptr<Simulation> simulation = plan.m_makeBullet(options.m_bulletMode);
    streamRun(*simulation, plan.m_subject, options.m_steps, {}, options.m_streamPositions, options.m_streamFrames);
}
}  // namespace drape
