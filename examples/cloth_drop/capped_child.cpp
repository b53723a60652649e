#include "examples/cloth_drop/capped_child.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <exception>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace drape
{
namespace
{
using Clock = std::chrono::steady_clock;
using OnLine = std::function<void(int, const std::string&)>;

constexpr char kStep[] = "step ", kStepped[] = "stepped ";

// A system's processes share this clock. ns.
std::string withTime(const char* word)
{
    return word + std::to_string(std::chrono::nanoseconds(Clock::now().time_since_epoch()).count());
}

bool readTime(const std::string& line, const char* word, Clock::time_point& time)
{
    const std::size_t length = std::strlen(word);
    if (line.compare(0, length, word) != 0) return false;
    time = Clock::time_point(std::chrono::nanoseconds(std::stoll(line.substr(length))));
    return true;
}

// Starts the child with its standard output in a pipe; returns the reading end, or −1 with errno.
int spawnChild(std::vector<std::string>& arguments, pid_t& child)
{
    int pipeEnds[2];
    if (::pipe2(pipeEnds, O_CLOEXEC) != 0) return -1;
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

// The clock of the cap runs between a step's two lines, or from the first step's on.
class ChildReader
{
public:
    ChildReader(int pipe, const ChildCap& cap, const OnLine& onLine) : m_pipe(pipe), m_cap(cap), m_onLine(onLine) {}

    // Reads until the child's end (true) or the cap (false).
    bool follow()
    {
        char buffer[65536];
        for (;;)
        {
            const double left = m_running ? secondsLeft(Clock::now()) : 0;
            pollfd waiting = {m_pipe, POLLIN, 0};
            // Not running: loading or measuring, which always ends.
            const int ready = ::poll(&waiting, 1, m_running ? waitMs(left) : -1);
            if (ready < 0 && errno != EINTR) return true;
            if (ready == 0 && m_running && left <= 0) return false;
            if (ready <= 0) continue;
            const ssize_t size = ::read(m_pipe, buffer, sizeof buffer);
            if (size < 0 && errno == EINTR) continue;
            if (size <= 0) return true;
            m_text.append(buffer, static_cast<std::size_t>(size));
            if (!takeLines()) return false;
        }
    }

    int step() const { return m_step; }

private:
    // In a step, at `time`.
    double secondsLeft(Clock::time_point time) const
    {
        return m_cap.m_seconds - m_spent - std::chrono::duration<double>(time - m_start).count();
    }

    static int waitMs(double seconds)
    {
        return seconds > 0 ? static_cast<int>(std::min(seconds, 1e6) * 1000) + 1 : 0;  // 0: what is there already
    }

    // False: the cap.
    bool takeLines()
    {
        std::size_t start = 0;
        for (std::size_t end; (end = m_text.find('\n', start)) != std::string::npos; start = end + 1)
            if (!takeLine(m_text.substr(start, end - start))) return false;
        m_text.erase(0, start);
        return true;
    }

    bool takeLine(const std::string& line)
    {
        Clock::time_point time;
        if (readTime(line, kStep, time))
        {
            if (m_running && secondsLeft(time) <= 0) return false;
            ++m_step;
            if (!m_running) m_start = time;
            m_running = true;
        }
        else if (readTime(line, kStepped, time))
        {
            const double left = secondsLeft(time);
            if (left <= 0) return false;
            if (m_cap.m_measuring) return true;
            m_running = false;
            m_spent = m_cap.m_seconds - left;
        }
        else
            m_onLine(m_step, line);
        return true;
    }

    int m_pipe;
    ChildCap m_cap;
    const OnLine& m_onLine;
    std::string m_text;
    bool m_running = false;
    Clock::time_point m_start;
    double m_spent = 0;
    int m_step = 0;
};
}  // namespace

std::string stepLine()
{
    return withTime(kStep);
}

std::string steppedLine()
{
    return withTime(kStepped);
}

ChildEnd runCappedChild(std::vector<std::string> arguments, const ChildCap& cap, const OnLine& onLine)
{
    ChildEnd end;
    pid_t child = 0;
    const int pipe = spawnChild(arguments, child);
    if (pipe < 0)
    {
        end.m_error = std::string("cannot start the child process: ") + std::strerror(errno);
        return end;
    }
    ChildReader reader(pipe, cap, onLine);
    try
    {
        end.m_capped = !reader.follow();
    }
    catch (const std::exception& exception)
    {
        end.m_error = std::string("the child process sent what cannot be read: ") + exception.what();
    }
    end.m_step = reader.step();
    if (end.m_capped || !end.m_error.empty()) ::kill(child, SIGKILL);
    ::close(pipe);
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR)
    {
    }
    const bool good = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    if (!end.m_capped && end.m_error.empty() && !good)
        end.m_error = "the child process ended in step " + std::to_string(end.m_step) +
                      (WIFSIGNALED(status) ? std::string(": ") + ::strsignal(WTERMSIG(status)) : std::string());
    return end;
}
}  // namespace drape
