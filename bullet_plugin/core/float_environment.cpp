#include "float_environment.h"

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
    std::fegetenv(&m_callers);
    std::fesetenv(FE_DFL_ENV);
    t_outer = this;
}

DefaultFloats::~DefaultFloats()
{
    if (!m_isOuter) return;
    t_outer = nullptr;
    std::fesetenv(&m_callers);
}

CallersFloats::CallersFloats() noexcept : m_within(t_outer)
{
    if (!m_within) return;
    t_outer = nullptr;
    std::fesetenv(&m_within->m_callers);
}

CallersFloats::~CallersFloats()
{
    if (!m_within) return;
    std::fegetenv(&m_within->m_callers);
    std::fesetenv(FE_DFL_ENV);
    t_outer = m_within;
}
}  // namespace drape
