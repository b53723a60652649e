#include "tools/cloth_drop/step_stream.h"

#include <cstdio>
#include <cstdlib>
#include <limits>

#include <nlohmann/json.hpp>

#include "tools/cloth_drop/capped_lines.h"
#include "tools/cloth_drop/options.h"
#include "tools/cloth_drop/recording_stream.h"
#include "tools/cloth_drop/runner.h"

namespace drape
{
namespace
{
using Json = nlohmann::json;

Json asLine(const StepRecord& step)
{
    return {{"times", {step.m_times.m_stepMs, step.m_times.m_collisionMs}},
            {"contacts", step.m_times.m_contacts},
            {"penetration", step.m_measure.m_penetrationMax},
            {"gap", step.m_measure.m_gapMin},
            {"depths", step.m_measure.m_nodeDepths},
            {"through", step.m_nodesThrough},
            {"self", step.m_selfPairs},
            {"pairs", step.m_measure.m_intersectingPairs},
            {"invalid", step.m_measure.m_invalidNodes},
            {"speed", step.m_speed},
            {"stretch", {step.m_stretch.m_mean, step.m_stretch.m_max}},
            {"hash", step.m_hash}};
}

// JSON has null for numbers that are not finite.
double numberOf(const Json& value)
{
    return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}
}  // namespace

StepRecord stepFromLine(const std::string& text)
{
    RunRecord record;
    return stepFromLine(text, record);
}

void startFromLine(const std::string& text, Recording& recording)
{
    const Json line = Json::parse(text);
    takeBodies(line.at("bodies"), recording);
    takeFrame(line.at("frame"), recording);
}

StepRecord stepFromLine(const std::string& text, RunRecord& record)
{
    const Json line = Json::parse(text);
    const auto given = line.find("positions");
    if (given != line.end())
    {
        record.m_lastPositions.clear();
        for (const Json& coordinate : *given)
            record.m_lastPositions.push_back(static_cast<float>(numberOf(coordinate)));
    }
    if (line.contains("frame")) takeFrame(line.at("frame"), record.m_recording);
    StepRecord step;
    step.m_times.m_stepMs = line.at("times").at(0);
    step.m_times.m_collisionMs = line.at("times").at(1);
    step.m_times.m_contacts = line.at("contacts");
    step.m_measure.m_penetrationMax = line.at("penetration");
    step.m_measure.m_gapMin = line.at("gap").is_null() ? 0.0 : line.at("gap").get<double>();
    step.m_measure.m_nodeDepths = line.at("depths").get<std::vector<float>>();
    step.m_nodesThrough = line.at("through");
    step.m_selfPairs = line.at("self");
    step.m_measure.m_intersectingPairs = line.at("pairs");
    step.m_measure.m_invalidNodes = line.at("invalid");
    step.m_speed = line.at("speed").is_null() ? 0.0 : line.at("speed").get<double>();
    step.m_stretch = {numberOf(line.at("stretch").at(0)), numberOf(line.at("stretch").at(1))};
    step.m_hash = line.at("hash");
    return step;
}

void streamRun(Simulation& simulation, const RunSubject& subject, int steps,
               const std::function<std::string()>& lastLine, bool positions, bool frames)
{
    RunHooks hooks;
    bool good = true;
    const auto send = [&good](const std::string& line)
    {
        good = good && std::fputs((line + "\n").c_str(), stdout) >= 0 && std::fflush(stdout) == 0;
        if (!good) std::_Exit(kExitFailed);  // the parent is gone
    };
    hooks.m_beforeStep = [&](int) { send(stepLine()); };
    hooks.m_stepped = [&](int) { send(steppedLine()); };
    Json frame;
    hooks.m_records = frames;
    hooks.m_recorded = [&](const Recording& recording)
    {
        frame = asFrame(recording);
        if (recording.m_frameCount == 1) send(Json{{"bodies", asBodies(recording)}, {"frame", frame}}.dump());
    };
    hooks.m_afterStep = [&](int, const StepRecord& step)
    {
        send(measuredLine());
        Json line = asLine(step);
        if (positions) line["positions"] = simulation.positions();
        if (frames) line["frame"] = std::move(frame);
        send(line.dump());
    };
    RunRecord record;
    std::string error;
    const bool ran = runSimulation(simulation, subject, steps, "", hooks, record, error);
    if (ran && lastLine) send(lastLine());
    std::_Exit(ran ? kExitGood : kExitFailed);
}
}  // namespace drape
