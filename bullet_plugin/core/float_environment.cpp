#include "float_environment.h"

#include "bullet_plugin/core/platform/float_state.h"

// Out of line, so that the compiler moves no computation across the change.
namespace drape
{
namespace
{
// The outermost of the thread.
thread_local DefaultFloats* t_outer = nullptr;
}  // namespace

DefaultFloats::DefaultFloats() noexcept : m_isOuter(!t_outer)
{
    if (!m_isOuter) return;
    saveFloatState(m_callers);
    setDefaultFloatState();
    t_outer = this;
}

DefaultFloats::~DefaultFloats()
{
    if (!m_isOuter) return;
    t_outer = nullptr;
    restoreFloatState(m_callers);
}

CallersFloats::CallersFloats() noexcept : m_within(t_outer)
{
    if (!m_within) return;
    t_outer = nullptr;
    restoreFloatState(m_within->m_callers);
}

CallersFloats::~CallersFloats()
{
    if (!m_within) return;
    saveFloatState(m_within->m_callers);
    setDefaultFloatState();
    t_outer = m_within;
}
}  // namespace drape
