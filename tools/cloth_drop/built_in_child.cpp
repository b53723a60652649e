#include "tools/cloth_drop/built_in_child.h"

#include <cstdio>

#include "tools/cloth_drop/interruption.h"
#include "tools/cloth_drop/progress.h"
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

std::vector<std::string> childArguments(const Options& options, BulletMode mode)
{
    std::vector<std::string> arguments = {
        "cloth_drop",
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
        "--steps",
        std::to_string(options.m_steps),
        "--dt",
        exactText(options.m_dt),
        "--thickness",
        exactText(options.m_thickness),
        "--backend",
        "bullet",
        "--bullet-mode",
        modeName(mode),
        "--quiet",
        "--stream-steps"};
    if (options.m_self) arguments.emplace_back("--self");
    if (!options.m_picture.empty()) arguments.emplace_back("--stream-positions");
    if (options.records()) arguments.emplace_back("--stream-frames");
    return arguments;
}

void describe(RunRecord& record, BulletMode mode, const DropScene& scene)
{
    record.m_backend = std::string("bullet (") + modeName(mode) + ")";
    record.m_device = "host";
    record.m_solver = "bullet";
    record.m_deviceReason = "Bullet's own collision runs on the host";
    const TriangleMesh sheets = sheetsOf(scene);
    record.m_countsClothPairs = countsClothPairs(scene);
    record.m_clothTriangles = sheets.triangleCount();
    record.m_clothNodes = sheets.vertexCount();
    record.m_obstacleTriangles = scene.m_obstacle.triangleCount();
    record.m_thickness = scene.m_thickness;
    record.m_lastPositions = sheets.m_positions;
    record.m_recording.m_frameTime = scene.m_dt;
}
}  // namespace

bool runBuiltInChild(const Options& options, BulletMode mode, const ChildCap& cap, const DropScene& scene,
                     RunRecord& record, std::string& error)
{
    describe(record, mode, scene);
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

void streamBuiltIn(const Options& options, const DropScene& scene)
{
    const std::unique_ptr<Simulation> simulation = makeBulletSimulation(scene, options.m_bulletMode);
    streamRun(*simulation, scene, options.m_steps, {}, options.m_streamPositions, options.m_streamFrames);
}
}  // namespace drape
