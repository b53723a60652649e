// State shared by Plugin, CollisionConfiguration, SoftBodySolver and the pair algorithms: the pipeline, the pairs
// noted since the last solve, and the mirrors of their bodies and meshes.
//
// Life of a pair: its algorithm notes it during dispatch (note), a solver takes the notes of its bodies
// (CollisionStep), and the algorithm's end forgets it. Notes are kept by algorithm, so they cannot pile up, and are
// dropped when a step begins. Mirrors outlive their pairs by kKeepSteps, because bouncing cloth loses and regains its
// pair repeatedly. Without a live algorithm, mirrors' pointers are only compared, never followed, and their contents
// are checked in full before use.
#pragma once

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h"
#include "BulletSoftBody/btSoftBodyConcaveCollisionAlgorithm.h"
#include "BulletSoftBody/btSoftRigidCollisionAlgorithm.h"
#include "drape/plugin.h"
#include "bullet_plugin/adapter/cloth_cloth/self_collision.h"
#include "bullet_plugin/adapter/collision/found_contacts.h"
#include "bullet_plugin/adapter/contacts/contact_records.h"
#include "bullet_plugin/adapter/kept/kept_bodies.h"
#include "bullet_plugin/adapter/motion/kinematic_motion.h"
#include "bullet_plugin/adapter/mirrors/mirrors.h"
#include "bullet_plugin/adapter/motion/node_tree.h"
#include "bullet_plugin/adapter/pairs/pair_algorithm.h"
#include "bullet_plugin/adapter/wiring/thread_watch.h"
#include "bullet_plugin/core/pipeline/pipeline.h"
#include "bullet_plugin/core/public_call.h"
#include "bullet_plugin/core/threads/thread_team.h"

class btCollisionConfiguration;
class btCollisionDispatcher;
class btSoftBodySolver;

namespace drape
{
struct PairNote
{
    const void* m_owner;  // the algorithm
    const btSoftBodySolver* m_solver;
    btSoftBody* m_cloth;
    ObstacleKey m_obstacle;
    bool m_isMovable;  // else the obstacle rests at the motion's end
    const btCollisionObject*
        m_mover;                // a dynamic body or a multibody's link, which Bullet moves in the step; else null
    btRigidBody* m_dynamic;     // the obstacle's body if it is dynamic, else null
    bool m_yields;              // such a body yields to the cloth
    btTransform m_noted;        // pose of the object at the step's start
    btTransform m_place;        // the shape's pose in it
    bool m_movesPlace = false;  // m_place changes in the step
    btVector3 m_velocity;       // m/s, of a dynamic body at dispatch
    BodyMotion m_motion;        // the shape's motion; the shape may be a compound's child
    btScalar m_thickness;

    // Ends the motion of what Bullet moves where it stands.
    void endMotion()
    {
        const btTransform& pose = m_mover->getWorldTransform();
        m_motion.m_end = pose == m_noted && !m_movesPlace ? m_motion.m_start : pose * m_place;
    }
};

class PluginState
{
public:
    explicit PluginState(const Settings& settings);
    PluginState(const PluginState&) = delete;
    PluginState& operator=(const PluginState&) = delete;

    bool ready() const { return m_pipeline != nullptr; }
    // The reason why Drape could not start, or the device's failure after which the host took over.
    const Error& error() const { return m_pipeline ? m_pipeline->lastError() : m_error; }
    const DeviceReport& device() const;
    Pipeline& pipeline() { return *m_pipeline; }
    const Pipeline& pipeline() const { return *m_pipeline; }
    const Settings& settings() const { return m_settings; }
    // The pipeline's; they outlive it.
    ThreadTeam& threads() { return *m_threads; }
    // Hands a line to Settings::m_log.
    void log(const std::string& line) const;
    // Returns the name of an object in lines: Settings::m_nameOf's, or its kind and address.
    std::string nameOf(const btCollisionObject& object) const;
    // Returns "A and B", or "A and itself" for one object.
    std::string namesOf(const btCollisionObject& a, const btCollisionObject& b) const;
    // Begins a call that uses the pipeline, and reports a second thread in one at the same time. Keep the result until
    // the call ends.
    ThreadWatch::Call beginCall();
    // Takes a device that was started in the background; waits for it if `wait`. Call between steps.
    void takeDevice(bool wait);
    // Handles an exception that ended a call at an unknown point of the pipeline's work. If memory ran out, the
    // pipeline begins anew without meshes; otherwise every pair goes to Bullet from now on.
    void fail(const char* call, const CaughtException& caught) noexcept;
    // Counts up with each fail().
    std::uint64_t failures() const { return m_failures; }
    // Returns whether a step without soft bodies would change nothing, and nobody would be told of it.
    bool isSettled() const
    {
        return ready() && !m_mustRestart && !m_listener && !device().m_isStarting && !m_pipeline->deviceFailed();
    }
    // Restarts the pipeline if fail() requested it. Throws if memory is still short.
    void restart();

