// Settings, statistics and devices as dictionaries.
#include <cctype>
#include <cstring>
#include <regex>

#include "bullet_plugin/adapter/c_api/field_lists.h"
#include "drape/queries.h"
#include "drape/version.h"
#include "python/binding/binding.h"

namespace drape
{
namespace
{
// Numbers, texts and flags; an enumeration as its number.
template <class Field>
py::object objectOf(const Field& field)
{
    if constexpr (std::is_enum_v<Field>)
        return py::int_(int(field));
    else
        return py::cast(field);
}

template <class Field>
void readField(const py::dict& settings, const char* field, Field& to)
{
    if constexpr (std::is_enum_v<Field>)
        to = Field(valueOf<int>(settings, pythonName(field)));
    else
        to = valueOf<Field>(settings, pythonName(field));
}

// Calls the app's function with the GIL. An exception from it is printed and dropped.
std::function<void(const char*)> logOf(const py::object& function)
{
    if (function.is_none()) return nullptr;
    const std::shared_ptr<py::object> kept(new py::object(function),
                                           [](py::object* object)
                                           {
                                               const py::gil_scoped_acquire acquired;
                                               delete object;
                                           });
    return [kept](const char* line)
    {
        const py::gil_scoped_acquire acquired;
        try
        {
            (*kept)(line);
        }
        catch (py::error_already_set& error)
        {
            error.discard_as_unraisable("drape.Settings.log");
        }
    };
}

py::dict dictOf(const DeviceInfo& device)
{
    py::dict found;
#define DRAPE_FIELD(field) found[pythonName(#field).c_str()] = objectOf(device.field);
    DRAPE_DEVICE_INFO_FIELDS(DRAPE_FIELD)
#undef DRAPE_FIELD
    return found;
}

py::dict defaultSettings()
{
    const Settings settings;
    py::dict found;
#define DRAPE_FIELD(field) found[pythonName(#field).c_str()] = objectOf(settings.field);
    DRAPE_SETTINGS_FIELDS(DRAPE_FIELD)
#undef DRAPE_FIELD
    return found;
}

// Returns the names of each setting that is an enumeration, with their numbers.
py::dict choices()
{
    py::dict found;
#define DRAPE_CHOICE(field, constant, enumerator, name) \
    found.attr("setdefault")(pythonName(#field), py::dict())[name] = int(enumerator);
    DRAPE_CHOICES(DRAPE_CHOICE)
#undef DRAPE_CHOICE
    return found;
}

py::dict statusBits()
{
    py::dict found;
#define DRAPE_BIT(name, enumerator) found[#name] = std::uint32_t(enumerator);
    DRAPE_STATUS_BITS(DRAPE_BIT)
#undef DRAPE_BIT
    return found;
}

// Returns what is wrong with an argument, with Python's names: Settings::m_mode becomes Settings.mode. The call, which
// a traceback names, is left out.
std::string causeOf(const Error& error)
{
    std::string text = error.text();
    const std::string call = text.substr(0, text.find(": "));
    if (call.size() < text.size() && call.find(' ') == std::string::npos) text.erase(0, call.size() + 2);
    const bool hasVertices = call == "addObstacle" || call == "setVertices";
    if (hasVertices && text.rfind("positions", 0) == 0) text.replace(0, std::strlen("positions"), "vertices");
    static const std::regex name("::|\\bm_\\w+|\\b[a-z]+[A-Z]\\w*");
    std::string cause;
    auto copied = text.cbegin();
    for (std::sregex_iterator found(text.begin(), text.end(), name), end; found != end; ++found)
    {
        cause.append(copied, (*found)[0].first).append(found->str() == "::" ? "." : pythonName(found->str()));
        copied = (*found)[0].second;
    }
    return cause.append(copied, text.cend());
}
}  // namespace

void raise(const Error& error)
{
    switch (error.m_kind)
    {
        case ErrorKind::Input:
            throw py::value_error(causeOf(error));
        case ErrorKind::Memory:
            throw std::bad_alloc();
        case ErrorKind::Environment:
            break;
    }
    throw DeviceFailure(error.text());
}

std::string pythonName(const std::string& field)
{
    std::string name;
    for (const char letter : field.substr(field.rfind("m_", 0) == 0 ? 2 : 0))
    {
        if (std::isupper(static_cast<unsigned char>(letter))) name += '_';
        name += char(std::tolower(static_cast<unsigned char>(letter)));
    }
    return name;
}

Settings settingsOf(const py::dict& settings)
{
    Settings to;
#define DRAPE_FIELD(field) readField(settings, #field, to.field);
    DRAPE_SETTINGS_FIELDS(DRAPE_FIELD)
#undef DRAPE_FIELD
    to.m_log = logOf(settings["log"]);
    return to;
}

py::dict dictOf(const DeviceReport& report)
{
    py::dict found;
    found["device"] = dictOf(report.m_device);
#define DRAPE_FIELD(field) found[pythonName(#field).c_str()] = objectOf(report.field);
    DRAPE_DEVICE_REPORT_FIELDS(DRAPE_FIELD)
#undef DRAPE_FIELD
    return found;
}

py::dict dictOf(const StepStatistics& statistics)
{
    py::dict found;
#define DRAPE_FIELD(field) found[pythonName(#field).c_str()] = objectOf(statistics.field);
    DRAPE_STATISTICS_FIELDS(DRAPE_FIELD)
#undef DRAPE_FIELD
#define DRAPE_SUM(field, function) found[pythonName(#field).c_str()] = statistics.function();
    DRAPE_STATISTICS_SUMS(DRAPE_SUM)
#undef DRAPE_SUM
    return found;
}

void bindRecords(py::module_& module)
{
    py::register_exception<DeviceFailure>(module, "DeviceError", PyExc_RuntimeError);
    module.attr("VERSION") = DRAPE_VERSION_STRING;
    module.def("default_settings", defaultSettings);
    module.def("choices", choices);
    module.def("status_bits", statusBits);
    module.def("status_text", statusText);
    module.def("log_to_standard_error", logToStandardError);
    module.def("list_devices",
               []
               {
                   std::vector<DeviceInfo> devices;
                   {
                       const py::gil_scoped_release released;
                       devices = listDevices();
                   }
                   py::list found;
                   for (const DeviceInfo& device : devices)
                       found.append(dictOf(device));
                   return found;
               });
    module.def("why_no_device", [](const py::dict& settings) { return whyNoDevice(settingsOf(settings)); });
}
}  // namespace drape

PYBIND11_MODULE(_drape, module)
{
    drape::bindRecords(module);
    drape::bindQueries(module);
    drape::bindWorld(module);
}
