#include "opencl_lock.h"

namespace drape
{
namespace
{
// Made by the first device, so that it outlives devices of objects at namespace scope.
std::recursive_mutex& openClMutex()
{
    static std::recursive_mutex mutex;
    return mutex;
}
}  // namespace

OpenClLock::OpenClLock() : m_lock(openClMutex()) {}
}  // namespace drape
