// Runs many worlds in processes of their own, so that a crash or an endless step is a result and not the end.
//
// Worlds are dealt out in chunks, a process a chunk, at most `jobs` at a time. When a world crashes or takes too long
// its process ends, and a new one goes on with the world after it. Uses fork() and pipes of POSIX. The caller must have
// no thread and no OpenCL device of its own.
#pragma once

#include <functional>
#include <vector>

#include "tests/worlds/run_world.h"

namespace drape::test
{
struct WorkerOptions
{
    WorldBackend m_backend = WorldBackend::Host;
    int m_jobs = 1;
    double m_timeout = 60;  // s, for one world
};

// Calls done(world, result) for every world, in the order in which they end. Returns false when no process starts.
bool runWorlds(const std::vector<WorldSpec>& worlds, const WorkerOptions& options,
               const std::function<void(const WorldSpec&, const WorldResult&)>& done);
}  // namespace drape::test
