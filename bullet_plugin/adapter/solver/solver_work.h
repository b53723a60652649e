// The data that a SoftBodySolver keeps from step to step, and the parts of a step that go over all bodies.
//
// The order of a step is in solver_step.cpp, its begin with the prediction in solver_begin.cpp. What the core's solver
// takes of the bodies is in solver_work.cpp.
#pragma once

#include <algorithm>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_plugin/adapter/cloth_cloth/cloth_meetings.h"
#include "bullet_plugin/adapter/collision/collision_step.h"
#include "bullet_plugin/adapter/solver/bullet_links.h"
#include "bullet_plugin/adapter/solver/step_log.h"
#include "bullet_plugin/adapter/solver/substep_body.h"
#include "bullet_plugin/adapter/wiring/plugin_state.h"
#include "bullet_plugin/core/solver/step_solver.h"
#include "bullet_plugin/core/usage_watch.h"
#include "drape/soft_body_solver.h"

namespace drape
{
class KinematicMotions;
struct StepObstacle;

// Working data kept from step to step.
struct SoftBodySolver::Work
{
    using Bodies = btAlignedObjectArray<btSoftBody*>;

    Work(PluginState& state, const btSoftBodySolver& owner, const Bodies& bodies)
        : m_state(state),
          m_owner(owner),
          m_bodies(bodies),
          m_threads(state.threads()),
          m_solver(new StepSolver(m_threads)),
          m_failures(state.failures())
    {
    }

    bool isPredicted(const btSoftBody& body) const
    {
        return m_listed ? std::binary_search(m_predicted.begin(), m_predicted.end(), &body) : body.isActive();
    }
    bool isSolved(int body) const
    {
        const std::size_t at = static_cast<std::size_t>(body);
        return at < m_solved.size() && m_solved[at];
    }
    // Bullet's links would move the nodes of a body without time, and divide by that time: the result is NaN.
    bool isSteppedBody(const btSoftBody& body) const { return isPredicted(body) && body.m_sst.sdt > 0; }
    // Returns the object that solves the body's links in this step, null if Bullet does.
    SubstepBody* substepsOf(const btSoftBody& body) const
    {
        const auto found = m_substeps.find(&body);
        return found != m_substeps.end() && found->second->isPredicted() ? found->second.get() : nullptr;
    }
    BodyContacts* contactsOf(const btSoftBody& body) { return m_step ? m_step->contactsOf(body) : nullptr; }
    // Returns the body's entry of m_substeps; null if Bullet solves its links.
    SubstepBody* substepsAt(const btSoftBody& body) const;
    // Returns the number of nodes of a body whose links the core solves in this step; 0 for others.
    std::size_t substepNodes(const btSoftBody& body) const;
    // Returns the cloth of such a body.
    ClothContacts& clothOf(const btSoftBody& body);

    // The step, in this order. beginStep() is the part of predictMotion() before the prediction.
    void beginStep(btScalar dt, std::vector<StepObstacle>& obstacles);
    void solveStep();
    // Ends a step in which an exception was caught: Bullet solves the bodies that Drape does not handle, and Drape's
    // cloths stand still. Allocates no memory.
    void endFailedStep();
    // Prepares a body for Bullet's collision with an object, which reads the nodes and their tree. The object may have
    // moved since the step began.
    void readByBullet(btSoftBody& body, const btCollisionObject& object);
    // Returns whether Drape finds the contacts of the two bodies, so that Bullet need not.
    bool takesPair(const btSoftBody& body, const btSoftBody& other);

    // Parts of beginStep().
    void listTaken();
    std::vector<StepObstacle> wakeReached(KinematicMotions& motions);
    void wakeHit(btScalar dt);
    void listPredicted();
    void reserveSubsteps();
    void shareSubsteps(btScalar dt);
    void forgetRemoved();

    // Parts of solveStep().
    void leaveToBullet();
    void chooseStage();
    std::vector<PairNote> takeNotes();
    void detect();
    void endSubsteps();
    void solveBodies();
    void closeOffPath(const std::vector<BodyContacts*>& bodies);
    ClothRows* findMeetings();
    void recordSolved();
    std::vector<ContactPush> closingPushes();
    void guardMeetings(BodySet fixed);
    void holdJammed(const std::vector<const btSoftBody*>& jammed, const BodySet& fixed);
    void checkPaths(CollisionStep& step);
    void letSleep();

