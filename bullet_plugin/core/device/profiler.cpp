#include "profiler.h"

namespace drape
{
cl::Event* Profiler::add(const std::string& kernel)
{
    m_launches.push_back(Launch{kernel, cl::Event()});
    return &m_launches.back().m_event;
}

std::vector<KernelTime> Profiler::take()
{
    constexpr double kMsPerNs = 1e-6;
    std::vector<KernelTime> times;
    cl_ulong first = 0;
    for (const Launch& launch : m_launches)
    {
        cl_ulong start = 0, end = 0;
        if (!launch.m_event() || launch.m_event.getProfilingInfo(CL_PROFILING_COMMAND_START, &start) != CL_SUCCESS ||
            launch.m_event.getProfilingInfo(CL_PROFILING_COMMAND_END, &end) != CL_SUCCESS)
        {
            continue;
        }
        if (times.empty()) first = start;
        times.push_back(KernelTime{launch.m_kernel, double(start - first) * kMsPerNs, double(end - start) * kMsPerNs});
    }
    m_launches.clear();
    return times;
}

double totalMs(const std::vector<KernelTime>& launches)
{
    double sum = 0;
    for (const KernelTime& launch : launches)
        sum += launch.m_ms;
    return sum;
}
}  // namespace drape
