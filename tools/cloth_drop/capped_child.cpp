#include "tools/cloth_drop/capped_child.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace drape
{
namespace
{
constexpr int kNotRun = 127;  // exit code, as shells have it

// Runs in the new process, where only functions that are safe in a signal handler may be called. When the parent ends
// for any reason, the child ends too. Otherwise it could continue a step of minutes and notice only at its next write.
// If the parent ended before this request, the child already belongs to another process.
[[noreturn]] void becomeChild(pid_t parent, int output, char* const* arguments)
{
    // The last condition covers an end of the pipe that already is standard output, and would be closed.
    if (::prctl(PR_SET_PDEATHSIG, SIGKILL) == 0 && ::getppid() == parent && ::dup2(output, STDOUT_FILENO) >= 0 &&
        ::fcntl(STDOUT_FILENO, F_SETFD, 0) == 0)
        ::execve("/proc/self/exe", arguments, environ);
    ::_exit(kNotRun);
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
    const pid_t parent = ::getpid();
    child = ::fork();
    if (child == 0) becomeChild(parent, pipeEnds[1], pointers.data());
    const int code = errno;
    ::close(pipeEnds[1]);
    if (child > 0) return pipeEnds[0];
    ::close(pipeEnds[0]);
    errno = code;
    return -1;
}

constexpr double kLookSeconds = 0.1;  // interval between checks for an interruption while the child is silent

int waitMs(double seconds)
{
    return seconds > 0 ? static_cast<int>(std::min(seconds, kLookSeconds) * 1000) + 1 : 0;  // 0: what is there already
}

// Reads until the child's end (true), or until the cap or the caller ends it (false).
bool follow(int pipe, CappedLines& lines, const std::function<bool()>& goesOn)
{
    char buffer[65536];
    for (;;)
    {
        if (goesOn && !goesOn()) return false;
        // The child is not in a step: it is loading or measuring, which always ends.
        const double left = lines.running() ? lines.secondsLeft(CappedLines::Clock::now()) : kLookSeconds;
        pollfd waiting = {pipe, POLLIN, 0};
        const int ready = ::poll(&waiting, 1, waitMs(left));
        if (ready < 0 && errno != EINTR) return true;
        if (ready == 0 && left <= 0) return false;
        if (ready <= 0) continue;
        const ssize_t size = ::read(pipe, buffer, sizeof buffer);
        if (size < 0 && errno == EINTR) continue;
        if (size <= 0) return true;
        if (!lines.take(buffer, static_cast<std::size_t>(size))) return false;
    }
}

// Returns "" for a successful end.
std::string endProblem(int status, int step)
{
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return "";
    if (WIFEXITED(status) && WEXITSTATUS(status) == kNotRun) return "cannot start the child process";
    return "the child process ended in step " + std::to_string(step) +
           (WIFSIGNALED(status) ? std::string(": ") + ::strsignal(WTERMSIG(status)) : std::string());
}
}  // namespace

ChildEnd runCappedChild(std::vector<std::string> arguments, const ChildCap& cap, const CappedLines::OnLine& onLine,
                        const std::function<bool()>& goesOn)
{
    ChildEnd end;
    pid_t child = 0;
    const int pipe = spawnChild(arguments, child);
    if (pipe < 0)
    {
        end.m_error = std::string("cannot start the child process: ") + std::strerror(errno);
        return end;
    }
    CappedLines lines(cap, onLine);
    try
    {
        end.m_capped = !follow(pipe, lines, goesOn);
    }
    catch (const std::exception& exception)
    {
        end.m_error = std::string("the child process sent what cannot be read: ") + exception.what();
    }
    end.m_step = lines.step();
    // The signal may have ended the child already.
    if (end.m_error.empty() && goesOn && !goesOn()) end.m_capped = true;
    if (end.m_capped || !end.m_error.empty()) ::kill(child, SIGKILL);
    ::close(pipe);
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR)
    {
    }
    if (!end.m_capped && end.m_error.empty()) end.m_error = endProblem(status, end.m_step);
    return end;
}
}  // namespace drape