    btCollisionAlgorithmCreateFunc& createFunction(bool swapped)
    {
        m_isWired = true;
        return swapped ? m_createSwapped : m_create;
    }
    // Returns whether any dispatcher was given the plugin's algorithms.
    bool isWired() const { return m_isWired; }
    // Returns the function that makes Bullet's own algorithm beside a shape of that type.
    btCollisionAlgorithmCreateFunc& stockCreateFunction(int shapeType, bool swapped);

    void addSolver(const btSoftBodySolver* solver);
    void removeSolver(const btSoftBodySolver* solver);
    bool ownsSolver(const btSoftBodySolver* solver) const;
    // Begins a step of the solver: takes a device that has become ready, and lists the step's bodies. They stay listed
    // until its next step.
    void beginStep(const btSoftBodySolver* solver, const btAlignedObjectArray<btSoftBody*>& bodies);
    // Returns the solver of this plugin that stepped the body last, in the world that the body is in now; null for
    // none. A body's own solver may be another one: btSoftBody::setSoftBodySolver() does not change who steps it.
    const btSoftBodySolver* steppingSolver(const btSoftBody& body) const;
    // Forgets what the log has about worlds with that solver, dispatcher or collision configuration, since another one
    // may get its address.
    void forgetWorlds(const void* gone);
    // Records that a dispatcher had a pair of the body while no solver of this plugin steps it.
    void markUnstepped(const btSoftBody& body);
    // Returns whether a solver of this plugin steps the body, or will as far as is known.
    bool steps(const btSoftBody& body) const;
    // Returns the state of the node tree of a body that the solver steps; null if it is not listed.
    NodeTree* nodeTreeOf(const btSoftBodySolver* solver, const btSoftBody& body);
    // Records that the body's nodes have moved.
    void leaveNodeTree(const btSoftBody& body);
    // Brings the body's node tree up to date if a step of Drape left it behind. Allocates no memory.
    void updateNodeTree(btSoftBody& body);
    // Returns the motions of kinematic objects in the step of that solver's world.
    KinematicMotions& motionsOf(const btSoftBodySolver* solver) { return m_motions[solver]; }

    void note(const void* owner, btSoftBody& cloth, const btCollisionObjectWrapper& obstacle);
    void forget(const void* owner);
    // Forgets the algorithm's pair in the coming step alone.
    void forgetNote(const void* owner);
    // Makes the object's mirrors, those of a compound's children, and uploads them to the device. They are owned as if
    // by an algorithm until release().
    void prepare(const btCollisionObject* const* objects, int count);
    void release(const btCollisionObject* object);
    void obstacleChanged(const btCollisionShape* shape);
    // Marks the soft body or obstacle as displaced since its last step, or as not guarded by that step. Its pairs
    // start anew from their positions in the coming step, and are checked for intersections then. Does nothing
    // without a mirror: new pairs are checked anyway.
    void startAnew(const btCollisionObject* object);
    // Declares that the object was placed instead of moved: no solver's next step treats its pose as a motion, and
    // its pairs start anew.
    void teleported(const btCollisionObject* object);
    // Returns whether one of these bodies is anchored to the object, or an app moved nodes of one as the map does,
    // since the last step, in which the body took part.
    bool movedAlong(const std::vector<btSoftBody*>& bodies, const btCollisionObject& object, const btTransform& map,
                    btScalar slack);
    void setOneSided(const btCollisionShape* shape, bool oneSided);
    void setTriangleFilter(const btCollisionShape* shape, TriangleFilter filter);
    // Returns null if the shape has none.
    const TriangleFilter* triangleFilterOf(const btCollisionShape& shape) const;
    void dropNotes(const btSoftBodySolver* solver);
    // Takes the notes of the given cloths, which are sorted by address. Omits obstacles whose noted shape is gone.
    std::vector<PairNote> takeNotes(const btSoftBodySolver* solver, const std::vector<const btSoftBody*>& cloths);

    // Gives a kept body on the device the nodes of the last step's end. They count as that step's own.
    void bringToHost(btSoftBody& body);
    // Returns the mirrors of a noted pair, and makes missing ones. Counts the step for dropOldMirrors().
    ClothMirror& clothMirror(const PairNote& note);
    ObstacleMirror& obstacleMirror(const PairNote& note);
    // Returns the body's mirror; null if there is none.
    const ClothMirror* mirrorOf(const btSoftBody& body) const;
    void dropOldMirrors();

    // Calls the listener, if there is one, with the records of a step of the solver. timeStep: s.
    void tellContacts(const btSoftBodySolver* solver, double timeStep);
    // Returns a remark about an object that is put elsewhere beside cloth in step after step; empty if it is not.
    std::string jumpRemark(const btCollisionObject& object) const;
    // Logs that a thickness of cloth with cloth is negative, or no number.
    void tellThickness(const btSoftBody& body, double thickness) const;
    // Logs that a call of Plugin has no effect on a shape. whatFor: the shapes on which it has one.
    void tellNoEffect(const btCollisionShape& shape, const char* call, const char* whatFor) const;
    // Logs kernels that were compiled since the device was taken, such as those of cloth with cloth.
    void tellCompiled();
    // Logs a failure of the app's job system.
    void tellJobs();

