// A plugin at namespace scope, which is made before main() begins. Ends with 1 if it has not started.
//
// DRAPE_TEST_STARTUP: "auto" as most apps; "starting" ends while a device is being prepared in the background;
// "started" ends once it is there. The device's driver is loaded after the plugin was made, and so ends before it does.
#include <cstdio>
#include <cstdlib>
#include <string>

#include <drape/drape.h>

static bool isCase(const char* name)
{
    const char* const variable = std::getenv("DRAPE_TEST_STARTUP");
    return variable && std::string(variable) == name;
}

static drape::Settings settingsOfCase()
{
    drape::Settings settings;
    if (isCase("starting") || isCase("started"))
    {
        settings.m_backend = drape::Backend::ByCost;
        settings.m_crossover = 0;
    }
    return settings;
}

static drape::Plugin plugin(settingsOfCase());

int main()
{
    if (isCase("started")) plugin.awaitDevice();
    std::puts(plugin.ready() ? plugin.report().c_str() : plugin.error().c_str());
    return plugin.ready() ? 0 : 1;
}
