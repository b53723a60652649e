// The plugin: one Drape pipeline with its device, and the questions an app may ask about it.
//
// Input: Settings. Guarantee: no exception leaves this class. If Drape cannot start, error() says why and Bullet's own
// algorithm handles every pair. Calls compute in the default floating-point environment and restore the app's. SI
// units, world frame. C++11.
//
// Make the plugin before the collision configuration and the solver. They share its state, so the plugin may be
// destroyed first; a dispatcher given to install() must be destroyed before the plugin. A plugin belongs to one thread
// at a time and serves any number of worlds, each with its own solver; two threads must not call it at once.
// btCollisionDispatcherMt is not supported. A child made by fork() must not use or destroy the plugin; it must end with
// exec() or _exit().
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "drape/contacts.h"
#include "drape/export.h"
#include "drape/node_arrays.h"
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

// One contact of the last step, for debugging and drawing. The pointers are valid until the objects are removed; do not
// keep them over a step.
struct ContactInfo
{
    const btSoftBody* m_cloth;            // the cloth
    const btCollisionObject* m_obstacle;  // the obstacle
    int m_nodes[3];                       // indices of the cloth feature in m_cloth->m_nodes; -1 if unused
    float m_weights[3];                   // weights of these nodes, with the sum 1
    float m_normal[3];                    // unit vector from the obstacle to the cloth
    float m_point[3];                     // point on the obstacle, m
    float m_gap;                          // distance at the step's predicted end, thickness subtracted, m
    float m_thickness;                    // thickness of the pair, m
};

// Two triangles of cloth that intersected where the last step began. The pointers are valid until the bodies are
// removed; do not keep them over a step.
struct ClothPairInfo
{
    const btSoftBody* m_bodies[2];  // each triangle's; one body twice if it intersects itself
    int m_nodes[2][3];              // indices of each triangle's nodes in its body's m_nodes
};

// Returns whether a triangle of a shape collides with cloth. part, triangle: indices as Bullet gives them to a
// btTriangleCallback; in a height field 2 x or 2 x + 1, and j, for the two triangles of the cell (x, j).
using TriangleFilter = std::function<bool(int part, int triangle)>;

// Owns the device and the copies of cloths and obstacles on it.
//
// The thickness of a pair is the soft body's collision margin plus the mesh shape's margin, and at least 0.1 mm. Cloth
// comes to rest at this distance. Bullet's default margin of a soft body is 0.25 m; set a smaller one.
//
// A kinematic rigid body moves over the step with the velocity that Bullet derives from its interpolation transform and
// its world transform or motion state. To teleport it, set both transforms. If only the world transform is set, a
// change by more than the body's radius, or a right angle, can be a teleport. Drape treats it as one if cloth is
// anchored to the body, if the app moved nodes along with it, or after teleported(). A body is at rest in its first
// step. A change of a static object's pose is a teleport. A child whose pose in its compound changes moves within the
// step; beyond its own size or a right angle it is a teleport.
//
// If memory runs out, a call does what its comment says, and later calls and steps go on.
class DRAPE_EXPORT Plugin
{
public:
    // Returns within milliseconds if the settings name no device; the host then computes until a GPU is ready, see
    // DeviceReport. Otherwise waits until the device's kernels are compiled. Failures are in error().
    explicit Plugin(const Settings& settings = Settings());
    // Releases the pipeline unless a configuration or solver still uses it. Releasing it stops a start in the
    // background, and waits for the program that the device's driver is compiling.
    ~Plugin();
    // A plugin owns a device: no copies.
    Plugin(const Plugin&) = delete;
    // A plugin owns a device: no copies.
    Plugin& operator=(const Plugin&) = delete;

    // Returns true if Drape runs. If false, Bullet's own algorithm handles every pair.
    bool ready() const;
    // Returns the failure with its whole log; empty if there was none. May be set although ready() is true: then the
    // host took over from a device. "out of memory" if memory ran out.
    std::string error() const;

    // Waits until the start in the background has ended, if there is one. Steps of the world move to the device by
    // themselves once it is ready; this is for apps that load a level meanwhile, and for measurements.
    void awaitDevice();

    // Returns the device and the reason for it. Valid as long as the plugin.
    const DeviceReport& device() const;
    // Returns the statistics of the last internal step of any world of the plugin. Valid as long as the plugin. One
    // call of stepSimulation() may run several such steps, or none. A pre-tick callback sees the step before it; a
    // post-tick callback comes before Bullet solves soft bodies. Steps of a world without soft bodies do not count if
    // it never had one, or none for 1,200 steps.
    const StepStatistics& statistics() const;
    // Returns the contacts of that step in canonical order; the call makes the list. Empty if memory runs out.
    std::vector<ContactInfo> contacts() const;
    // Returns the triangles of cloth that intersected where that step began, among bodies of setSelfCollision(). Empty
    // if memory runs out.
    std::vector<ClothPairInfo> clothPairs() const;
    // Returns the pairs of triangles or features that step could not keep apart: those that intersected or touched
    // where it began, and cloth that pinned nodes bring together. Empty if memory runs out.
    std::vector<FlaggedPair> flaggedPairs() const;

