// Reports: the device in use, the reason for it, and the work and cost of the last step.
//
// Times are milliseconds of wall time. The records own their text. C++11, no OpenCL header.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "drape/export.h"

namespace drape
{
// Names an OpenCL device.
struct DeviceInfo
{
    std::string m_platform;  // name of the OpenCL platform
    std::string m_name;      // name of the device
    std::string m_driver;    // version of the driver
    bool m_isGpu = false;    // true for a GPU
};

// Describes the device in use and the reason for it.
struct DeviceReport
{
    // True if the host back end computes.
    bool m_onHost = true;
    // True while a device is looked for and its kernels are compiled in the background; the host computes meanwhile.
    bool m_isStarting = false;
    // The device; its name is "host" for the host back end.
    DeviceInfo m_device;
    // One line: the reason for this device, with figures if cost decides.
    std::string m_reason;
    // Time to load the kernels, warm-up included.
    double m_buildMs = 0;
    // True if every kernel came from Drape's cache. Always false on PoCL, which has its own cache.
    bool m_fromCache = false;

    // True if cost decides between the host and a device (Backend::Auto, ByCost). Then m_onHost, m_device and m_reason
    // describe the last step with a pair or, before it, a scene without one.
    bool m_byCost = false;
    // Estimated number of triangle pairs: the pairs there would be if every cloth lay wholly on the obstacle.
    double m_expectedPairs = 0;
    // Number of expected pairs above which the device is used; infinite means never.
    double m_crossover = 0;
    // Origin of the crossover: "measured now", "measured before", "set", or the reason why the device is not used. The
    // text ends in ", on a busy machine" if the measurement will be repeated, at three later starts at most.
    std::string m_crossoverSource;
    // Time of the measurement; 0 if there was none at this start.
    double m_measureMs = 0;
};

struct Settings;

// Returns every OpenCL device in Drape's order of preference. Empty if there is none or memory runs out.
DRAPE_EXPORT std::vector<DeviceInfo> listDevices();

// Returns an empty string if the device is available that `settings` and DRAPE_DEVICE request. Otherwise one line names
// the reason and the devices there are. If cost decides, it also checks DRAPE_CROSSOVER. "out of memory" if memory runs
// out.
DRAPE_EXPORT std::string whyNoDevice(const Settings& settings);

// Bits of StepStatistics::m_status. Zero is a good step.
enum StepStatusBits : std::uint32_t
{
    // The step is good.
    kStepGood = 0,
    // Nodes that are not finite or beyond 2^30 m were left out.
    kStepInvalidNodes = 1u << 0,
    // The device failed; this and later steps run on the host.
    kStepDeviceFailed = 1u << 1,
    // A list needed more memory than the device has; the step ran on the host.
    kStepDeviceFull = 1u << 2,
    // Cloths that need too many tests do not collide in this step: the largest ones beyond Settings::m_candidateLimit
    // or m_contactLimit, or cloth that came apart and reaches across an obstacle.
    kStepClothsLeftOut = 1u << 3,
    // An obstacle is so far from the origin that neighbouring floats differ by a thickness.
    kStepCoarsePositions = 1u << 4,
    // The triangles of a cloth and an obstacle intersected at the step's start; they are not guarded.
    kStepStartsIntersecting = 1u << 5,
    // Faces or links of a soft body name another body's nodes and were left out.
    kStepFacesLeftOut = 1u << 6,
    // The links of a cloth pulled it so far that it may have passed a surface; the next step checks it.
    kStepSurfacePassed = 1u << 7,
    // Nodes of a cloth that came apart moved less far than predicted; its contacts are complete.
    kStepMotionHeldBack = 1u << 8,
    // Memory ran out in the step or in a call before it. Cloth that Drape handles stood still; later steps go on.
    kStepOutOfMemory = 1u << 9,
    // Cloth meets itself or other cloth, or may: see StepStatistics::m_clothPairsMeeting.
    kStepClothsMeet = 1u << 10
};

// Returns `status` in words: one clause per bit, joined by "; ". Empty for a good step; "out of memory" if memory runs
// out.
DRAPE_EXPORT std::string statusText(std::uint32_t status);

// One kernel launch as the device timed it; needs Settings::m_profileKernels.
struct KernelTime
{
    std::string m_kernel;  // name of the kernel
    double m_startMs = 0;  // start, relative to the first launch of the same list
    double m_ms = 0;       // duration
};

// Device memory in use for one purpose.
struct MemoryUse
{
    std::string m_name;       // the purpose
    std::size_t m_bytes = 0;  // bytes allocated
};

// Counts of one step's meshes, pairs of features and contacts, over all cloths and obstacles. A step may search for
// contacts several times; these are the counts of the contacts that the solver received.
struct StepCounts
{
    // Number of cloth triangles.
    std::size_t m_clothTriangles = 0;
    // Number of obstacle triangles.
    std::size_t m_obstacleTriangles = 0;
    // Pairs of features that the broad phase found. A cloth that was left out adds one more than the limit at most.
    std::uint64_t m_candidates = 0;
    // Pairs of features that needed the continuous test.
    std::size_t m_sweptTests = 0;
    // Number of contacts.
    std::size_t m_contacts = 0;
    // Pairs of features of cloths that collide with themselves.
    std::uint64_t m_selfCandidates = 0;
    // Pairs among m_selfCandidates that needed the continuous test.
    std::size_t m_selfSweptTests = 0;
    // Contacts of cloths with themselves.
    std::size_t m_selfContacts = 0;
};

// Parts of a step's time in the calls of SoftBodySolver, all of its bodies together. They do not overlap, apart from
// the parts of m_waitMs.
struct StepParts
{
    // Time for pairs, mirrors of bodies and meshes, motions of obstacles, and bounds beside moving obstacles.
    double m_mirrorMs = 0;
    // Time of the prediction: forces, predicted positions, bounds, and velocities before it.
    double m_predictMs = 0;
    // Time for copying nodes for the detection and for enqueueing.
    double m_uploadMs = 0;
    // Time spent waiting for the device and for its contacts; all of the detection on the host back end. Where the
    // device solves a step behind its detection, the wait is for both.
    double m_waitMs = 0;
    // Part of m_waitMs for refitting; host back end only.
    double m_refitMs = 0;
    // Part of m_waitMs for the broad phase; host back end only.
    double m_broadMs = 0;
    // Part of m_waitMs for the narrow phase and the canonical order; host back end only.
    double m_narrowMs = 0;
    // Time for sorting contacts by body and for ending paths at the first impact, without waits and uploads.
    double m_writeMs = 0;
    // Time for reading links and nodes of bodies whose links Drape solves, and for finding contacts of cloth with
    // cloth.
    double m_readMs = 0;
    // Time for links in substeps, contact sweeps and motion limits. The sweeps between Bullet's iterations count, too.
    double m_solveMs = 0;
    // Time of Bullet's link solver.
    double m_bulletMs = 0;
    // Time for writing positions and velocities of bodies whose links Drape solves, and impulses of rigid bodies.
    double m_writeBackMs = 0;
    // Time for checking displaced nodes, without waits and uploads.
    double m_checkMs = 0;
    // Time of Bullet's normals of faces and nodes.
    double m_normalsMs = 0;

