#include "tests/process/failing_allocations.h"

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace
{
constexpr long kNever = -1;

std::atomic<long> g_left{kNever};  // allocations before the one that fails
std::atomic<bool> g_all{false}, g_failed{false};

bool fails()
{
    if (g_left.load(std::memory_order_relaxed) < 0) return false;
    const long left = g_left.fetch_sub(1);
    if (left > 0 || (left < 0 && !g_all)) return false;
    g_left = g_all ? 0 : kNever;
    g_failed = true;
    return true;
}

void* allocateOrNull(std::size_t bytes, std::size_t alignment) noexcept
{
    if (fails()) return nullptr;
    const std::size_t rounded = (bytes + alignment) / alignment * alignment;
    return std::aligned_alloc(alignment, rounded);
}

void* allocate(std::size_t bytes, std::size_t alignment)
{
    if (void* const memory = allocateOrNull(bytes, alignment)) return memory;
    throw std::bad_alloc();
}
}  // namespace

void* operator new(std::size_t bytes)
{
    return allocate(bytes, alignof(std::max_align_t));
}
void* operator new[](std::size_t bytes)
{
    return allocate(bytes, alignof(std::max_align_t));
}
void* operator new(std::size_t bytes, std::align_val_t alignment)
{
    return allocate(bytes, std::size_t(alignment));
}
void* operator new[](std::size_t bytes, std::align_val_t alignment)
{
    return allocate(bytes, std::size_t(alignment));
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept
{
    return allocateOrNull(bytes, alignof(std::max_align_t));
}
void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept
{
    return allocateOrNull(bytes, alignof(std::max_align_t));
}
void operator delete(void* memory, const std::nothrow_t&) noexcept
{
    std::free(memory);
}
void operator delete[](void* memory, const std::nothrow_t&) noexcept
{
    std::free(memory);
}
void operator delete(void* memory) noexcept
{
    std::free(memory);
}
void operator delete[](void* memory) noexcept
{
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept
{
    std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept
{
    std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept
{
    std::free(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept
{
    std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept
{
    std::free(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept
{
    std::free(memory);
}

namespace drape::test
{
FailingAllocations::FailingAllocations(long number, Which which)
{
    g_failed = false;
    g_all = which == Which::AllFromThere;
    g_left = number;
}

FailingAllocations::~FailingAllocations()
{
    g_left = kNever;
    g_all = false;
}

bool FailingAllocations::hasFailed()
{
    return g_failed;
}
}  // namespace drape::test
