// One lock for the whole process around the OpenCL entry points that are not safe to call from several threads.
//
// The standard allows any thread to query platforms and devices and to create contexts, programs and kernels. Drivers
// do not comply: with PoCL 3.1, two threads that query devices or build programs at once crash in most runs. Drape
// therefore makes every such call while an OpenClLock lives. Launches and transfers need none: a queue belongs to one
// pipeline, which belongs to one thread. Calls by the app and by other libraries are not covered.
#pragma once

#include <mutex>

namespace drape
{
// Locks within the lifetime of another lock of the same thread are free.
class OpenClLock
{
public:
    OpenClLock();

private:
    std::lock_guard<std::recursive_mutex> m_lock;
};
}  // namespace drape
