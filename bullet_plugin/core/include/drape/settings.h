// What a user may choose before Drape starts: where it computes and how far it looks.
// Every field has a working default. Lengths are metres. C++11, no OpenCL header needed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace drape
{
// Writes "drape: ", the line and a line feed to standard error.
void logToStandardError(const char* line);

enum class Backend
{
    Auto,    // a GPU, else any OpenCL device, and the host where there is none, where it fails (then error() says why),
             // or where the scene is too small to pay for it
    OpenCl,  // an OpenCL device or an error
    Host     // the same functions as C++, on m_threads threads and without OpenCL
};

// How a step looks at the cloth's motion between its start and its end.
enum class ContactMode : std::uint32_t
{
    Discrete,    // only at what is near at the end: the fastest, for cloth that moves less than its thickness in a step
    Continuous,  // the certified continuous test for every pair of features that the broad phase leaves
    Automatic    // the same contacts as Continuous, but the test only where motion is large enough to meet something
};

struct Settings
{
    Backend m_backend = Backend::Auto;

    // Part of an OpenCL device's or platform's name, compared without case. Empty: the environment variable
    // DRAPE_DEVICE, and if that is empty too, the order of Backend::Auto. "host" asks for the host back end.
    std::string m_device;

    // With Backend::Auto and no device named: the work from which a scene runs on the device, in pairs of triangles
    // that its meshes let expect; below it the host is used. Both give the same contacts, so a scene that grows moves
    // over between two steps, and comes back below half of it. 0: always the device. Infinite: always the host.
    // Negative: the environment variable DRAPE_CROSSOVER, and if that is empty, what is measured for the machine, the
    // device, m_mode, m_activation and m_reduceContacts: once, which takes a second or two while the first pipeline
    // with them is made, and kept in the cache folder (crossover-*.txt). Where other processes kept the machine busy
    // meanwhile, or its times varied widely, it is measured again at the next starts, three at most. With
    // m_profileKernels the device runs every step.
    double m_crossover = -1;

    // Contacts are reported up to thickness + m_activation × thickness, so that the solver knows of a surface before
    // the thickness is violated. Range 0 to 4. Larger: safer under stiff links, more contacts.
    float m_activation = 0.5f;

    // Leave out redundant contacts: those that others already enforce, up to 2 % of the thickness, within the distance
    // that nodes may go from their predicted paths while they are solved. Off: all contacts are solved; the same cloth
    // at rest, but for that.
    bool m_reduceContacts = true;

    // Continuous and Automatic find every face and edge that meets a feature of the obstacle on its linear way through
    // the step, at the earliest time; Discrete may lose what is faster than its thickness (README: how much it loses).
    ContactMode m_mode = ContactMode::Automatic;

    // Threads that hold the contacts of large cloths, and of many, in Bullet's solver, that write their nodes for a
    // GPU, and that the host back end computes on; the caller's among them. They sleep else. 0: as many as the process
    // may use cores, 8 at most. 1: the caller's alone. 64 at most. No trajectory depends on it.
    unsigned m_threads = 0;

    // Most pairs that a step may list (of features, on a GPU also of triangles and patches; up to 20 bytes each) and
    // most contacts (140 bytes each on a device, 200 on the host); 2^28 at most, which stands for more. Steps of two
    // million cloth triangles need a third of either. A step with more leaves out the cloths that have most of them,
    // until the rest fits, and says so in its status: those cloths collide with nothing in that step. Cloth that came
    // apart may make fewer, see kStepMotionHeldBack. Queries of whole meshes (drape/queries.h) test as many pairs and
    // list as many answers (8 to 24 bytes each); of more they give the number.
    std::size_t m_candidateLimit = std::size_t(1) << 27;
    std::size_t m_contactLimit = std::size_t(1) << 24;

    // Have the device time every kernel launch, for benchmarks over the core alone (Pipeline::takeKernelTimes(), which
    // is not installed). Costs some microseconds a launch.
    bool m_profileKernels = false;

    // Folder of compiled kernels and of what was measured. Empty: $XDG_CACHE_HOME/drape or ~/.cache/drape. "none": do
    // not cache. PoCL keeps its kernels itself, whatever is said here: in $XDG_CACHE_HOME/pocl or ~/.cache/pocl.
    std::string m_cacheFolder;

    // Gets a line, without a line feed, for what an app should know of its world and no return value says: a pair that
    // begins a step with intersecting triangles, cloth that is left out, a margin that is negative or as large as the
    // mesh. Once while it lasts, on the thread that steps the world. nullptr: no lines. What it throws is dropped.
    std::function<void(const char*)> m_log = logToStandardError;
};
}  // namespace drape
