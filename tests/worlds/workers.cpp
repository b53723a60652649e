#include "tests/worlds/workers.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <exception>

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

namespace drape::test
{
namespace
{
using Clock = std::chrono::steady_clock;

constexpr std::size_t kLargestChunk = 200;
constexpr int kPollMs = 200;

// The message is shorter than PIPE_BUF, so that a write puts all of it into the pipe, or nothing.
struct Message
{
    std::uint64_t m_world;
    WorldResult m_result;
};

struct Worker
{
    pid_t m_process = -1;
    int m_pipe = -1;
    std::size_t m_next = 0, m_last = 0;  // the world that it works on, and one past its chunk
    Clock::time_point m_since;           // when it began this world
    bool m_timedOut = false;
};

void sendResults(const std::vector<WorldSpec>& worlds, std::size_t first, std::size_t last, WorldBackend backend,
                 int pipe)
{
    for (std::size_t i = first; i < last; ++i)
    {
        const Message message{i, runWorld(worlds[i], backend)};
        if (write(pipe, &message, sizeof message) != static_cast<ssize_t>(sizeof message)) _exit(1);
    }
}

// Ends the process: nothing of the caller's may run in it.
[[noreturn]] void work(const std::vector<WorldSpec>& worlds, std::size_t first, std::size_t last, WorldBackend backend,
                       int pipe)
{
    try
    {
        sendResults(worlds, first, last, backend, pipe);
    }
    catch (const std::exception& error)
    {
        std::fprintf(stderr, "%s\n", error.what());
        _exit(1);
    }
    _exit(0);
}

class Workers
{
public:
    Workers(const std::vector<WorldSpec>& worlds, const WorkerOptions& options,
            const std::function<void(const WorldSpec&, const WorldResult&)>& done)
        : m_worlds(worlds),
          m_options(options),
          m_done(done),
          m_chunk(
              std::clamp<std::size_t>(worlds.size() / (4 * static_cast<std::size_t>(options.m_jobs)), 1, kLargestChunk))
    {
    }

    bool run()
    {
        while (m_dealt < m_worlds.size() || !m_workers.empty())
        {
            while (m_dealt < m_worlds.size() && m_workers.size() < static_cast<std::size_t>(m_options.m_jobs))
            {
                const std::size_t last = std::min(m_worlds.size(), m_dealt + m_chunk);
                if (!start(m_dealt, last)) return false;
                m_dealt = last;
            }
            if (!listen()) return false;
        }
        return true;
    }

private:
    bool start(std::size_t first, std::size_t last)
    {
        int ends[2];
        if (pipe(ends) != 0) return false;
        std::fflush(stdout);
        const pid_t process = fork();
        if (process == 0)
        {
            close(ends[0]);
            work(m_worlds, first, last, m_options.m_backend, ends[1]);
        }
        close(ends[1]);
        if (process < 0)
        {
            close(ends[0]);
            return false;
        }
        m_workers.push_back({process, ends[0], first, last, Clock::now(), false});
        return true;
    }

    // Waits for results, and ends workers that take too long. Returns false when a process does not start.
    bool listen()
    {
        std::vector<pollfd> pipes;
        for (const Worker& worker : m_workers)
            pipes.push_back({worker.m_pipe, POLLIN, 0});
        const int wait = static_cast<int>(std::min<double>(kPollMs, 1000 * m_options.m_timeout));
        if (poll(pipes.data(), pipes.size(), wait) < 0 && errno != EINTR) return false;
        std::vector<Worker> ended;
        for (std::size_t i = 0; i < pipes.size(); ++i)
        {
            Worker& worker = m_workers[i];
            if (pipes[i].revents != 0 && !receive(worker)) ended.push_back(worker);
            const std::chrono::duration<double> spent = Clock::now() - worker.m_since;
            if (spent.count() <= m_options.m_timeout || worker.m_timedOut) continue;
            worker.m_timedOut = true;
            kill(worker.m_process, SIGKILL);  // its pipe closes
        }
        for (const Worker& worker : ended)
            if (!finish(worker)) return false;
        return true;
    }

    // Returns false when the worker has closed its pipe.
    bool receive(Worker& worker)
    {
        Message message;
        const ssize_t count = read(worker.m_pipe, &message, sizeof message);
        if (count < 0 && errno == EINTR) return true;
        if (count != static_cast<ssize_t>(sizeof message)) return false;
        m_done(m_worlds[message.m_world], message.m_result);
        worker.m_next = message.m_world + 1;
        worker.m_since = Clock::now();
        return true;
    }

    // Gives the world at which a worker ended early its result, and starts a new worker for the rest of the chunk.
    bool finish(const Worker& worker)
    {
        int status = 0;
        waitpid(worker.m_process, &status, 0);
        close(worker.m_pipe);
        m_workers.erase(std::find_if(m_workers.begin(), m_workers.end(),
                                     [&](const Worker& other) { return other.m_process == worker.m_process; }));
        if (worker.m_next == worker.m_last) return true;
        WorldResult result;
        result.m_outcome = worker.m_timedOut ? Outcome::TimedOut : Outcome::Crashed;
        result.m_signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
        m_done(m_worlds[worker.m_next], result);
        return worker.m_next + 1 == worker.m_last || start(worker.m_next + 1, worker.m_last);
    }

    const std::vector<WorldSpec>& m_worlds;
    const WorkerOptions& m_options;
    const std::function<void(const WorldSpec&, const WorldResult&)>& m_done;
    const std::size_t m_chunk;
    std::size_t m_dealt = 0;
    std::vector<Worker> m_workers;
};
}  // namespace

bool runWorlds(const std::vector<WorldSpec>& worlds, const WorkerOptions& options,
               const std::function<void(const WorldSpec&, const WorldResult&)>& done)
{
    return Workers(worlds, options, done).run();
}
}  // namespace drape::test