    // Returns false in a world without soft bodies, whose step must cost nothing: then no clock is read.
    bool hasBodies() const { return m_bodies.size() > 0; }
    // Begins the step. Returns whether there is nothing to do in it: the world has had no soft bodies for so long that
    // all which ages with the steps is gone.
    bool isIdle();

    // Prediction.
    void predict(const Bodies& bodies, btScalar dt);
    template <class Predict>
    void predictOne(btSoftBody& body, ThreadTeam* threads, const Predict& predict);
    void predictAndLeaveTree(btSoftBody& body, btScalar dt, ThreadTeam* threads);
    bool seesReads(const Bodies& bodies) const;

    // The solver's step.
    template <class Call>
    void forSubsteps(const Bodies& bodies, const Call& call);
    void beginSubsteps(const Bodies& bodies);
    void readPaths(const Bodies& bodies);
    void findSupported();
    void readSubsteps(const Bodies& bodies);
    void takeSubsteps(const Bodies& bodies);
    void addDynamicRows(SubstepBody& substeps, const BodyContacts& body);
    void takeBulletsBodies(const Bodies& bodies);
    bool mayFollow() const;
    bool submitBehind(const Bodies& bodies, const ContactSource& source);
    bool solveByBullet(const Bodies& bodies);

    // Bodies whose nodes are on the device (kept_bodies.h).
    void beginOnDevice(const Bodies& bodies);
    void bringToHost(btSoftBody& body);
    void bringToHostInStep(btSoftBody& body);
    template <class Needed>
    void bringToHostWhere(const Bodies& bodies, const Needed& isNeeded);
    void bringFreeToHost(const Bodies& bodies);
    void bringUnsolvedToHost(const Bodies& bodies);
    void bringAllToHost(const Bodies& bodies);
    std::size_t endKept(const Bodies& bodies);

    // Releases memory that only earlier, larger steps needed. Call before a step's begin().
    void giveBackRoom(PluginState& state)
    {
        m_solver.reset(new StepSolver(state.threads()));
        m_solver->recordImpulses(state.m_records.isOn());
        m_step->giveBackRoom();
        state.m_found.clear();
        state.pipeline().giveBackRoom();
    }

    PluginState& m_state;
    const btSoftBodySolver& m_owner;
    const Bodies& m_bodies;  // the solver's
    ThreadTeam& m_threads;
    btScalar m_dt = 0;                      // s, of the prediction
    std::unique_ptr<CollisionStep> m_step;  // null until it is needed
    ClothMeetings m_meetings{m_state};
    StepLog m_log{m_state};
    std::unique_ptr<StepSolver> m_solver;
    UsageWatch m_usage;
    std::unordered_map<const btSoftBody*, std::unique_ptr<SubstepBody>> m_substeps;  // bodies whose links Drape solves
    std::vector<const btSoftBody*> m_byBullet;  // bodies whose links Bullet solved last, sorted by address
    // Working memory of solveBodies(): bodies with pairs, those among them whose links Bullet solves, and others whose
    // links the core solves.
    std::vector<SolverCloth> m_touched;
    std::vector<std::unique_ptr<BulletLinks>> m_bulletLinks;
    std::vector<SolverCloth> m_free;
    RigidBodies m_rigidBodies;
    SupportedNodes m_supported;
    std::vector<std::pair<btSoftBody*, ClothContacts*>> m_ends;  // results to be written to the bodies
    std::vector<unsigned char> m_solved;                         // by body: solved by Bullet or by its contacts
    std::vector<btSoftBody*> m_taken;                            // bodies that Drape handles in this step
    std::vector<const btSoftBody*> m_predicted;                  // in this step, sorted by address
    bool m_listed = false;                                       // m_predicted is whole
    bool m_seesReads = false;                                    // see seesReads(), in this step
    bool m_detected = false;                                     // the paths of all bodies with a pair are recorded
    bool m_begun = false;                                        // beginSubsteps() was called in this step
    std::size_t m_onDevice = 0;                                  // cloths solved behind the detection
    SolveStage* m_stage = nullptr;                               // solves this step's cloths; null: the host does
    std::size_t m_asleep = 0;                                    // cloths that are not among them
    StepParts m_parts;                                           // parts of the running step, without its waits
    std::uint64_t m_failures;  // failures of the state that a step of this solver has reported
    static constexpr int kIdleAfter = 2 * UsageWatch::kWindow;
    bool m_isIdle = false;          // this step
    int m_emptySteps = kIdleAfter;  // since the last one with soft bodies, up to kIdleAfter
};
}  // namespace drape
