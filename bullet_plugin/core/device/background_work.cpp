#include "background_work.h"

#include <mutex>
#include <set>

#include "bullet_plugin/core/platform/platform.h"

namespace drape
{
namespace
{
// The jobs of the process. Never destroyed, so that it outlives owners at namespace scope.
struct Registry
{
    std::mutex m_mutex;
    std::set<BackgroundWork*> m_works;
};

Registry& registry()
{
    static Registry* const all = new Registry;
    return *all;
}
}  // namespace

BackgroundWork::BackgroundWork(std::function<void(const StopFlag&)> job)
{
    std::packaged_task<void()> task([job = std::move(job), stop = StopFlag(m_stop)] { job(stop); });
    m_end = task.get_future().share();
    Registry& all = registry();
    const std::lock_guard<std::mutex> lock(all.m_mutex);
    const auto entry = all.m_works.insert(this).first;
    try
    {
        const BlockedSignals blocked;
        m_thread = std::thread(std::move(task));
    }
    catch (...)
    {
        all.m_works.erase(entry);
        throw;
    }
}

BackgroundWork::~BackgroundWork()
{
    if (!isDone()) *m_stop = true;  // a finished job has made things that heed the flag
    m_thread.join();
    Registry& all = registry();
    const std::lock_guard<std::mutex> lock(all.m_mutex);
    all.m_works.erase(this);
}

bool BackgroundWork::isDone() const
{
    return m_end.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

void BackgroundWork::wait()
{
    m_end.get();
}

void BackgroundWork::stopAll() noexcept
{
    Registry& all = registry();
    const std::lock_guard<std::mutex> lock(all.m_mutex);
    for (BackgroundWork* const work : all.m_works)
        *work->m_stop = true;
    for (BackgroundWork* const work : all.m_works)
        work->m_end.wait();
}
}  // namespace drape
