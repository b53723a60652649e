// Notices that two threads are in the calls of one plugin at the same time.
//
// Cost: two exchanges of an atomic for each call.
#pragma once

#include <atomic>
#include <thread>
#include <utility>

namespace drape
{
class ThreadWatch
{
public:
    // A call of the plugin, from its start to its end. Calls of one thread may be nested.
    class Call
    {
    public:
        explicit Call(ThreadWatch& watch) : m_watch(&watch)
        {
            const std::thread::id own = std::this_thread::get_id();
            m_before = watch.m_inside.exchange(own);
            const bool overlaps = m_before != std::thread::id() && m_before != own;
            m_isFirstOverlap = overlaps && !watch.m_overlapped.exchange(true);
        }
        Call(Call&& other) noexcept
            : m_watch(std::exchange(other.m_watch, nullptr)),
              m_before(other.m_before),
              m_isFirstOverlap(other.m_isFirstOverlap)
        {
        }
        Call& operator=(Call&&) = delete;
        ~Call()
        {
            if (m_watch) m_watch->m_inside = m_before;
        }

        // Returns whether this is the first call of the plugin that began within a call of another thread.
        bool isFirstOverlap() const { return m_isFirstOverlap; }

    private:
        ThreadWatch* m_watch;
        std::thread::id m_before;
        bool m_isFirstOverlap = false;
    };

private:
    std::atomic<std::thread::id> m_inside{};
    std::atomic<bool> m_overlapped{false};
};
}  // namespace drape
