#include "check_settings.h"

#include <cmath>
#include <sstream>

namespace drape
{
namespace
{
struct Field
{
    const char* m_name;
    double m_value;
    bool m_good;
    const char* m_range;
};

// A value cast to an enumeration may be none of its enumerators.
template <typename Choice>
Field choice(const char* name, Choice value, Choice last)
{
    return {name, double(int(value)), int(value) >= 0 && int(value) <= int(last), "one of its enumerators"};
}
}  // namespace

bool checkSettings(const Settings& settings, Error& error)
{
    // NaN is in no range.
    const Field fields[] = {
        choice("Settings::m_backend", settings.m_backend, Backend::ByCost),
        choice("Settings::m_mode", settings.m_mode, ContactMode::Automatic),
        choice("Settings::m_solver", settings.m_solver, Solver::Bullet),
        choice("Settings::m_solverPlace", settings.m_solverPlace, SolverPlace::Device),
        choice("Settings::m_dynamicConvex", settings.m_dynamicConvex, ShapeContacts::Bullet),
        choice("Settings::m_staticConvex", settings.m_staticConvex, ShapeContacts::Bullet),
        choice("Settings::m_surfaces", settings.m_surfaces, ShapeContacts::Bullet),
        {"Settings::m_crossover", settings.m_crossover, !std::isnan(settings.m_crossover), "a number"},
        {"Settings::m_activation", double(settings.m_activation),
         settings.m_activation >= 0.0f && settings.m_activation <= 4.0f, "0 to 4"},
        {"Settings::m_threads", double(settings.m_threads), settings.m_threads <= 64, "0 to 64"}};
    for (const Field& field : fields)
    {
        if (field.m_good) continue;
        std::ostringstream call;
        call << field.m_name << " is " << field.m_value;
        error.m_kind = ErrorKind::Input;
        error.m_call = call.str();
        error.m_detail = std::string("it should be ") + field.m_range;
        return false;
    }
    return true;
}
}  // namespace drape
