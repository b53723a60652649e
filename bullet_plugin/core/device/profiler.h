// Times of kernel launches, as the device's queue took them.
//
// Job: hand out an event per launch, and turn the events into milliseconds. Belongs to a device that was opened
// profiled (Device::profiler()). Cost: an event a launch until take().
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "drape/report.h"
#include "opencl.h"

namespace drape
{
class Profiler
{
public:
    // Returns the event that the coming launch of this kernel signals. Valid until take().
    cl::Event* add(const std::string& kernel);

    // Returns the launches since the last call, in order of submission, without failed ones. Requires a wait for the
    // device before.
    std::vector<KernelTime> take();

private:
    struct Launch
    {
        std::string m_kernel;
        cl::Event m_event;
    };
    std::deque<Launch> m_launches;  // a deque: events keep their address
};

// Sum of the times, ms.
double totalMs(const std::vector<KernelTime>& launches);
}  // namespace drape
