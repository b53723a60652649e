// The plugin: one Drape pipeline with its device, and everything an app may ask it.
//
// Job: choose the device, keep the mirrors of cloths and obstacles, answer questions about the last step. Input:
// Settings. Guarantee: no exception leaves this class; when Drape cannot start, error() says why and every pair goes to
// Bullet's own algorithm. Where memory runs out, a call does what its comment says then; later calls and steps go on.
// All of it computes in the default floating-point environment, whatever traps, rounding or flushing the app has set,
// and leaves the app's as it was. SI units, world frame. C++11.
//
// Make it before the collision configuration and the solver; they keep its state alive, so that it may go before them,
// if Bullet's own rule holds (configuration and solver outlive the world). A dispatcher given to install() must be
// destroyed before the plugin. One plugin serves one thread; it may serve several worlds of that thread, each with a
// solver of its own. Several threads may have a plugin each. A dispatcher of several threads (btCollisionDispatcherMt)
// is not supported: Bullet's soft bodies are not safe with it either. A child that fork() makes has neither the
// plugin's threads nor its device: it must not use or destroy the plugin, and has to end by exec() or _exit().
//
// The thickness of a pair, at which cloth comes to rest, is the soft body's collision margin plus the mesh shape's
// margin (body->getCollisionShape()->getMargin() + shape->getMargin()); at least 0.1 mm. Bullet makes a soft body's
// margin 0.25 m.
//
// Kinematic rigid bodies move over the step by the velocity that Bullet derives, when stepSimulation() begins, from the
// interpolation transform and the world transform (or the motion state's). To teleport one, set both transforms to the
// new pose: Bullet's anchors, too, follow the velocity that it derives. Where the world transform alone is set, Drape
// takes a sudden change by more than the body's radius, or a right angle, for a teleport if cloth hangs on the body
// by an anchor or the app moved nodes of a cloth along with it, or if teleported() says so. A pose that is set later,
// by a tick's callback or while the body sleeps, is motion from the last one (DISABLE_DEACTIVATION keeps it awake). A
// body rests in the first step in which it is there. A change of a static object's pose, or of a child's in its
// compound, is a teleport.
//
// Cloth that begins a step with its triangles through a mesh, because it was put there or the mesh was, is reported
// (kStepStartsIntersecting) and pushed out of closed meshes; nodes are checked again wherever an app moves them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "drape/precision.h"
#include "drape/report.h"
#include "drape/settings.h"

class btCollisionObject;
class btCollisionShape;
class btCollisionWorld;
class btSoftBody;

namespace drape
{
class PluginState;

// One contact of the last step, for debugging and drawing; redundant ones, which others already enforce, are left out
// (Settings::m_reduceContacts). The pointers are those of that step: do not keep them.
struct ContactInfo
{
    const btSoftBody* m_cloth;
    const btCollisionObject* m_obstacle;
    int m_nodes[3];      // of the cloth feature, indices into m_cloth->m_nodes; -1 where unused
    float m_weights[3];  // of these nodes, sum 1
    float m_normal[3];   // unit, from the obstacle to the cloth
    float m_point[3];    // m, on the obstacle
    float m_gap;         // m, at the predicted end of the step, thickness subtracted
    float m_thickness;   // m
};

class Plugin
{
public:
    explicit Plugin(const Settings& settings = Settings());
    ~Plugin();
    Plugin(const Plugin&) = delete;
    Plugin& operator=(const Plugin&) = delete;

    bool ready() const;  // false: every pair goes to Bullet's own algorithm, as far as whyStock() has it
    // What failed, with the whole log; empty when nothing did. ready() all the same: the host took over from a device.
    // "out of memory" where there is none for the text, or was none for the plugin.
    std::string error() const;

    const DeviceReport& device() const;
    const StepStatistics& statistics() const;  // of the last step that one of this plugin's solvers solved
    // Of that step, in canonical order; made by the call. Empty where memory runs out.
    std::vector<ContactInfo> contacts() const;
    // Device, why it, and the last step in one line. "out of memory" where there is none for it.
    std::string report() const;

    // Empty when Drape handles the pair, else the reason why Bullet's own algorithm does. For a compound the first
    // child that Drape does not handle gives the reason; a mesh that does not lie where its compound does, which
    // Bullet's own would miss, is named as such. After an object got a shape of another kind, Bullet keeps what it
    // chose for the old one until its pairs are cleaned (cleanProxyFromPairs); this goes by the shape that it has. For
    // objects in a world the answer holds for that world's dispatcher and for the solver that steps it. Which solver
    // that is shows in the first step only: until then it is taken to be the soft body's own. "out of memory" where
    // that keeps it from telling.
    std::string whyStock(const btCollisionObject* objectA, const btCollisionObject* objectB) const;

    // Lists what is wrong with a world as far as the plugin can see, a line each; empty when nothing is: a world
    // without the plugin's solver or algorithm, pairs that are left to Bullet and why, cloth whose triangles intersect
    // a mesh or that lies inside of one, nodes that are not finite, margins that are negative or out of proportion, and
    // what the last step's status says. For development: it looks at every pair, which takes milliseconds to seconds.
    // Between steps. "out of memory" where that keeps it from telling.
    std::string diagnose(const btCollisionWorld& world) const;

    // Reads a soft body, or an obstacle's meshes (a compound's children, too), and brings them to the device: without
    // it the first step in which cloth comes near pays for that. What Drape does not handle costs nothing. Kept,
    // whether paired or not, until release(), before which the object must live; changes are noticed as of any other.
    // An object in a world or not; not while that is stepped. Where cost decides between host and device
    // (Settings::m_crossover), for the device, and for the host while all that is prepared may stay there. Where memory
    // runs out, nothing stays prepared, and cloth stands still in the next step, whose status says so.
    void prepare(const btCollisionObject* object);
    // All of a world's objects at once, which on the host takes less time than one after the other.
    void prepare(const btCollisionWorld& world);
    // From now on the object is kept as one that was never prepared: for two seconds of steps after its last pair. One
    // that was not prepared may be given.
    void release(const btCollisionObject* object);
    // All objects that are in a world.
    void release(const btCollisionWorld& world);

    // Says that vertices of a mesh shape were moved in place, and wakes soft bodies that sleep beside it. Refits (a
    // changed bounding box), scaling and changes that touch one of the vertices that are sampled each step are noticed
    // without it. What vertices moved since the step before is motion within the coming step, as a body's is; more than
    // half of the mesh's size is another pose, where cloth starts anew. In the first step that an obstacle has a soft
    // body near, it has not moved.
    void obstacleChanged(const btCollisionShape* shape);

    // Says that an obstacle or a soft body was put where it is and did not move there, or is about to be, before the
    // next step: nothing is swept on its way, and what intersects there is reported and pushed apart. Needed where an
    // app sets a kinematic body's world transform alone. Unknown objects are left as they are.
    void teleported(const btCollisionObject* object);

    // Whether only a mesh shape's front is solid, the side from which its triangles' corners run counter-clockwise:
    // cloth that is behind may come out instead of being caught inside. A mirrored mesh (scaled by a negative number)
    // keeps its front. Off unless it is switched on. The shape (a scaled one's own, or the mesh shape that it shows) is
    // remembered by its address until it is switched off again. Where memory runs out it stays as it was, and cloth
    // stands still in the next step, whose status says so.
    void setOneSided(const btCollisionShape* shape, bool oneSided);

    // For the other classes of this library.
    const std::shared_ptr<PluginState>& state() const { return m_state; }

private:
    std::shared_ptr<PluginState> m_state;
};
}  // namespace drape
