// Saves, restores and resets the calling thread's floating-point environment: traps, rounding, flags, and the flushing
// of subnormal numbers.
//
// <cfenv> does all of it with glibc and on macOS. On Windows its default leaves flushing on, so that the register of
// SSE is set here; Drape computes with no other there. C++17.
#pragma once

#include <cfenv>

#if defined(_WIN32) && (defined(__x86_64__) || defined(_M_X64))
#include <xmmintrin.h>

#include <cstring>

namespace drape
{
static_assert(sizeof(std::fenv_t) >= sizeof(unsigned), "an environment holds the register");

inline void saveFloatState(std::fenv_t& state)
{
    const unsigned bits = _mm_getcsr();
    std::memcpy(&state, &bits, sizeof bits);
}
inline void restoreFloatState(const std::fenv_t& state)
{
    unsigned bits;
    std::memcpy(&bits, &state, sizeof bits);
    _mm_setcsr(bits);
}
// No traps, no flags, rounding to nearest, subnormal numbers kept: the processor's own default.
inline void setDefaultFloatState()
{
    _mm_setcsr(0x1f80);
}
}  // namespace drape
#else
namespace drape
{
inline void saveFloatState(std::fenv_t& state)
{
    std::fegetenv(&state);
}
inline void restoreFloatState(const std::fenv_t& state)
{
    std::fesetenv(&state);
}
// No traps, no flags, rounding to nearest, subnormal numbers kept.
inline void setDefaultFloatState()
{
    std::fesetenv(FE_DFL_ENV);
}
}  // namespace drape
#endif

// The registers of an x86-64 processor, for code that cannot afford <cfenv>. On others modesAreDefault() is false.
namespace drape
{
#if defined(__GNUC__) && defined(__x86_64__)
// The registers' flags of exceptions, and their modes by default.
constexpr unsigned kExceptionFlags = 0x3f, kDefaultSseModes = 0x1f80;
constexpr unsigned short kDefaultX87Control = 0x37f;

inline unsigned sseRegister() noexcept
{
    return __builtin_ia32_stmxcsr();
}

inline void setSseRegister(unsigned value) noexcept
{
    if (value != sseRegister()) __builtin_ia32_ldmxcsr(value);
}

inline unsigned short x87Status() noexcept
{
    unsigned short status;
    __asm__ volatile("fnstsw %0" : "=m"(status));
    return status;
}

inline bool modesAreDefault() noexcept
{
    unsigned short control;
    __asm__ volatile("fnstcw %0" : "=m"(control));
    return (sseRegister() & ~kExceptionFlags) == kDefaultSseModes && control == kDefaultX87Control;
}
#else
constexpr unsigned kExceptionFlags = 0;
inline unsigned sseRegister() noexcept
{
    return 0;
}
inline void setSseRegister(unsigned) noexcept {}
inline unsigned short x87Status() noexcept
{
    return 0;
}
inline bool modesAreDefault() noexcept
{
    return false;
}
#endif
}  // namespace drape
