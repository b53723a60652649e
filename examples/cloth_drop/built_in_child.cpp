#include "examples/cloth_drop/built_in_child.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "examples/cloth_drop/progress.h"
#include "examples/cloth_drop/runner.h"

extern char** environ;

namespace drape
{
namespace
{
using Json = nlohmann::json;
using Clock = std::chrono::steady_clock;

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
    return {"cloth_drop",
            "--obstacle",
            options.m_obstacle,
            "--obstacle-size",
            exactText(options.m_obstacleSize),
            "--cloth",
            std::to_string(options.m_clothColumns) + "x" + std::to_string(options.m_clothRows),
            "--cloth-size",
            exactText(options.m_clothSize),
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
}

// Starts the child with its standard output in a pipe; returns the reading end, or −1 with errno.
int spawnChild(const Options& options, BulletMode mode, pid_t& child)
{
    int pipeEnds[2];
    if (::pipe2(pipeEnds, O_CLOEXEC) != 0) return -1;
    std::vector<std::string> arguments = childArguments(options, mode);
    std::vector<char*> pointers;
    for (std::string& argument : arguments)
        pointers.push_back(&argument[0]);
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, pipeEnds[1], STDOUT_FILENO);
    const int code = posix_spawn(&child, "/proc/self/exe", &actions, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    ::close(pipeEnds[1]);
    if (code == 0) return pipeEnds[0];
    ::close(pipeEnds[0]);
    errno = code;
    return -1;
}

Json asLine(const StepRecord& step)
{
    return {{"times", {step.m_times.m_stepMs, step.m_times.m_collisionMs}},
            {"contacts", step.m_times.m_contacts},
            {"penetration", step.m_measure.m_penetrationMax},
            {"gap", step.m_measure.m_gapMin},
            {"depths", step.m_measure.m_nodeDepths},
            {"pairs", step.m_measure.m_intersectingPairs},
            {"invalid", step.m_measure.m_invalidNodes},
            {"hash", step.m_hash}};
}

StepRecord fromLine(const Json& line)
{
    StepRecord step;
    step.m_times.m_stepMs = line.at("times").at(0);
    step.m_times.m_collisionMs = line.at("times").at(1);
    step.m_times.m_contacts = line.at("contacts");
    step.m_measure.m_penetrationMax = line.at("penetration");
    step.m_measure.m_gapMin = line.at("gap").is_null() ? 0.0 : line.at("gap").get<double>();
    step.m_measure.m_nodeDepths = line.at("depths").get<std::vector<float>>();
    step.m_measure.m_intersectingPairs = line.at("pairs");
    step.m_measure.m_invalidNodes = line.at("invalid");
    step.m_hash = line.at("hash");
    return step;
}

// Follows the child's lines: "step" when a step begins, "stepped" when it is done, then what was measured, as JSON. The
// clock of the cap runs between the first two.
class ChildReader
{
public:
    ChildReader(int pipe, double capSeconds, Progress& progress, RunRecord& record)
        : m_pipe(pipe), m_capSeconds(capSeconds), m_progress(progress), m_record(record)
    {
    }

    // Reads until the child's end (true) or the cap (false).
    bool follow()
    {
        char buffer[65536];
        for (;;)
        {
            const double left = m_capSeconds - m_spent - (m_stepping ? secondsSince(m_stepStart) : 0);
            if (m_stepping && left <= 0) return false;
            pollfd waiting = {m_pipe, POLLIN, 0};
            // Not stepping: loading or measuring, which always ends.
            const int ready = ::poll(&waiting, 1, m_stepping ? static_cast<int>(left * 1000) + 1 : -1);
            if (ready < 0 && errno != EINTR) return true;
            if (ready <= 0) continue;
            const ssize_t size = ::read(m_pipe, buffer, sizeof buffer);
            if (size < 0 && errno == EINTR) continue;
            if (size <= 0) return true;
            m_text.append(buffer, static_cast<std::size_t>(size));
            takeLines();
        }
    }

