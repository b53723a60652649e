// Settings of a plugin or of queries: where Drape computes, how it looks at motion, and its limits.
//
// Every field has a working default. A value out of range makes the constructor or create() fail with an Error that
// names the field. Lengths are metres. C++11, no OpenCL header.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "drape/export.h"

class btCollisionObject;

namespace drape
{
// Writes "drape: ", `line` and a line feed to standard error.
DRAPE_EXPORT void logToStandardError(const char* line);

// Selects where Drape computes.
enum class Backend
{
    // A GPU for scenes that are large enough for it, else the host. The GPU's kernels are compiled in the background,
    // and the host runs every step until then. The host remains if the GPU fails (error() then says why). OpenCL is not
    // loaded on a machine whose drivers are for its CPU.
    Auto,
    // An OpenCL device; a failure if there is none. The constructor waits for its kernels.
    OpenCl,
    // The host: the same functions compiled as C++, on m_threads threads and without OpenCL.
    Host,
    // Like Auto, but any OpenCL device, a CPU's too: for scenes for which the measurement says that the device pays.
    ByCost
};

// Selects how a step looks at the cloth's motion between its start and its end.
enum class ContactMode : std::uint32_t
{
    Discrete,    // looks at the end only; the fastest, for cloth that moves less than its thickness in a step
    Continuous,  // runs the certified continuous test on every candidate
    Automatic    // finds the contacts of Continuous, but runs the test only if motion is large enough
};

// Selects who moves cloth under its links and forces.
enum class Solver
{
    Auto,   // means Drape today; later versions may choose otherwise
    Drape,  // Drape for each soft body that it can solve (Plugin::whyBulletSolves()), Bullet for the others
    Bullet  // Bullet, with Drape's contacts between its iterations
};

// Selects where Drape's own solver computes.
enum class SolverPlace
{
    Auto,   // a GPU, once the bodies have 8,192 nodes for each thread of the host; kept bodies always; else the host
    Host,   // the host
    Device  // the plugin's OpenCL device, if it has one
};

// Selects who finds the contacts of cloth with shapes of one kind.
enum class ShapeContacts
{
    Drape,  // Drape: no triangle of the cloth passes through
    Bullet  // Bullet, which holds nodes alone, so that edges and fast or heavy bodies may pass
};

// Runs job(i) once for each i below `count`, in any order and on any threads, and returns when all have returned.
using ParallelFor = std::function<void(std::size_t count, const std::function<void(std::size_t)>& job)>;

// Holds the choices of an app before Drape starts.
struct Settings
{
    // Selects the back end. Default: Auto.
    Backend m_backend = Backend::Auto;

    // Part of an OpenCL device's or platform's name, case-insensitive; "host" selects the host back end. The
    // constructor waits for a named device. Empty means the environment variable DRAPE_DEVICE, and if that is empty
    // m_backend chooses.
    std::string m_device;

    // The scene size from which the device is used, in expected triangle pairs; applies to Backend::Auto and ByCost
    // without a named device. 0 means always the device, infinite always the host. A scene that shrinks returns to the
    // host below half of it. Negative (the default) means the environment variable DRAPE_CROSSOVER and, if that is
    // empty, a measurement. The measurement takes a second or two at the first start, in the background, and is kept in
    // the cache folder. It is repeated at the next starts, three at most, if the machine was busy. Contacts do not
    // depend on this.
    double m_crossover = -1;

    // Distance beyond the thickness up to which contacts are reported, as a fraction of the thickness. Range 0 to 4.
    // Larger values cost more contacts and were not safer in random worlds.
    float m_activation = 0.5f;

    // Selects how motion within a step is treated. Continuous and Automatic find every face and edge that meets a
    // feature of the obstacle on its straight path, at the earliest time. Discrete may miss faster motion than a
    // thickness per step.
    ContactMode m_mode = ContactMode::Automatic;

    // Selects the solver of links. Drape's divides a step into substeps, as many as the soft body has position
    // iterations (two at least), with passes over links, anchors and contacts in each. Cloth stretches several times
    // less than with Bullet's, and the threads share the links. Soft links (kLST below 1) keep their stiffness.
    Solver m_solver = Solver::Auto;

    // Selects where Drape's solver computes. The results do not depend on it.
    SolverPlace m_solverPlace = SolverPlace::Auto;