    // Keeps the contacts of each coming step with their impulses, for stepContacts(). Off by default; off costs nothing
    // and forgets them with the next step. On, steps give the same results, but the host solves all cloth, kept bodies
    // included. If memory runs out in a step, the step ends like any other without memory, and has no records.
    void recordContacts(bool record);
    // Returns the contacts of the last internal step of any world of the plugin, within the activation distance, with
    // obstacles, other cloth and the cloth itself. Empty unless recordContacts() or a listener was on in that step, and
    // after a step that failed. Valid until the next step begins.
    const std::vector<StepContact>& stepContacts() const;
    // Calls the listener at the end of each internal step of a world of the plugin, with the contacts of that step. The
    // call comes from the thread that steps the world, within stepSimulation(), when soft bodies have their final
    // positions and velocities and before Bullet's normals follow. The listener may read the world and call this
    // class's const functions and setContactListener(); it must not change the world. Its exceptions are dropped, the
    // first with a line of Settings::m_log. Null removes it. The step has the cost of recordContacts() while there is
    // one. Steps that fail, or run without Drape, make no call. If memory runs out, nothing changes.
    void setContactListener(ContactListener listener);

    // Returns one line with the device, the reason for it and the last step. "out of memory" if memory runs out.
    std::string report() const;

    // Returns an empty string if Drape handles the pair, otherwise the reason why Bullet's own algorithm does. For a
    // compound the first child that Drape does not handle gives the reason. For objects in a world the answer is about
    // that world's dispatcher and solver; before the first step the solver is taken from the soft body. "out of memory"
    // if memory runs out.
    std::string whyStock(const btCollisionObject* objectA, const btCollisionObject* objectB) const;

    // Returns an empty string if Drape solves the soft body's links (Settings::m_solver), otherwise the reason why
    // Bullet does. The answer is about the coming step, as far as the body's own numbers tell: contacts that Bullet's
    // own algorithm finds in a step leave that step to Bullet. "out of memory" if memory runs out.
    std::string whyBulletSolves(const btSoftBody& body) const;

    // Lists the problems of a world, a line for each with the number of bodies that have it; empty without any. Checks
    // the world's solver and dispatcher, pairs and links left to Bullet other than by Settings::m_solver, cloth that
    // intersects a mesh or lies inside one, nodes that are not finite, and margins out of proportion. Adds what the
    // last steps found: cloth that meets cloth, with counts, obstacles that teleport in step after step, and the
    // status. Fetches the nodes of kept bodies. For development: takes milliseconds to seconds. Call between steps.
    // "out of memory" if memory runs out.
    std::string diagnose(const btCollisionWorld& world) const;

    // Brings a soft body or an obstacle's meshes to the device, so that the first step near it does not pay for this.
    // The object need not be in a world. It is kept until release(); it must live until then. Objects that Drape does
    // not handle cost nothing. Call between steps. If memory runs out, nothing is prepared, and cloth stands still in
    // the next step with kStepOutOfMemory.
    void prepare(const btCollisionObject* object);
    // Prepares all objects of a world at once, which is faster on the host.
    void prepare(const btCollisionWorld& world);
    // Ends prepare(): the object is kept for two seconds of steps after its last pair. Accepts objects that were never
    // prepared.
    void release(const btCollisionObject* object);
    // Releases all objects of a world.
    void release(const btCollisionWorld& world);

    // Leaves a soft body's nodes on the device from the end of its next step on, so that a step copies none of them.
    // Bullet's nodes then stay as they are until fetch(). Changes that an app makes to them meanwhile are ignored, and
    // so are forces (addForce(), addVelocity()). Positions of pinned nodes count, and masses from the next step on the
    // host. To change the nodes, call fetch(), set them, and call takeNodes().
    //
    // A step that needs the nodes on the host brings them there by itself, and computes the same. It does so beside
    // objects whose contacts Bullet's own algorithm finds, at impacts, in free fall, and with moved pins or another
    // time step. StepStatistics::m_clothsKept counts the others.
    //
    // Returns an empty string, or why the body cannot be kept; "out of memory" if memory runs out. The body must stay
    // alive and in its world until `keep` is false, which fetches its nodes. If the device fails, the nodes of the last
    // fetch() remain. If memory runs out in a step, all bodies get their nodes and are kept no more. Once the plugin is
    // destroyed, bodies get theirs in the next step. No call tells whether a body is still kept: call keepOnDevice()
    // again after kStepOutOfMemory. A failed device keeps none; a new plugin may. Waits for a device that is starting.
    std::string keepOnDevice(btSoftBody& body, bool keep);
    // Takes a kept body's nodes as Bullet has them: those of the last fetch(), with what the app has changed since.
    void takeNodes(const btSoftBody& body);
    // Starts the transfer of a kept body's nodes to the host, and returns at once. The next fetch() takes these nodes,
    // and waits only if no step followed.
    void beginFetch(const btSoftBody& body);
    // Gives Bullet's nodes of a kept body their positions, velocities and normals. Returns false, with nothing changed,
    // if Bullet's nodes are current, or if the device failed and lost them; error() is set then.
    bool fetch(btSoftBody& body);
    // Gives the same to arrays of the caller's. Returns false, with nothing written, in these cases, and if the number
    // of the body's nodes has changed.
    bool fetch(const btSoftBody& body, const NodeArrays& arrays);

