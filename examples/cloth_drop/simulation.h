// A Bullet world with the drop scene in it, on one back end. Every back end gets the same bodies, springs and settings;
// they differ in the collision configuration and the soft body solver only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "examples/cloth_drop/drop_scene.h"
#include "examples/cloth_drop/options.h"

namespace drape
{
// Of StepTimes::m_collisionMs, ms; see StepStatistics.
struct CollisionParts
{
    double m_dispatch = 0;  // Bullet's collision detection, and Drape's part in it
    double m_upload = 0;
    double m_wait = 0;
    double m_write = 0;
    double m_rounds = 0;  // and the look at strayed nodes
    double sum() const { return m_dispatch + m_upload + m_wait + m_write + m_rounds; }
};

struct StepTimes
{
    double m_stepMs = 0;       // wall time of stepSimulation
    double m_collisionMs = 0;  // of it: Bullet's collision detection, and all that Drape does
    CollisionParts m_parts;    // of that; 0 of the built-in
    std::size_t m_contacts = 0;
    // What Drape did for it, as in StepStatistics; 0 of the built-in.
    std::uint64_t m_candidates = 0;
    std::size_t m_sweptTests = 0;
    std::size_t m_reduced = 0;
    std::size_t m_clothsSkipped = 0;
    std::size_t m_obstaclesKept = 0;
    bool m_skipped = false;
    bool m_onHost = false;
};

class Simulation
{
public:
    virtual ~Simulation() = default;

    // One step of the scene's dt.
    virtual StepTimes step() = 0;

    // x y z per cloth node, m; valid until the next step.
    virtual const std::vector<float>& positions() = 0;

    // Text for the report, as of the last step; empty strings where there is no device.
    virtual std::string backend() const = 0;
    virtual std::string device() const = 0;
    virtual std::string deviceReason() const = 0;
    virtual double prepareMs() const = 0;  // making the kernels and meshes ready, not part of any step

    // One line when the back end left its path during the run (a device that failed), else empty.
    virtual std::string trouble() const = 0;
};

// Bullet's built-in collision. Destroying it can take minutes (Bullet's distance field looks for each triangle).
std::unique_ptr<Simulation> makeBulletSimulation(const DropScene& scene, BulletMode mode);

// Drape on the back end that the options name. Null with the reason in `error` and the exit code when it cannot start.
std::unique_ptr<Simulation> makeDrapeSimulation(const DropScene& scene, const Options& options, std::string& error,
                                                int& exitCode);
}  // namespace drape