    StepStatistics m_statistics;
    ContactRecords m_records;
    bool m_asksRecords = false;                         // Plugin::recordContacts()
    std::shared_ptr<const ContactListener> m_listener;  // null for none
    FoundContacts m_found;
    KeptBodies m_kept{*this};
    SelfCollision m_selfCollision;
    std::vector<ClothPairInfo> m_clothPairs;  // triangles that intersected where the last step began
    std::vector<FlaggedPair> m_flagged;       // other pairs of the last step

private:
    struct Owned
    {
        const btSoftBody* m_cloth;
        ObstacleKey m_obstacle;
    };

    // A body in the world to which its proxy belongs.
    struct WorldBody
    {
        const btSoftBody* m_body;
        const btBroadphaseProxy* m_proxy;
        mutable NodeTree m_tree;  // changes while the body stays listed
    };
    using WorldBodies = std::vector<WorldBody>;  // sorted by body

    static const WorldBody* findIn(const WorldBodies& bodies, const btSoftBody& body);

    void prepareCloth(const btSoftBody& body);
    void prepareShape(const btCollisionObjectWrapper& wrap);
    bool isOneSided(const btCollisionShape& shape) const;
    ClothMirror* findCloth(const btSoftBody* body);
    ObstacleMirror* findObstacle(const ObstacleKey& key);
    void adopt(const PairNote& note);
    void settleMotion(PairNote& note);
    void disown(const Owned& owned);
    template <class Drops>
    void dropNotesIf(const Drops& drops);
    void prepareAll(const btCollisionObject* const* objects, int count);
    // Forgets all pairs and their meshes.
    void forgetScene() noexcept;
    // Reports in the log what the pipeline says of its device.
    void tellDevice();
    // Reports kernels if they were compiled for long.
    void tellKernels(const char* which, double ms) const;
    // Reports a world of these bodies once if its dispatcher gives this plugin no pairs. Checks the worlds of bodies
    // that the solver's last step did not have.
    void tellDispatchers(const btSoftBodySolver* solver, const btAlignedObjectArray<btSoftBody*>& bodies);
    void tellDispatcher(const btSoftBodySolver* solver, const btSoftBody& body);
    // Reports an obstacle of which a mirror has begun to jump often, unless another one of its mirrors did before.
    void tellJumps(const btCollisionObject& object);
    // Returns whether the log has a line about that world.
    bool isToldOf(const void* place, const btDispatcher* dispatcher) const;

    const Settings m_settings;
    std::unique_ptr<Pipeline> m_pipeline;
    std::shared_ptr<ThreadTeam> m_threads;
    Error m_error;
    DeviceReport m_failedDevice;
    std::string m_failedReason = "an exception ended a call, see Plugin::error()";  // made before it is needed
    std::uint64_t m_failures = 0;
    bool m_mustRestart = false;
    double m_toldCompileMs = 0;                       // the log has these compilations
    bool m_toldError = false;                         // the log has the device's failure
    bool m_toldListener = false, m_toldJobs = false;  // the log has an exception of the app's function
    PairCreateFunction m_create, m_createSwapped;
    btSoftBodyConcaveCollisionAlgorithm::CreateFunc m_stockCreate;
    btSoftBodyConcaveCollisionAlgorithm::SwappedCreateFunc m_stockCreateSwapped;
    btSoftRigidCollisionAlgorithm::CreateFunc m_stockConvexCreate, m_stockConvexCreateSwapped;

    bool m_isWired = false;
    std::vector<const btSoftBodySolver*> m_solvers;
    std::unordered_map<const btSoftBodySolver*, WorldBodies> m_stepped;
    std::unordered_map<const btSoftBody*, const btBroadphaseProxy*> m_unstepped;
    std::unordered_map<const btSoftBodySolver*, KinematicMotions> m_motions;
    std::vector<PairNote> m_notes;                          // in the order of dispatch
    std::unordered_map<const void*, std::size_t> m_noteOf;  // indices in them, by owner
    std::unordered_map<const void*, Owned> m_owned;
    std::unordered_map<const btSoftBody*, ClothMirror> m_cloths;
    std::unordered_map<ObstacleKey, ObstacleMirror, ObstacleKeyHash> m_obstacles;
    std::unordered_set<const btCollisionShape*> m_oneSided;  // compared, never followed
    std::unordered_map<const btCollisionShape*, TriangleFilter> m_filters;
    std::uint64_t m_step = 0;
    ThreadWatch m_calls;
    // A world that the log has a line about. Addresses are compared and never followed.
    struct ToldWorld
    {
        const void* m_place;  // the solver, or without one of this plugin the world's data for soft bodies
        const btDispatcher* m_dispatcher;
        const btCollisionConfiguration* m_configuration;
    };
    std::vector<ToldWorld> m_toldWorlds;
};
}  // namespace drape
