// A job system as an app may have: threads that take the indices of one job after another.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "drape/settings.h"

namespace drape::test
{
class JobPool
{
public:
    explicit JobPool(unsigned threads)
    {
        for (unsigned i = 0; i < threads; ++i)
            m_threads.emplace_back([this] { work(); });
    }
    ~JobPool()
    {
        {
            const std::lock_guard<std::mutex> lock(m_mutex);
            m_ends = true;
        }
        m_offered.notify_all();
        for (std::thread& thread : m_threads)
            thread.join();
    }

    // The caller only waits: all indices run on the pool's threads.
    void parallelFor(std::size_t count, const std::function<void(std::size_t)>& job)
    {
        ++m_calls;
        std::unique_lock<std::mutex> lock(m_mutex);
        m_job = &job;
        m_next = 0;
        m_count = m_unfinished = count;
        m_offered.notify_all();
        m_done.wait(lock, [this] { return m_unfinished == 0; });
        m_job = nullptr;
    }
    ParallelFor function()
    {
        return [this](std::size_t count, const std::function<void(std::size_t)>& job) { parallelFor(count, job); };
    }
    // Returns the number of calls of parallelFor().
    std::size_t calls() const { return m_calls; }

private:
    void work()
    {
        std::unique_lock<std::mutex> lock(m_mutex);
        for (;;)
        {
            m_offered.wait(lock, [this] { return m_ends || (m_job && m_next < m_count); });
            if (m_ends) return;
            const std::size_t index = m_next++;
            const std::function<void(std::size_t)>& job = *m_job;
            lock.unlock();
            job(index);
            lock.lock();
            if (--m_unfinished == 0) m_done.notify_all();
        }
    }

    std::mutex m_mutex;
    std::condition_variable m_offered, m_done;
    const std::function<void(std::size_t)>* m_job = nullptr;
    std::size_t m_next = 0, m_count = 0, m_unfinished = 0;
    std::atomic<std::size_t> m_calls{0};
    bool m_ends = false;
    std::vector<std::thread> m_threads;
};
}  // namespace drape::test
