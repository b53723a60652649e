// The floating-point environment that Drape computes in, whatever the app has set for its threads.
//
// Apps enable traps (feenableexcept), flush subnormal numbers to zero or round another way. Drape compares lanes that
// may be NaN, and its answers must have the same bits on every back end. So each public function computes in the
// default environment: no traps, subnormal numbers kept, rounding to nearest. The app's environment comes back
// afterwards as it was, with its exception flags; nothing is raised by that. Cost: some 5 ns on an x86-64 processor if
// the app's environment is the default one but for its flags, else some 100 ns.
#pragma once

#include "bullet_plugin/core/platform/float_state.h"

namespace drape
{
// Makes the calling thread compute in the default environment while this lives. A nested one does nothing.
class DefaultFloats
{
public:
    DefaultFloats() noexcept;
    ~DefaultFloats();
    DefaultFloats(const DefaultFloats&) = delete;
    DefaultFloats& operator=(const DefaultFloats&) = delete;

private:
    friend class CallersFloats;

    void save() noexcept;
    void restore() const noexcept;

    FloatState m_callers;            // unless m_isPlain
    unsigned m_flags = 0;            // SSE's register; if m_isPlain
    unsigned short m_x87Status = 0;  // if m_isPlain
    bool m_isPlain = false;          // the app's modes are the default ones
    bool m_isOuter;
};

// Restores the calling thread's own environment within a DefaultFloats, for code of Bullet and of the app that Drape
// calls and that would run in it without Drape. Exception flags that this code raises stay raised. Does nothing
// outside a DefaultFloats.
class CallersFloats
{
public:
    CallersFloats() noexcept;
    ~CallersFloats();
    CallersFloats(const CallersFloats&) = delete;
    CallersFloats& operator=(const CallersFloats&) = delete;

private:
    DefaultFloats* m_within;
};
}  // namespace drape
