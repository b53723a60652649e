// Measures the memory of this process, and defines the growth that counts as no leak. Linux.
#pragma once

#include <cstddef>

namespace drape::test
{
// Growth that is no leak: allocators and drivers keep some pages, and the address sanitizer keeps what was freed, 256
// MiB of it. A leak of one contact list a step would be 50 MB and more; with the sanitizer its leak check finds it.
#if defined(__SANITIZE_ADDRESS__)
constexpr std::size_t kGrowthBytes = 300u << 20;
#else
constexpr std::size_t kGrowthBytes = 16u << 20;
#endif

std::size_t residentBytes();
std::size_t peakResidentBytes();  // the most there ever was
}  // namespace drape::test