    // Selects who finds contacts with convex shapes of dynamic bodies: boxes, balls, hulls. Drape does so where it
    // solves the cloth, on the host; beside Bullet's contacts a device may solve it. Their meshes are always Drape's.
    ShapeContacts m_dynamicConvex = ShapeContacts::Drape;

    // Selects who finds contacts with convex shapes of static and kinematic bodies, and of links of a multibody.
    ShapeContacts m_staticConvex = ShapeContacts::Drape;

    // Selects who finds contacts with planes (btStaticPlaneShape) and height fields (btHeightfieldTerrainShape).
    ShapeContacts m_surfaces = ShapeContacts::Drape;

    // Lets cloth at rest fall asleep as Bullet's rigid bodies do, and with it the bodies that lie on it. Bullet never
    // does that in a btSoftRigidDynamicsWorld. Sleeping cloth costs nothing, and wakes when an obstacle that moves
    // comes near, if Drape finds its contacts. It does not notice forces, wind, and nodes or anchors that an app moves:
    // call activate() then.
    bool m_clothSleeps = false;

    // Number of threads, the caller's included: they solve contacts of large or many cloths, write nodes for a GPU, and
    // run the host back end. Range 0 to 64. 0 means the number of available cores, 8 at most; 1 means the caller's
    // thread alone. Results do not depend on it.
    unsigned m_threads = 0;

    // Runs Drape's jobs on the app's job system instead of Drape's own threads, which then never start. Empty by
    // default. Called many times a step by the thread that calls the plugin, with at most m_threads jobs of
    // microseconds to milliseconds. Any threads may run the jobs, at any time until the function returns; the calling
    // thread may be one of them. Meanwhile it must not call the plugin. Jobs never wait for one another, throw or call
    // this function. If the function throws, or runs some of the jobs only, the calling thread does the rest and the
    // exception is dropped, the first with a line of m_log. Not called if m_threads is 1. The measurement of
    // m_crossover does not use it. Results do not depend on it.
    ParallelFor m_parallelFor;

    // Largest number of candidates in a step, up to 20 bytes each; 2^28 at most. A step that exceeds it leaves out the
    // cloths with the most candidates and reports kStepClothsLeftOut. Queries of meshes test as many pairs.
    std::size_t m_candidateLimit = std::size_t(1) << 27;
    // Largest number of contacts in a step, 140 bytes each on a device and 200 on the host; 2^28 at most. Otherwise
    // like m_candidateLimit. Queries of meshes list as many answers.
    std::size_t m_contactLimit = std::size_t(1) << 24;

    // Makes the device time every kernel launch, for Drape's own benchmarks: every step runs on the device then.
    bool m_profileKernels = false;

    // Folder for compiled kernels and measurements. Empty means $XDG_CACHE_HOME/drape or ~/.cache/drape, on Windows
    // %LOCALAPPDATA%\\drape; "none" turns the cache off. PoCL always keeps its kernels itself, in $XDG_CACHE_HOME/pocl
    // or ~/.cache/pocl.
    std::string m_cacheFolder;

    // Receives one line without a line feed about what no return value reports. Setup: a device that is missing or
    // failed, a world without the solver or the collision configuration, two threads in one plugin. Kernels that were
    // compiled for more than half a second, with the time; three on PoCL, which hides its cache. The app: exceptions of
    // m_parallelFor and of a contact listener; calls without effect. Cloth: left out of a step, nodes that are not
    // finite, intersections at a step's start. Margins: negative, as large as the mesh, or a thickness out of
    // proportion to the edges of cloth or mesh. Obstacles: put elsewhere in step after step. Called once while the
    // problem lasts, on a thread that calls the plugin. nullptr means no lines. Exceptions from it are dropped. By
    // default lines go to standard error.
    std::function<void(const char*)> m_log = logToStandardError;

    // Returns the app's name for an object in lines of m_log and of Plugin::diagnose(). Lines have the address instead
    // if this is empty (the default), throws or returns an empty text. Called on a thread that calls the plugin; must
    // not call the plugin. A ClothWorld asks it only for what an app adds: its own bodies have their indices.
    std::function<std::string(const btCollisionObject&)> m_nameOf;
};
}  // namespace drape
