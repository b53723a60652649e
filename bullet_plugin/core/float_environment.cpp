#include "float_environment.h"

// Out of line, so that the compiler moves no computation across the change.
namespace drape
{
namespace
{
// The outermost of the thread.
thread_local DefaultFloats* t_outer = nullptr;
}  // namespace

// Saves the app's environment and sets the default one, but for flags of exceptions that are raised already.
void DefaultFloats::save() noexcept
{
    m_isPlain = modesAreDefault();
    if (m_isPlain)
    {
        m_flags = sseRegister();
        m_x87Status = x87Status();
        return;
    }
    saveFloatState(m_callers);
    setDefaultFloatState();
}

void DefaultFloats::restore() const noexcept
{
    if (!m_isPlain)
    {
        restoreFloatState(m_callers);
        return;
    }
    // Long doubles, and MinGW's mathematics, raise the older unit's flags.
    if (((x87Status() ^ m_x87Status) & kExceptionFlags) != 0) setX87(x87Control(), m_x87Status);
    setSseRegister(m_flags);
}

DefaultFloats::DefaultFloats() noexcept : m_isOuter(!t_outer)
{
    if (!m_isOuter) return;
    save();
    t_outer = this;
}

DefaultFloats::~DefaultFloats()
{
    if (!m_isOuter) return;
    t_outer = nullptr;
    restore();
}

CallersFloats::CallersFloats() noexcept : m_within(t_outer)
{
    if (!m_within) return;
    t_outer = nullptr;
    m_within->restore();
}

CallersFloats::~CallersFloats()
{
    if (!m_within) return;
    m_within->save();
    t_outer = m_within;
}
}  // namespace drape
