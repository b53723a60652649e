// What Drape tells about itself: the device it runs on and why, and what the last step did and cost.
// Times are milliseconds of wall time. C++11, no OpenCL header needed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace drape
{
struct DeviceInfo
{
    std::string m_platform;
    std::string m_name;
    std::string m_driver;
    bool m_isGpu = false;
};

struct DeviceReport
{
    bool m_onHost = true;      // the host back end computes
    DeviceInfo m_device;       // its name is "host" then
    std::string m_reason;      // one line: why this device and no other, with figures where cost decides
    double m_buildMs = 0;      // making the kernels ready, warm-up included
    bool m_fromCache = false;  // all of them were in Drape's cache; never on PoCL, which keeps its own

    // Where cost decides between the host and a device (Backend::Auto); then m_onHost, m_device and m_reason are those
    // of the last step with a pair, and of a scene without one before it.
    bool m_byCost = false;
    double m_expectedPairs = 0;  // of triangles: as many as there were, lay every cloth wholly on the obstacle where it
                                 // has most
    double m_crossover = 0;      // of these pairs: the host up to it, the device above; infinite: never
    // "measured now", "measured before", "set", or why such a device is not used, for example "its steps are not the
    // host's", as the error says, too. Measured ", on a busy machine" it is measured again at later starts, three at
    // most.
    std::string m_crossoverSource;
    double m_measureMs = 0;  // that it took to measure now
};

struct Settings;

// Every OpenCL device there is, in the order in which Drape would choose. Empty when there is none, and where memory
// runs out.
std::vector<DeviceInfo> listDevices();

// Whether what settings and DRAPE_DEVICE ask for is there: empty, or in one line why not and which devices there are.
// Where cost decides it also says what is wrong with DRAPE_CROSSOVER. "out of memory" where that is why it cannot tell.
std::string whyNoDevice(const Settings& settings);

// Bits of StepStatistics::m_status. Zero is a good step.
enum StepStatusBits : std::uint32_t
{
    kStepGood = 0,
    // Nodes that are NaN, infinite or beyond 2^30 m were left out.
    kStepInvalidNodes = 1u << 0,
    // The device failed; this and later steps run on the host.
    kStepDeviceFailed = 1u << 1,
    // A list needed more than the device can hold; the step ran on the host.
    kStepDeviceFull = 1u << 2,
    // Cloths that need too many tests collide with nothing in the step: the largest where there are more than
    // Settings::m_candidateLimit or m_contactLimit, and cloth that came apart and reaches across an obstacle.
    kStepClothsLeftOut = 1u << 3,
    // An obstacle reaches so far out that neighbouring floats are a thickness apart there.
    kStepCoarsePositions = 1u << 4,
    // A cloth and an obstacle began the step with triangles that intersect: the cloth is not guarded there.
    kStepStartsIntersecting = 1u << 5,
    // Faces of a soft body, or links that are not part of a surface, name another body's nodes and were left out.
    kStepFacesLeftOut = 1u << 6,
    // A cloth's links pulled it so far that it may have passed a surface; the next step checks it.
    kStepSurfacePassed = 1u << 7,
    // Nodes of a cloth that came apart went less far than they would have; its contacts are all there.
    kStepMotionHeldBack = 1u << 8,
    // Memory ran out in the step, or in a call before it: cloth that Drape takes stood still. Steps after it go on.
    kStepOutOfMemory = 1u << 9
};

// What StepStatistics::m_status says, in words: one clause a bit, joined by "; ". Empty for a good step. "out of
// memory" where there is none for the text.
std::string statusText(std::uint32_t status);

// One kernel launch as the device timed it; only with Settings::m_profileKernels.
struct KernelTime
{
    std::string m_kernel;
    double m_startMs = 0;  // since the first launch of the same list began
    double m_ms = 0;       // from its start to its end
};

// Memory that a device holds for one purpose.
struct MemoryUse
{
    std::string m_name;
    std::size_t m_bytes = 0;
};

struct StepStatistics
{
    std::uint32_t m_status = kStepGood;
    std::size_t m_clothTriangles = 0;
    std::size_t m_obstacleTriangles = 0;
    // Pairs of features that the broad phase left. A cloth that is left out counts up to one more than
    // Settings::m_candidateLimit.
    std::uint64_t m_candidates = 0;
    std::size_t m_sweptTests = 0;        // pairs of features that needed the continuous test
    std::size_t m_clothsLeftOut = 0;     // with kStepClothsLeftOut
    std::size_t m_contacts = 0;          // contacts published
    std::uint64_t m_selfCandidates = 0;  // pairs of features of cloths that collide with themselves
    std::size_t m_selfSweptTests = 0;    // of these, that needed the continuous test
    std::size_t m_selfContacts = 0;      // contacts of cloths with themselves
    std::size_t m_reduced = 0;           // contacts left out because others imply them
    std::size_t m_invalidNodes = 0;      // with kStepInvalidNodes
    // With kStepStartsIntersecting: pairs of a cloth and an obstacle that began the step with triangles that intersect,
    // and how many pairs of triangles these are. The adapter counts.
    std::size_t m_startsIntersecting = 0;
    std::uint64_t m_startIntersections = 0;
    std::size_t m_retries = 0;  // stages run again because a buffer was too small
    // What was there and not looked at, or used as it was left; contacts are the same without (tests/README.md).
    std::size_t m_clothsSkipped = 0;  // of the solver's: asleep as it began, pinned or without time; the adapter counts
    std::size_t m_obstaclesKept = 0;  // of the step's pairs: neither built, refitted nor placed anew
    bool m_skipped = false;           // nothing to do: no pair, or nothing that could touch
    bool m_onHost = false;            // the host back end ran the step, by choice or in place of the device
    // Together they are all of Drape's time in a solver's predictMotion and solveConstraints, and none of Bullet's.
    double m_uploadMs = 0;  // bounds, mirroring nodes and enqueueing
    double m_waitMs = 0;    // waiting for the device (all the work, on the host back end)
    double m_refitMs = 0;   // of the wait, on the host back end; a device's kernels are timed one by one
    double m_broadMs = 0;   // likewise
    double m_narrowMs = 0;  // likewise, with the canonical order
    double m_writeMs = 0;   // sorting contacts by body; cutting paths and what comes of it but the wait
    double m_finishMs = 0;  // contact rounds between and after Bullet's iterations, and the look at strayed nodes
    double collisionMs() const { return m_uploadMs + m_waitMs + m_writeMs + m_finishMs; }
};
}  // namespace drape
