// A few threads that share short jobs with the calling thread.
//
// Job: run a function once per item, on any free thread. Each thread begins with its own range of the items, so that
// their data tends to be in its core's cache, then helps with other ranges. Items are claimed one by one: a late
// thread delays the caller only if it loses its core within an item. Results must not depend on the thread or the
// order. All threads round as the caller does.
//
// With a job system of the app's, its function runs one job for each thread of the team; each job claims items in the
// same way, and the caller claims what they leave.
//
// Errors: an item's exception reaches the caller once all begun items have ended; the rest are skipped. run() belongs
// to one thread at a time, and no item calls it. A child made by fork() must not use the team.
//
// Cost: about a microsecond per job while threads are awake. Details: docs/design_notes/threads.md.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "bullet_plugin/core/platform/float_state.h"
#include "drape/settings.h"

namespace drape
{
class ThreadTeam
{
public:
    // Time awake: longer than a solver's iterations between two jobs of a cloth of some thousand triangles.
    static constexpr int kAwakeMicroseconds = 200;
    // Default maximum: the time saved by more threads is lost again where the caller reads their output.
    static constexpr unsigned kMostByDefault = 8;

    // threads: includes the caller. 0: one per core that the process may use, at most kMostByDefault.
    // parallelFor: the app's job system (Settings::m_parallelFor); the team starts no threads then.
    explicit ThreadTeam(unsigned threads, ParallelFor parallelFor = nullptr);
    // Returns the team's size for the setting.
    static unsigned sizeFor(unsigned threads);
    ~ThreadTeam();
    ThreadTeam(const ThreadTeam&) = delete;
    ThreadTeam& operator=(const ThreadTeam&) = delete;

    unsigned size() const { return m_size; }
    // Returns whether a call of the app's job system has thrown.
    bool appFailed() const { return m_appFailed; }

    // Calls job(i) for every i below count, in any order and on any thread of the team. Returns when all have returned.
    template <class Job>
    void run(std::size_t count, const Job& job)
    {
        const auto call = [](const void* context, std::size_t item) { (*static_cast<const Job*>(context))(item); };
        if (m_size == 1 || count < 2)
        {
            for (std::size_t item = 0; item < count; ++item)
                job(item);
            return;
        }
        share(count, call, &job);
    }

private:
    using Call = void (*)(const void* context, std::size_t item);

    // A thread's own items, in its own cache line.
    struct alignas(64) Stretch
    {
        // The job's number, and in the bits below it the number of unclaimed items.
        std::atomic<std::uint64_t> m_claim{0};
        std::size_t m_end = 0;  // end of the items; written like m_call
    };

    void share(std::size_t count, Call call, const void* context);
    void start();
    void handToApp();
    void workForApp(std::size_t thread);
    void keepOffCallersCore();
    void work(unsigned thread);
    void workOn(unsigned thread, bool helps);
    bool workOnce(Stretch& stretch, bool helps);
    void runItem(std::size_t item);
    bool awaitJob(std::uint32_t done);
    void wakeOne();

    const unsigned m_size;
    const ParallelFor m_parallelFor;
    const std::function<void(std::size_t)> m_appJob = [this](std::size_t thread) { workForApp(thread); };
    std::vector<std::thread> m_threads;
    bool m_started = false;
    bool m_appFailed = false;
    int m_callersCore = -1;  // the threads keep off it

    // Written before the items are offered, and unchanged until all of them are done.
    Call m_call = nullptr;
    const void* m_context = nullptr;
    FloatState m_environment;  // the caller's rounding mode and treatment of subnormals, for every helper

    std::unique_ptr<Stretch[]> m_stretches;  // by thread, the caller's first
    std::atomic<std::uint32_t> m_job{0};     // number of the last one offered
    std::atomic<std::size_t> m_unfinished{0};
    std::atomic<bool> m_failed{false};
    std::exception_ptr m_failure;  // exception of the item that failed first

    std::mutex m_mutex;
    std::condition_variable m_offered;
    std::atomic<unsigned> m_sleepers{0};
    std::atomic<bool> m_ends{false};
};

// Does the same, on the caller alone if waking other threads is not worth it.
template <class Job>
void runShared(ThreadTeam& threads, bool worth, std::size_t count, const Job& job)
{
    if (worth) return threads.run(count, job);
    for (std::size_t item = 0; item < count; ++item)
        job(item);
}
}  // namespace drape
