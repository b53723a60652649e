// Saves, restores and resets the calling thread's floating-point environment: traps, rounding, flags, and the flushing
// of subnormal numbers.
//
// <cfenv> does all of it with glibc and on macOS. On 64-bit Windows this header sets the registers itself: Microsoft's
// default leaves flushing on, and MinGW's functions set the older unit (x87) alone. MinGW's mathematics compute there;
// Microsoft's compilers never use it. C++17.
#pragma once

#include <cfenv>

#if defined(_WIN32) && (defined(__x86_64__) || defined(_M_X64))
#include <xmmintrin.h>
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

inline unsigned short x87Control() noexcept
{
    unsigned short control;
    __asm__ volatile("fnstcw %0" : "=m"(control));
    return control;
}

inline unsigned short x87Status() noexcept
{
    unsigned short status;
    __asm__ volatile("fnstsw %0" : "=m"(status));
    return status;
}

// Sets the older unit's modes and flags. Only its environment as a whole has the flags, and the rest of it stays.
inline void setX87(unsigned short control, unsigned short status) noexcept
{
    struct Environment
    {
        unsigned m_control, m_status, m_others[5];
    } now;
    __asm__ volatile("fnstenv %0" : "=m"(now));
    now.m_control = (now.m_control & ~0xffffu) | control;
    now.m_status = (now.m_status & ~kExceptionFlags) | (status & kExceptionFlags);
    __asm__ volatile("fldenv %0" : : "m"(now));
}

inline bool modesAreDefault() noexcept
{
    return (sseRegister() & ~kExceptionFlags) == kDefaultSseModes && x87Control() == kDefaultX87Control;
}
#else
constexpr unsigned kExceptionFlags = 0;
inline unsigned sseRegister() noexcept
{
    return 0;
}
inline void setSseRegister(unsigned) noexcept {}
inline unsigned short x87Control() noexcept
{
    return 0;
}
inline unsigned short x87Status() noexcept
{
    return 0;
}
inline void setX87(unsigned short, unsigned short) noexcept {}
inline bool modesAreDefault() noexcept
{
    return false;
}
#endif

#if defined(_WIN32) && (defined(__x86_64__) || defined(_M_X64))
// The thread's environment.
struct FloatState
{
    unsigned m_sse;
    unsigned short m_x87Control, m_x87Status;  // 0 with Microsoft's compilers
};

inline void saveFloatState(FloatState& state) noexcept
{
    state = {_mm_getcsr(), x87Control(), x87Status()};
}
inline void restoreFloatState(const FloatState& state) noexcept
{
    setX87(state.m_x87Control, state.m_x87Status);
    _mm_setcsr(state.m_sse);
}
// No traps, no flags, rounding to nearest, subnormal numbers kept: the processor's own default.
inline void setDefaultFloatState() noexcept
{
    restoreFloatState({0x1f80, 0x37f, 0});
}
#else
// The thread's environment.
using FloatState = std::fenv_t;

inline void saveFloatState(FloatState& state) noexcept
{
    std::fegetenv(&state);
}
inline void restoreFloatState(const FloatState& state) noexcept
{
    std::fesetenv(&state);
}
// No traps, no flags, rounding to nearest, subnormal numbers kept.
inline void setDefaultFloatState() noexcept
{
    std::fesetenv(FE_DFL_ENV);
}
#endif
}  // namespace drape
