// One soft body whose motion and links Drape solves itself, in substeps of the step. Bullet predicts; this class
// replaces btSoftBody::solveConstraints().
//
// Forces and velocities are Bullet's: what predictMotion() adds to a velocity is the acceleration of the step. Every
// substep moves the nodes, lets the caller solve contacts, sweeps over the links and derives the velocities anew. Links
// keep the stiffness that Bullet's iterations give them (core/solver/link_strength.h). The body's own numbers are read
// in every step, so changes between steps count in the next one. Cost: linear in nodes and links.
#pragma once

#include <cstddef>
#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_plugin/core/solver/link_sweep.h"
#include "bullet_plugin/core/solver/solver_nodes.h"
#include "bullet_plugin/core/threads/thread_team.h"

namespace drape
{
class SubstepBody
{
public:
    // The predicted end of a node, m, and the way to it without the rounding of positions.
    struct Prediction
    {
        btVector3 m_end, m_way;
    };

    // Returns why Bullet's own solver must solve the body; null if this class can.
    static const char* reasonForBullet(const btSoftBody& body);
    // Returns why Bullet must solve the step that has been predicted: contacts of its own algorithms count, too.
    static const char* reasonForBulletNow(const btSoftBody& body);

    // Records the velocities before the body's predictMotion(). Does nothing for a body that sleeps.
    void beforePrediction(const btSoftBody& body);
    // Brings the predicted positions to where substeps take free nodes. Call after predictMotion(), with the same
    // nodes.
    void afterPrediction(btSoftBody& body);
    // Returns whether the body has the nodes of the prediction.
    bool fits(const btSoftBody& body) const;
    // Leaves the step to Bullet, with Bullet's prediction.
    void leave(btSoftBody& body);
    // Returns whether this object solves the coming step.
    bool isPredicted() const { return m_isPredicted; }

    // Returns the number of substeps: piterations, but at least kLeastSubsteps.
    static int substepsOf(const btSoftBody& body);

    // Begins the step: the nodes return to their starts. Their paths lead to their current positions. threads: null
    // for the caller alone, as in the functions below.
    void begin(btSoftBody& body, ThreadTeam* threads);
    // Begins a substep: moves the nodes and sweeps over the links.
    void advance(btSoftBody& body, ThreadTeam* threads);
    // Ends a substep: derives the nodes' velocities from their positions.
    void endSubstep(btSoftBody& body, ThreadTeam* threads);
    // Runs the whole step of a body without contacts.
    void solveAlone(btSoftBody& body, ThreadTeam* threads);

private:
    static constexpr int kLeastSubsteps = 2;
    // Sweeps over the links in each substep. A sweep costs little beside one over the contacts.
    static constexpr int kLinkSweeps = 3;

    void readTopology(const btSoftBody& body);
    void readLinks(const btSoftBody& body);
    void readPosition(std::size_t node, const btVector3& position);
    void buildLinks(const btSoftBody& body);
    void moveNodes(ThreadTeam* threads);
    void writeNodes(btSoftBody& body, ThreadTeam* threads) const;

    bool m_isPredicted = false;
    float m_kept = 1;                        // the share of a velocity that damping leaves in a substep
    std::vector<btVector3> m_velocities;     // velocities before the prediction, m/s
    std::vector<btVector3> m_accelerations;  // accelerations of the step, m/s²
    std::vector<Prediction> m_predictions;
    std::vector<LinkNodes> m_links;  // links as sorted into m_sweep
    SolverNodes m_nodes;
    LinkSweep m_sweep;
};
}  // namespace drape
