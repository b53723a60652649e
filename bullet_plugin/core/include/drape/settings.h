// What a user may choose before Drape starts: where it computes and how far it looks.
// Every field has a working default. Lengths are metres. C++11, no OpenCL header needed.
#pragma once

#include <string>

namespace drape
{
enum class Backend
{
    Auto,    // a GPU, else any OpenCL device, else the host
    OpenCl,  // an OpenCL device or an error
    Host     // the same pure functions, run serially by the calling thread
};

struct Settings
{
    Backend m_backend = Backend::Auto;

    // Part of an OpenCL device's or platform's name, compared without case. Empty: the environment variable
    // DRAPE_DEVICE, and if that is empty too, the order of Backend::Auto. "host" asks for the host back end.
    std::string m_device;

    // Contacts are reported up to thickness + m_activation × thickness, so that the solver knows of a surface before
    // the thickness is violated. Range 0 to 4. Larger: safer under stiff links, more contacts.
    float m_activation = 0.5f;

    // Also list the cloth and obstacle triangles that intersect at the step's start. Costs a kernel.
    bool m_reportIntersections = false;

    // Have the device time every kernel launch, for Pipeline::takeKernelTimes(). Costs some microseconds a launch.
    bool m_profileKernels = false;

    // Folder of compiled kernels. Empty: $XDG_CACHE_HOME/drape or ~/.cache/drape. "none": do not cache.
    std::string m_cacheFolder;
};
}  // namespace drape
