// A job on a thread of its own that uses OpenCL, such as compiling a device's kernels.
//
// The job ends before its owner does, and before the process ends its drivers (endOpenClAtExit()). It is asked to stop
// and waited for, since a driver's call cannot be interrupted and must not run while the driver is unloaded.
#pragma once

#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <thread>

namespace drape
{
// Becomes true once the result of the work is no longer wanted; stays false if the work ends before.
using StopFlag = std::shared_ptr<const std::atomic<bool>>;

class BackgroundWork
{
public:
    // Starts the job, which must return soon once its flag is true. Its exceptions end in wait(). Throws
    // std::system_error if no thread can be started.
    explicit BackgroundWork(std::function<void(const StopFlag&)> job);
    // Stops the job and waits for it.
    ~BackgroundWork();
    BackgroundWork(const BackgroundWork&) = delete;
    BackgroundWork& operator=(const BackgroundWork&) = delete;

    // Returns whether the job has ended; what it wrote is visible then.
    bool isDone() const;
    // Waits for the job, and throws what it threw.
    void wait();

    // Stops all jobs of the process and waits for them.
    static void stopAll() noexcept;

private:
    const std::shared_ptr<std::atomic<bool>> m_stop = std::make_shared<std::atomic<bool>>(false);
    std::shared_future<void> m_end;
    std::thread m_thread;
};
}  // namespace drape
