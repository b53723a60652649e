// Bullet's default soft body solver with Drape's collision step in front of it and a closing contact pass behind it.
//
// Give it to btSoftRigidDynamicsWorld's constructor. In solveConstraints it sends the pairs noted during dispatch to
// the device, waits once, writes the contacts into the bodies, lets Bullet solve, and then moves nodes that Bullet's
// links pushed back into an obstacle out to the thickness again. Bodies of another solver are left to Bullet. C++11.
#pragma once

#include <memory>

#include "BulletSoftBody/btDefaultSoftBodySolver.h"

namespace drape
{
class Plugin;
class PluginState;

class SoftBodySolver : public btDefaultSoftBodySolver
{
public:
    explicit SoftBodySolver(Plugin& plugin);
    ~SoftBodySolver() override;

    void predictMotion(btScalar dt) override;
    void solveConstraints(btScalar dt) override;

private:
    std::shared_ptr<PluginState> m_state;
};
}  // namespace drape
