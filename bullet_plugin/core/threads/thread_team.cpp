#include "thread_team.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <exception>
#include <limits>
#include <utility>

#include "bullet_plugin/core/float_environment.h"
#include "bullet_plugin/core/platform/compiler.h"
#include "bullet_plugin/core/platform/platform.h"

namespace drape
{
namespace
{
// Number of polls between two that yield the core to a waiting thread.
constexpr int kLooksTogether = 64;
}  // namespace

unsigned ThreadTeam::sizeFor(unsigned threads)
{
    return threads > 0 ? threads : std::min(availableCores(), kMostByDefault);
}

ThreadTeam::ThreadTeam(unsigned threads, ParallelFor parallelFor)
    : m_size(sizeFor(threads)), m_parallelFor(std::move(parallelFor)), m_stretches(new Stretch[m_size])
{
}

ThreadTeam::~ThreadTeam()
{
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        m_ends = true;
    }
    m_offered.notify_all();
    for (std::thread& thread : m_threads)
        thread.join();
}

// Continues with fewer threads than wanted, which take longer.
void ThreadTeam::start()
{
    if (m_started) return;
    m_started = true;
    const BlockedSignals blocked;
    try
    {
        m_threads.reserve(m_size - 1);
        while (m_threads.size() + 1 < m_size)
            m_threads.emplace_back(&ThreadTeam::work, this, static_cast<unsigned>(m_threads.size()) + 1);
    }
    catch (const std::exception&)
    {
    }
}

// Moves the threads to other cores, as far as the process may use them; otherwise they run anywhere.
void ThreadTeam::keepOffCallersCore()
{
    const int core = currentCore();
    if (core < 0 || core == m_callersCore) return;
    m_callersCore = core;
    keepOffCore(m_threads.data(), m_threads.size(), core);
}

void ThreadTeam::share(std::size_t count, Call call, const void* context)
{
    if (!m_parallelFor)
    {
        start();
        keepOffCallersCore();
    }
    m_call = call;
    m_context = context;
    saveFloatState(m_environment);
    m_unfinished.store(count, std::memory_order_relaxed);
    assert(count <= std::numeric_limits<std::uint32_t>::max());
    const std::uint32_t job = m_job.load(std::memory_order_relaxed) + 1;
    for (std::size_t thread = 0, first = 0; thread < m_size; ++thread)
    {
        Stretch& stretch = m_stretches[thread];
        stretch.m_end = (thread + 1) * count / m_size;
        stretch.m_claim.store(std::uint64_t(job) << 32 | (stretch.m_end - first), std::memory_order_release);
        first = stretch.m_end;
    }
    m_job.store(job);
    if (m_parallelFor)
        handToApp();
    else
        wakeOne();
    workOn(0, false);
    for (int looks = 1; m_unfinished.load(std::memory_order_acquire) > 0; ++looks)
    {
        if (looks % kLooksTogether == 0)
            std::this_thread::yield();
        else
            pauseCore();
    }
    if (!m_failed.load(std::memory_order_relaxed)) return;
    m_failed = false;
    std::rethrow_exception(std::exchange(m_failure, nullptr));
}

// Runs the app's function in the app's floating-point environment: it may run other jobs on this thread meanwhile.
void ThreadTeam::handToApp()
{
    const CallersFloats floats;
    try
    {
        m_parallelFor(m_size, m_appJob);
    }
    catch (...)
    {
        m_appFailed = true;  // the caller claims what is left
    }
}

// Runs on any thread, perhaps after others have claimed everything.
void ThreadTeam::workForApp(std::size_t thread)
{
    FloatState apps;
    saveFloatState(apps);
    workOn(static_cast<unsigned>(thread % m_size), true);
    restoreFloatState(apps);
}

// Wakes one sleeping thread, which then wakes two others: waking takes the caller up to 50 us on a virtual machine.
// Either this call sees a thread that is about to sleep, or the thread sees the job: both store before they load.
void ThreadTeam::wakeOne()
{
    if (m_sleepers.load() == 0) return;
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
    }
    m_offered.notify_one();
}

void ThreadTeam::workOn(unsigned thread, bool helps)
{
    for (unsigned i = 0; i < m_size; ++i)
        while (workOnce(m_stretches[(thread + i) % m_size], helps))
        {
        }
}

// Claims an item and runs it; returns false if none is left. The caller's data of the job is read only after the
// claim: until that item is finished, the caller cannot write another job's.
bool ThreadTeam::workOnce(Stretch& stretch, bool helps)
{
    std::uint64_t claim = stretch.m_claim.load(std::memory_order_acquire);
    do
    {
        if (static_cast<std::uint32_t>(claim) == 0) return false;
    } while (!stretch.m_claim.compare_exchange_weak(claim, claim - 1, std::memory_order_acquire));
    if (helps) restoreFloatState(m_environment);
    runItem(stretch.m_end - static_cast<std::uint32_t>(claim));
    m_unfinished.fetch_sub(1, std::memory_order_release);
    return true;
}

void ThreadTeam::runItem(std::size_t item)
{
    if (m_failed.load(std::memory_order_relaxed)) return;
    try
    {
        m_call(m_context, item);
    }
    catch (...)
    {
        if (!m_failed.exchange(true)) m_failure = std::current_exception();
    }
}

void ThreadTeam::work(unsigned thread)
{
    std::uint32_t done = 0;
    while (awaitJob(done))
    {
        done = m_job.load();
        workOn(thread, true);
    }
}

// Waits for another job than the last one; returns false when the team ends.
bool ThreadTeam::awaitJob(std::uint32_t done)
{
    using Clock = std::chrono::steady_clock;
    const Clock::time_point sleepAt = Clock::now() + std::chrono::microseconds(kAwakeMicroseconds);
    do
    {
        for (int looks = 0; looks < kLooksTogether; ++looks)
        {
            if (m_job.load(std::memory_order_acquire) != done) return true;
            pauseCore();
        }
        if (m_ends) return false;
        std::this_thread::yield();
    } while (Clock::now() < sleepAt);
    std::unique_lock<std::mutex> lock(m_mutex);
    ++m_sleepers;
    m_offered.wait(lock, [&] { return m_ends || m_job.load() != done; });
    --m_sleepers;
    lock.unlock();
    if (m_ends) return false;
    wakeOne();
    wakeOne();
    return true;
}
}  // namespace drape
