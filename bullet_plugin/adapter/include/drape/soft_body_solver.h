// Bullet's default soft body solver with Drape's collision step in front of it and contact rounds between its
// iterations.
//
// Give it to btSoftRigidDynamicsWorld's constructor. In solveConstraints it sends the pairs noted during dispatch to
// the device, waits once (again when the paths of fast nodes had to be cut), and lets Bullet solve, iteration by
// iteration, with a round over the contacts before each and the closing rounds after the last. A body with
// contacts gets two iterations at least, whatever its piterations (but for 0). Bullet's m_rcontacts and
// m_scontacts hold Bullet's own contacts only; Plugin::contacts() has Drape's. A body whose step has no time (a step of
// 0, a timescale of 0 or less) stays as it is, and nothing is looked for. A body that sleeps is woken by a kinematic
// mesh that comes near it. Bodies of another solver are left to Bullet. One solver serves one world.
//
// No exception leaves this class. Where memory runs out in a step, cloth that Drape takes stands still in it, and the
// step's status says so (kStepOutOfMemory); the next step goes on. A solver that could not be made for want of memory
// acts as Bullet's default one, and Plugin::whyStock says so. C++11.
#pragma once

#include <memory>
#include <vector>

#include "BulletSoftBody/btDefaultSoftBodySolver.h"
#include "drape/precision.h"

namespace drape
{
class KinematicMotions;
class Plugin;
class PluginState;
struct StepObstacle;

class SoftBodySolver : public btDefaultSoftBodySolver
{
public:
    explicit SoftBodySolver(Plugin& plugin);
    ~SoftBodySolver() override;

    void predictMotion(btScalar dt) override;
    void solveConstraints(btScalar dt) override;

private:
    struct Work;

    void beginStep(btScalar dt, std::vector<StepObstacle>& obstacles);
    void listTaken();
    std::vector<StepObstacle> wakeReached(KinematicMotions& motions);
    void listPredicted();
    void coverMotions(const std::vector<StepObstacle>& obstacles);
    void detect();
    double solveBodies();
    void solveStep();
    void endFailedStep();

    std::shared_ptr<PluginState> m_state;
    std::unique_ptr<Work> m_work;
};
}  // namespace drape
