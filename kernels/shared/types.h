// Defines the shared declarations' keywords in C++ and OpenCL C. In C++ the declarations are in namespace drape.
#ifndef DRAPE_SHARED_TYPES_H
#define DRAPE_SHARED_TYPES_H

#ifdef __OPENCL_VERSION__
#define DRAPE_UINT uint
#define DRAPE_ULONG ulong
#define DRAPE_GLOBAL __global
// On a CPU the functions of lib/any_width exist for two widths, as overloads. Its compilers derive from Clang, which
// has them in C.
#ifdef DRAPE_CPU
#define DRAPE_FUNCTION static inline __attribute__((overloadable))
#else
#define DRAPE_FUNCTION static inline
#endif
// Marks large functions that are seldom called: inlined they would cost their callers registers.
#define DRAPE_RARE_FUNCTION static __attribute__((noinline))
#define DRAPE_NAMESPACE_BEGIN
#define DRAPE_NAMESPACE_END
// Precedes a loop over a volume's directions, whose bodies differ: without it compilers keep the branches in the
// loop.
#define DRAPE_UNROLL _Pragma("unroll")
#else
#include <cmath>
#include <cstdint>
#include <cstring>
#define DRAPE_UINT std::uint32_t
#define DRAPE_ULONG std::uint64_t
#define DRAPE_GLOBAL
// Gives each instruction set of the host's kernels its own functions: linkers merge inline ones.
#ifdef DRAPE_CPU_KERNELS
#define DRAPE_FUNCTION static inline
#define DRAPE_RARE_FUNCTION static __attribute__((noinline))
#else
#define DRAPE_FUNCTION inline
#define DRAPE_RARE_FUNCTION inline
#endif
#define DRAPE_NAMESPACE_BEGIN \
    namespace drape           \
    {
#define DRAPE_NAMESPACE_END }
#define DRAPE_UNROLL _Pragma("GCC unroll 16")
#endif

DRAPE_NAMESPACE_BEGIN

// Packed: OpenCL's float3 is as large as a float4.
typedef struct Vec3
{
    float x, y, z;
} Vec3;

DRAPE_NAMESPACE_END

// Marks small functions that are seldom called. On a GPU a call costs a kernel a stack frame wherever it may happen;
// inlining costs less.
#if defined(DRAPE_CPU_KERNELS) || defined(DRAPE_CPU)
#define DRAPE_COLD_FUNCTION DRAPE_RARE_FUNCTION
#else
#define DRAPE_COLD_FUNCTION DRAPE_FUNCTION
#endif

#endif
