#include "bullet_plugin/adapter/c_api/c_call.h"

#include "bullet_plugin/adapter/c_api/c_records.h"
#include "drape/version.h"

namespace drape
{
namespace
{
thread_local std::string t_error;
thread_local const char* t_errorText = "";

// A text that finds no memory is replaced by a constant one.
void keepError(const Error& error) noexcept
{
    t_errorText = textC(t_error, [&] { return error.text(); });
}
}  // namespace

DrapeResult failC(const Error& error) noexcept
{
    keepError(error);
    switch (error.m_kind)
    {
        case ErrorKind::Input:
            return DRAPE_BAD_INPUT;
        case ErrorKind::Memory:
            return DRAPE_OUT_OF_MEMORY;
        case ErrorKind::Environment:
            break;
    }
    return DRAPE_NO_DEVICE;
}

DrapeResult refuseC(const char* call, const char* wrong) noexcept
{
    return callC(call,
                 [&]
                 {
                     Error error;
                     error.m_kind = ErrorKind::Input;
                     error.m_call = std::string(call) + ": " + wrong;
                     return failC(error);
                 });
}

const char* drapeErrorText(void)
{
    return t_errorText;
}

const char* drapeVersion(void)
{
    return libraryVersion();
}

int drapeVersionNumber(void)
{
    return libraryVersionNumber();
}

const char* drapeStatusText(uint32_t status)
{
    static thread_local std::string t_text;
    return textC(t_text, [&] { return statusText(status); });
}

void drapeDefaultSettings(DrapeSettings* settings)
{
    if (settings) *settings = defaultCSettings();
}

void drapeLogToStandardError(const char* line, void*)
{
    if (line) logToStandardError(line);
}

DrapeResult drapeListDevices(const DrapeDeviceInfo** devices, size_t* count)
{
    static thread_local std::vector<DeviceInfo> t_found;
    static thread_local std::vector<DrapeDeviceInfo> t_listed;
    if (!devices || !count) return refuseC("drapeListDevices", "an argument is null");
    return callC("drapeListDevices",
                 [&]
                 {
                     t_found = listDevices();
                     t_listed.clear();
                     for (const DeviceInfo& device : t_found)
                         t_listed.push_back(infoOf(device));
                     *devices = t_listed.data();
                     *count = t_listed.size();
                     return DRAPE_OK;
                 });
}

const char* drapeWhyNoDevice(const DrapeSettings* settings)
{
    static thread_local std::string t_text;
    return textC(t_text, [&] { return whyNoDevice(settingsOf(settings)); });
}
}  // namespace drape
