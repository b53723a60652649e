// A Bullet world with the drop scene in it, on one back end. Every back end gets the same bodies, springs and settings;
// they differ in the collision configuration and the soft body solver only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tools/cloth_drop/drop_scene.h"
#include "tools/cloth_drop/options.h"
#include "tools/cloth_drop/run_subject.h"
#include "tools/cloth_drop/step_parts.h"

class btCollisionWorld;

namespace drape
{
class Recorder;

struct StepTimes
{
    double m_stepMs = 0;       // wall time of stepSimulation
    double m_collisionMs = 0;  // part of the step: Bullet's collision detection and all work of Drape
    WholeStepParts m_parts;    // parts of m_stepMs; 0 for Bullet's own collision
    std::size_t m_contacts = 0;
    // Work counts as in StepStatistics; 0 for Bullet's own collision.
    std::uint64_t m_candidates = 0;
    std::size_t m_sweptTests = 0;
    std::size_t m_clothsSkipped = 0;
    std::size_t m_obstaclesKept = 0;
    bool m_skipped = false;
    bool m_onHost = false;
};

class Simulation
{
public:
    virtual ~Simulation() = default;

    // Runs one step of the scene's dt.
    virtual StepTimes step() = 0;

    // Returns x y z per cloth node, m; valid until the next step.
    virtual const std::vector<float>& positions() = 0;

    // Returns where the obstacles of the run are (run_subject.h).
    virtual std::vector<ObstacleFrame> obstacleFrames() const { return {ObstacleFrame()}; }

    // Returns the world, for a recorder.
    virtual const btCollisionWorld& world() = 0;
    // Tells a recorder the contacts of the last step that are not in Bullet's own lists.
    virtual void addContacts(Recorder&) const {}

    // Returns text for the report, as of the last step; an empty string if there is no device.
    virtual std::string backend() const = 0;
    virtual std::string device() const = 0;
    virtual std::string deviceReason() const = 0;
    // Returns who solves the cloth's links: drape or bullet.
    virtual std::string solver() const { return "bullet"; }
    virtual double prepareMs() const = 0;  // making the kernels and meshes ready, not part of any step

    // Returns one line if a device failed during the run and the back end changed, else "".
    virtual std::string trouble() const = 0;
};

// Makes the simulation with Bullet's own collision. Destroying it can take minutes (Bullet's distance field looks
// for each triangle).
std::unique_ptr<Simulation> makeBulletSimulation(const DropScene& scene, BulletMode mode);

// Makes the simulation with Drape on the chosen back end. Returns null with the reason in `error` and the exit code if
// it cannot start.
std::unique_ptr<Simulation> makeDrapeSimulation(const DropScene& scene, const Options& options, std::string& error,
                                                int& exitCode);
}  // namespace drape
