#include "examples/cloth_drop/capped_child.h"

#include <algorithm>
#include <cerrno>
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

int waitMs(double seconds)
{
    return seconds > 0 ? static_cast<int>(std::min(seconds, 1e6) * 1000) + 1 : 0;  // 0: what is there already
}

// Reads until the child's end (true) or the cap (false).
bool follow(int pipe, CappedLines& lines)
{
    char buffer[65536];
    for (;;)
    {
        const double left = lines.running() ? lines.secondsLeft(CappedLines::Clock::now()) : 0;
        pollfd waiting = {pipe, POLLIN, 0};
        // Not running: loading or measuring, which always ends.
        const int ready = ::poll(&waiting, 1, lines.running() ? waitMs(left) : -1);
        if (ready < 0 && errno != EINTR) return true;
        if (ready == 0 && left <= 0) return false;
        if (ready <= 0) continue;
        const ssize_t size = ::read(pipe, buffer, sizeof buffer);
        if (size < 0 && errno == EINTR) continue;
        if (size <= 0) return true;
        if (!lines.take(buffer, static_cast<std::size_t>(size))) return false;
    }
}
}  // namespace

ChildEnd runCappedChild(std::vector<std::string> arguments, const ChildCap& cap, const CappedLines::OnLine& onLine)
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
        end.m_capped = !follow(pipe, lines);
    }
    catch (const std::exception& exception)
    {
        end.m_error = std::string("the child process sent what cannot be read: ") + exception.what();
    }
    end.m_step = lines.step();
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
