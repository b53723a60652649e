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
