#include "opencl.h"

#if DRAPE_OPENCL

#include <atomic>
#include <cstdlib>

#include "background_work.h"
#include "bullet_plugin/core/platform/platform.h"

namespace drape
{
namespace
{
std::atomic<bool> g_ended{false};

// Opened at most once, and never closed: drivers keep threads.
std::atomic<void*> g_loader{nullptr};

void endOpenCl()
{
    BackgroundWork::stopAll();
    g_ended = true;
}
}  // namespace

void* openClFunction(const char* name) noexcept
{
    if (void* const function = loadedFunction(name)) return function;
    if (!g_loader) g_loader = loadLibrary(kOpenClLoader);
    return g_loader ? libraryFunction(g_loader, name) : nullptr;
}

void endOpenClAtExit() noexcept
{
    static const int registered = std::atexit(endOpenCl);
    static_cast<void>(registered);
}

bool isOpenClEnded() noexcept
{
    return g_ended.load(std::memory_order_relaxed);
}
}  // namespace drape

#endif
