#include "float_environment.h"

// Out of line, so that the compiler moves no computation across the change.
namespace drape
{
namespace
{
// The outermost of the thread.
thread_local DefaultFloats* t_outer = nullptr;

#if defined(__GNUC__) && defined(__x86_64__)
// The registers' flags of exceptions, and their modes by default.
constexpr unsigned kFlags = 0x3f, kDefaultModes = 0x1f80;
constexpr unsigned short kDefaultX87Control = 0x37f;

unsigned sseRegister() noexcept
{
    return __builtin_ia32_stmxcsr();
}

void setSseRegister(unsigned value) noexcept
{
    if (value != sseRegister()) __builtin_ia32_ldmxcsr(value);
}

unsigned short x87Status() noexcept
{
    unsigned short status;
    __asm__ volatile("fnstsw %0" : "=m"(status));
    return status;
}

bool modesAreDefault() noexcept
{
    unsigned short control;
    __asm__ volatile("fnstcw %0" : "=m"(control));
    return (sseRegister() & ~kFlags) == kDefaultModes && control == kDefaultX87Control;
}
#else
constexpr unsigned kFlags = 0;
unsigned sseRegister() noexcept
{
    return 0;
}
void setSseRegister(unsigned) noexcept {}
unsigned short x87Status() noexcept
{
    return 0;
}
bool modesAreDefault() noexcept
{
    return false;
}
#endif
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
    std::fegetenv(&m_callers);
    std::fesetenv(FE_DFL_ENV);
}

void DefaultFloats::restore() const noexcept
{
    if (!m_isPlain)
    {
        std::fesetenv(&m_callers);
        return;
    }
    // Long doubles alone raise the older unit's flags. Its environment is set as a whole.
    if (((x87Status() ^ m_x87Status) & kFlags) != 0)
    {
        const std::fexcept_t flags = static_cast<std::fexcept_t>(m_x87Status & kFlags);
        std::fesetexceptflag(&flags, FE_ALL_EXCEPT);
    }
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
