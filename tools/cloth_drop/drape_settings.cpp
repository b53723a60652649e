#include "tools/cloth_drop/drape_settings.h"

#include <drape/drape.h>

#include <iostream>

#include "tools/common/device_option.h"

namespace drape
{
bool drapeSettings(const Options& options, Settings& settings, std::string& error)
{
    if (!deviceSettings(options.m_backend, options.m_device, settings, error)) return false;
    settings.m_threads = options.m_threads;
    settings.m_mode = options.m_contactMode == "discrete"     ? ContactMode::Discrete
                      : options.m_contactMode == "continuous" ? ContactMode::Continuous
                                                              : ContactMode::Automatic;
    settings.m_solverPlace = options.m_solverPlace == "host"     ? SolverPlace::Host
                             : options.m_solverPlace == "device" ? SolverPlace::Device
                                                                 : SolverPlace::Auto;
    settings.m_solver = options.m_solver == "drape"    ? Solver::Drape
                        : options.m_solver == "bullet" ? Solver::Bullet
                                                       : Solver::Auto;
    return true;
}

bool isReady(const Plugin& plugin, std::string& error, int& exitCode)
{
    error = plugin.error();
    if (!plugin.ready())
    {
        exitCode = kExitFailed;
        return false;
    }
    if (!error.empty()) std::cerr << "cloth_drop: " << error << "\n";  // a device that failed; the host goes on
    error.clear();
    return true;
}
}  // namespace drape
