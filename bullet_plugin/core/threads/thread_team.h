// A few threads that share short jobs with the thread that calls.
//
// Job: run a function once for each of some items, on whichever thread is free. Each thread begins with a stretch of
// the items of its own, the same one in every job of as many items, so that what an item works on tends to be in its
// core's cache; then it helps with those of others. Items are claimed one by one, never assigned: a thread that the
// system does not run in time finds nothing left, and the caller does all of it where no other comes. Only one that
// loses its core within an item makes the caller wait. So what a job computes must not depend on who runs it, nor on
// the order of its items; all threads round as the caller does.
//
// Threads are started by the first job that has more than one item. They keep off the core that the caller runs on:
// Linux would wake them there and, on a virtual machine, leave them there, one behind the other. They take no signals.
// Cost: about a microsecond a job while they are awake. They look for the next job for kAwakeMicroseconds, then sleep;
// waking one of them, which wakes two others, takes the caller 5 to 50.
//
// Errors: what an item throws is thrown to the caller once all that were begun have ended; items that were not begun
// are left out then. Where threads cannot be started there are fewer. run() belongs to one thread at a time, and no
// item calls it. A child that fork() makes has none of the threads, and must not use the team.
#pragma once

#include <atomic>
#include <cfenv>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace drape
{
class ThreadTeam
{
public:
    // Longer than a solver's iterations between two jobs of a cloth of some thousand triangles.
    static constexpr int kAwakeMicroseconds = 200;
    // By default: what more of them save is lost again where the caller reads what they wrote.
    static constexpr unsigned kMostByDefault = 8;

    // threads: the caller's among them. 0: as many as the process may use cores, kMostByDefault at most.
    explicit ThreadTeam(unsigned threads);
    // How many that are.
    static unsigned sizeFor(unsigned threads);
    ~ThreadTeam();
    ThreadTeam(const ThreadTeam&) = delete;
    ThreadTeam& operator=(const ThreadTeam&) = delete;

    unsigned size() const { return m_size; }

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

    // A thread's own items, in a line of the cache of its own.
    struct alignas(64) Stretch
    {
        // The job's number, and below it how many items nobody has claimed.
        std::atomic<std::uint64_t> m_claim{0};
        std::size_t m_end = 0;  // behind the last item; written as m_call is
    };

    void share(std::size_t count, Call call, const void* context);
    void start();
    void keepOffCallersCore();
    void work(unsigned thread);
    void workOn(unsigned thread);
    bool workOnce(Stretch& stretch, bool helps);
    void runItem(std::size_t item);
    bool awaitJob(std::uint32_t done);
    void wakeOne();

    const unsigned m_size;
    std::vector<std::thread> m_threads;
    bool m_started = false;
    int m_callersCore = -1;  // the threads keep off it

    // Written before the items are offered, and not again before all of them are done.
    Call m_call = nullptr;
    const void* m_context = nullptr;
    std::fenv_t m_environment;  // the caller's way to round and to treat subnormals, for whoever helps

    std::unique_ptr<Stretch[]> m_stretches;  // by thread, the caller's first
    std::atomic<std::uint32_t> m_job{0};     // number of the last one offered
    std::atomic<std::size_t> m_unfinished{0};
    std::atomic<bool> m_failed{false};
    std::exception_ptr m_failure;  // of the item that failed first

    std::mutex m_mutex;
    std::condition_variable m_offered;
    std::atomic<unsigned> m_sleepers{0};
    std::atomic<bool> m_ends{false};
};

// The same, by the caller alone where it is not worth waking others.
template <class Job>
void runShared(ThreadTeam& threads, bool worth, std::size_t count, const Job& job)
{
    if (worth) return threads.run(count, job);
    for (std::size_t item = 0; item < count; ++item)
        job(item);
}
}  // namespace drape