    int step() const { return m_step; }

private:
    static double secondsSince(Clock::time_point start)
    {
        return std::chrono::duration<double>(Clock::now() - start).count();
    }

    void takeLines()
    {
        std::size_t start = 0;
        for (std::size_t end; (end = m_text.find('\n', start)) != std::string::npos; start = end + 1)
            takeLine(m_text.substr(start, end - start));
        m_text.erase(0, start);
    }

    void takeLine(const std::string& line)
    {
        if (line == "step")
        {
            m_stepping = true;
            m_stepStart = Clock::now();
            ++m_step;
            return;
        }
        if (line == "stepped")
        {
            m_stepping = false;
            m_spent += secondsSince(m_stepStart);
            return;
        }
        m_record.m_steps.push_back(fromLine(Json::parse(line)));
        m_progress.show(m_step);
    }

    int m_pipe;
    double m_capSeconds;
    Progress& m_progress;
    RunRecord& m_record;
    std::string m_text;
    bool m_stepping = false;
    Clock::time_point m_stepStart;
    double m_spent = 0;
    int m_step = 0;
};

void describe(RunRecord& record, BulletMode mode, const DropScene& scene)
{
    record.m_backend = std::string("bullet (") + modeName(mode) + ")";
    record.m_device = "host";
    record.m_deviceReason = "Bullet's built-in collision runs on the host";
    record.m_clothTriangles = scene.m_cloth.m_mesh.triangleCount();
    record.m_clothNodes = scene.m_cloth.m_mesh.vertexCount();
    record.m_obstacleTriangles = scene.m_obstacle.triangleCount();
    record.m_thickness = scene.m_thickness;
}
}  // namespace

bool runBuiltInChild(const Options& options, BulletMode mode, const DropScene& scene, RunRecord& record,
                     std::string& error)
{
    describe(record, mode, scene);
    pid_t child = 0;
    const int pipe = spawnChild(options, mode, child);
    if (pipe < 0)
    {
        error = std::string("cannot start the built-in run: ") + std::strerror(errno);
        return false;
    }
    Progress progress(record.m_backend, options.m_steps, options.m_quiet);
    ChildReader reader(pipe, options.m_compareCap, progress, record);
    bool ended = true;
    try
    {
        ended = reader.follow();
    }
    catch (const nlohmann::json::exception& exception)
    {
        error = std::string("the built-in run sent what cannot be read: ") + exception.what();
    }
    if (!ended || !error.empty()) ::kill(child, SIGKILL);
    ::close(pipe);
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR)
    {
    }
    if (!ended) record.m_cappedAtStep = reader.step();
    if (ended && error.empty() && !(WIFEXITED(status) && WEXITSTATUS(status) == kExitGood))
        error = record.m_backend + ": the built-in run ended in step " + std::to_string(reader.step()) +
                (WIFSIGNALED(status) ? std::string(": ") + ::strsignal(WTERMSIG(status)) : std::string());
    return error.empty();
}

void streamBuiltIn(const Options& options, const DropScene& scene)
{
    const std::unique_ptr<Simulation> simulation = makeBulletSimulation(scene, options.m_bulletMode);
    RunHooks hooks;
    bool good = true;
    const auto send = [&good](const std::string& line)
    {
        good = good && std::fputs((line + "\n").c_str(), stdout) >= 0 && std::fflush(stdout) == 0;
        if (!good) std::_Exit(kExitFailed);  // the parent is gone
    };
    hooks.m_beforeStep = [&](int) { send("step"); };
    hooks.m_stepped = [&](int) { send("stepped"); };
    hooks.m_afterStep = [&](int, const StepRecord& step) { send(asLine(step).dump()); };
    RunRecord record;
    TriangleMesh lastFrame;
    std::string error;
    const bool ran = runSimulation(*simulation, scene, options.m_steps, "", hooks, record, lastFrame, error);
    std::_Exit(ran ? kExitGood : kExitFailed);
}
}  // namespace drape