    // Announces that vertices of a mesh shape moved in place, and wakes soft bodies that sleep beside it. Drape notices
    // changed bounding boxes, scaling and sampled vertices without this call. The change is motion within the coming
    // step; vertices that move by more than half of the mesh's size are a teleport.
    void obstacleChanged(const btCollisionShape* shape);

    // Announces that an obstacle or a soft body is put elsewhere before the next step. Drape then sweeps no path, and
    // reports and pushes apart what intersects. Needed if an app sets only a kinematic body's world transform. Ignores
    // unknown objects.
    void teleported(const btCollisionObject* object);

    // Brings the soft body's tree of nodes (btSoftBody::m_ndbvt) up to date with the nodes' positions. Drape does so by
    // itself for whatever of Bullet's collides with the body, and leaves the tree behind in other steps. Call it before
    // the app reads or draws the tree, or takes a sleeping body to a world without Drape. Does nothing if the tree is
    // up to date. Never fails, and never changes results.
    void updateNodeTree(btSoftBody& body);
    // Updates the trees of all soft bodies of a world: before debugDrawWorld() with btIDebugDraw::DBG_DrawAabb.
    void updateNodeTrees(const btCollisionWorld& world);

    // Lets a soft body collide with itself, and with the other bodies for which this is on, as far as Bullet's filters
    // let the two collide. Off by default. thickness: m, at which layers rest on each other; 0 means twice the body's
    // margin, and so does a negative one, with a line of Settings::m_log. Another line says if it is more than twice
    // the body's mean edge. Bodies of two thicknesses keep their mean. Features that are nearer when this is switched
    // on keep half of that distance. Friction is the greater kDF of the two. Cloth that does not intersect itself or
    // another body never does so at the end of a step; StepStatistics::m_clothPairsMeeting counts exceptions. The links
    // of these bodies are solved on the host. Cloth that starts intersecting is pushed apart a little in every step, at
    // a fifth of the thickness at most, and kept apart as it comes apart; clothPairs() lists it. If memory runs out,
    // nothing changes. The body is remembered by its address until this is switched off. A GPU's kernels for it are
    // built by the next prepare() of such a body, or else in its first step, which then takes seconds at the first use
    // of a driver.
    //
    // Bullet's flags do the same, with twice the margin: bodies with fCollision::VF_SS collide with each other, a body
    // with CL_SELF or btSoftBody::setSelfCollision(true) with itself. With Solver::Bullet they are left to Bullet.
    void setSelfCollision(const btSoftBody& body, bool collides, double thickness = 0);

    // Makes only the front of a mesh shape solid: the side from which its triangles run counter-clockwise. Cloth behind
    // it may come out. Off by default. Planes, height fields and convex shapes count as meshes; for other shapes, such
    // as a compound instead of its children, Settings::m_log gets a line, and nothing changes. A mirrored mesh keeps
    // its front. The shape is remembered by its address until this is switched off. If memory runs out, nothing
    // changes, and cloth stands still in the next step with kStepOutOfMemory.
    void setOneSided(const btCollisionShape* shape, bool oneSided);

    // Leaves out of collision those triangles of a mesh or height field for which the filter returns false: doors and
    // holes. It is called for each triangle that is read, in the next step and whenever the shape changes; call
    // obstacleChanged() if its answers change. Only Drape's own contacts heed it. A scaled shape has the filter of its
    // child if it has none. Other shapes have no such triangles: Settings::m_log gets a line, and nothing is left out.
    // Null removes it. It must not throw. The shape is remembered by its address. If memory runs out, nothing changes,
    // and cloth stands still in the next step with kStepOutOfMemory.
    void setTriangleFilter(const btCollisionShape* shape, TriangleFilter filter);

    // Returns the state shared with Drape's other classes; not for apps.
    const std::shared_ptr<PluginState>& state() const { return m_state; }

private:
    std::shared_ptr<PluginState> m_state;
};
}  // namespace drape