    // Returns the time for finding and solving contacts, for links, and for the guards: all of Drape's time but the
    // prediction and the normals.
    double collisionMs() const { return m_mirrorMs + m_uploadMs + m_waitMs + m_writeMs + solverMs(); }
    // Returns the part of collisionMs() that follows the detection.
    double solverMs() const { return m_readMs + m_solveMs + m_writeBackMs + m_checkMs; }
    // Returns the time of the solver's calls: collisionMs(), the prediction, the normals, and Bullet's part.
    double callsMs() const { return collisionMs() + m_predictMs + m_bulletMs + m_normalsMs; }
};

// The work and cost of one internal step of a world.
struct StepStatistics : StepCounts, StepParts
{
    // StepStatusBits.
    std::uint32_t m_status = kStepGood;
    // Number of cloths left out, with kStepClothsLeftOut.
    std::size_t m_clothsLeftOut = 0;
    // Number of nodes left out, with kStepInvalidNodes.
    std::size_t m_invalidNodes = 0;
    // Pairs of a cloth and an obstacle that started the step intersecting, with kStepStartsIntersecting.
    std::size_t m_startsIntersecting = 0;
    // Pairs of triangles that intersected at the step's start, with kStepStartsIntersecting.
    std::uint64_t m_startIntersections = 0;
    // Stages that ran again because a buffer was too small.
    std::size_t m_retries = 0;
    // Cloths without work: asleep at the step's start, pinned, or without a time step.
    std::size_t m_clothsSkipped = 0;
    // Cloths whose links and contacts an OpenCL device solved (Settings::m_solverPlace).
    std::size_t m_clothsSolvedOnDevice = 0;
    // Cloths whose nodes stayed on the device (Plugin::keepOnDevice()).
    std::size_t m_clothsKept = 0;
    // Times that the host waited for the device. Once, if the device solves all cloths of the step and no path of a
    // node meets a surface.
    std::size_t m_deviceWaits = 0;
    // Obstacles of the step's pairs that were not built, refitted or moved.
    std::size_t m_obstaclesKept = 0;
    // Nodes whose paths were shortened so that cloth does not meet itself or other cloth (Plugin::setSelfCollision()).
    std::size_t m_nodesShortened = 0;
    // Pairs of patches of cloth (16 triangles each) that were left out of the search for contacts of cloth with cloth,
    // since they lie too smoothly to touch.
    std::size_t m_clothPairsSkipped = 0;
    // Pairs of cloth that are not guarded, with kStepClothsMeet: triangles that intersect at the step's start, and
    // features that touch there or that pinned nodes bring together. Other pairs are guarded all the same.
    std::size_t m_clothPairsMeeting = 0;
    // True if there was nothing to do: no pair, or nothing that could touch.
    bool m_skipped = false;
    // True if the host back end ran the step, by choice or in place of the device.
    bool m_onHost = false;
};
}  // namespace drape
