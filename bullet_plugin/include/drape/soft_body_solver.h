// Bullet's soft body solver with Drape's collision step and Drape's links.
//
// Pass it to btSoftRigidDynamicsWorld's constructor. solveConstraints() finds the contacts of the pairs noted during
// dispatch, waits for the device once (again if fast paths are cut short), then solves links and contacts in substeps.
// With Solver::Bullet, or for a body that Plugin::whyBulletSolves() names, Bullet iterates instead, with contact sweeps
// before each iteration and closing sweeps after the last. A body with contacts gets at least two iterations, unless
// its piterations is 0. Bodies without a time step stay unchanged, and bodies of another solver are left to Bullet. A
// kinematic mesh that comes near a sleeping body wakes it.
//
// Guarantee: no exception leaves this class. If memory runs out in a step, cloth that Drape handles stands still and
// the status reports kStepOutOfMemory. Cost: see StepStatistics. C++11.
#pragma once

#include <memory>

#include "BulletSoftBody/btDefaultSoftBodySolver.h"
#include "drape/export.h"
#include "drape/precision.h"

namespace drape
{
class Plugin;
class PluginState;

// Solves the soft bodies of one world. Bullet's m_rcontacts and m_scontacts hold the contacts of Bullet's own pairs
// only; Plugin::contacts() returns Drape's.
class DRAPE_EXPORT SoftBodySolver : public btDefaultSoftBodySolver
{
public:
    // Makes a solver that shares the plugin's state. If memory runs out it acts like Bullet's default solver, and
    // Plugin::whyStock() says so.
    explicit SoftBodySolver(Plugin& plugin);
    // Destroy the solver after the world that uses it.
    ~SoftBodySolver() override;

    // Predicts the soft bodies over `dt` (s). Called by Bullet.
    void predictMotion(btScalar dt) override;
    // Finds the contacts and solves the soft bodies over `dt` (s). Called by Bullet.
    void solveConstraints(btScalar dt) override;
    // Collides a soft body with another object, as Bullet's default solver does. Called by Bullet's own algorithms.
    void processCollision(btSoftBody* body, const btCollisionObjectWrapper* obstacle) override;
    // Collides two soft bodies, as Bullet's default solver does. Called by Bullet's own algorithms.
    void processCollision(btSoftBody* body, btSoftBody* other) override;
    // Updates the normals of the soft bodies. Called by Bullet.
    void updateSoftBodies() override;

private:
    struct DRAPE_HIDDEN Work;

    std::shared_ptr<PluginState> m_state;
    std::unique_ptr<Work> m_work;
};
}  // namespace drape
