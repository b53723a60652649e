// Words of the compiler that C++17 lacks: bits, vectors, hints and instruction sets. For GCC and Clang, on Windows also
// as clang-cl; other compilers have no vector types.
#pragma once

#if !defined(__GNUC__) && !defined(__clang__)
#error "Drape needs GCC or Clang; on Windows use clang-cl or MinGW."
#endif

#include <cstdint>

#if defined(_MSC_VER) && defined(_M_X64)
#include <intrin.h>
#endif

// A vector type of `count` numbers of a type: +, - and comparisons work number by number. `count` is a power of two.
#define DRAPE_VECTOR_OF(type, count) type __attribute__((vector_size(sizeof(type) * (count))))

namespace drape
{
// Numbers of zero bits above the highest bit, and below the lowest. `bits` must not be 0.
inline int leadingZeros(std::uint32_t bits)
{
    return __builtin_clz(bits);
}
inline int leadingZeros(std::uint64_t bits)
{
    return __builtin_clzll(bits);
}
inline int trailingZeros(std::uint64_t bits)
{
    return __builtin_ctzll(bits);
}

// Returns four numbers of two vectors of four: those of `first` are counted from 0, of `second` from 4.
template <int i, int j, int k, int l, class Vector>
Vector shuffled(const Vector& first, const Vector& second)
{
#ifdef __clang__
    return __builtin_shufflevector(first, second, i, j, k, l);
#else
    using Index = DRAPE_VECTOR_OF(int, 4);
    return __builtin_shuffle(first, second, Index{i, j, k, l});
#endif
}

// Hints to the core that this is a waiting loop.
inline void pauseCore()
{
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    __asm__ __volatile__("yield");
#endif
}

#if defined(_MSC_VER) && defined(_M_X64)
// Returns the bits of CPUID's leaf 7 that the operating system saves the registers for. The run time that Clang's own
// test needs is not linked by clang-cl.
__attribute__((target("xsave"))) inline std::uint32_t savedFeatures()
{
    constexpr std::uint32_t kAvx2 = 1u << 5, kSavesAvx = 6, kSavesAvx512 = 0xe6, kXsave = 1u << 27;
    int words[4];
    __cpuid(words, 0);
    if (words[0] < 7) return 0;
    __cpuid(words, 1);
    if (!(std::uint32_t(words[2]) & kXsave)) return 0;
    const std::uint32_t saved = std::uint32_t(_xgetbv(0));
    __cpuidex(words, 7, 0);
    const std::uint32_t features = std::uint32_t(words[1]);
    if ((saved & kSavesAvx) != kSavesAvx) return 0;
    return (saved & kSavesAvx512) == kSavesAvx512 ? features : features & kAvx2;
}
inline bool hasAvx2()
{
    return savedFeatures() & 1u << 5;
}
// F, DQ, BW and VL.
inline bool hasAvx512()
{
    constexpr std::uint32_t kAll = 1u << 16 | 1u << 17 | 1u << 30 | 1u << 31;
    return (savedFeatures() & kAll) == kAll;
}
#elif defined(__x86_64__)
inline bool hasAvx2()
{
    __builtin_cpu_init();
    return __builtin_cpu_supports("avx2");
}
// F, DQ, BW and VL.
inline bool hasAvx512()
{
    __builtin_cpu_init();
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
}
#endif
}  // namespace drape
