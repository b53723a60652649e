// A world of cloth and triangle meshes, used through arrays instead of Bullet's classes.
//
// Owns a Plugin and a btSoftRigidDynamicsWorld with Drape's collision and solver. Input: arrays of the caller, read
// during the call. Output: arrays that Bullet's nodes are in, contacts, statistics. SI units, world frame.
//
// Every function that returns bool or an index returns false or -1 if an argument is invalid (an unknown index, a
// missing array, a number out of range) or memory ran out. error() then has the cause, and nothing has changed. No
// exception leaves this class. It is not thread-safe. The rules of Plugin about threads and fork() apply. C++11.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drape/cloth_records.h"
#include "drape/error.h"
#include "drape/export.h"
#include "drape/node_arrays.h"
#include "drape/plugin.h"

class btSoftBody;
class btSoftRigidDynamicsWorld;

namespace drape
{
// Returns a cloth without a mesh: 1 kg, 20 mm thick, stiffness 1, bending stiffness 0.02, friction 0.5, damping 0.05,
// five substeps, no self collision.
DRAPE_EXPORT ClothDescription defaultCloth();
// Returns an obstacle without a mesh: margin 10 mm, friction 1, two-sided, in the world's frame.
DRAPE_EXPORT ObstacleDescription defaultObstacle();

// Cloths and obstacles have indices from 0 on, in the order in which they were added. An index is never used again.
class DRAPE_EXPORT ClothWorld
{
public:
    // Chooses the device and compiles its kernels, as Plugin does. Gravity is 9.81 m/s² against y. Returns null and
    // fills `error` if the settings are out of range, the requested device is missing or unusable, or memory ran out.
    static std::unique_ptr<ClothWorld> create(const Settings& settings, Error& error);
    // Removes everything. Bodies of body() live as long as their pointers.
    ~ClothWorld();
    // A world owns a device: no copies.
    ClothWorld(const ClothWorld&) = delete;
    // A world owns a device: no copies.
    ClothWorld& operator=(const ClothWorld&) = delete;

    // Returns the last failure. The reference is valid as long as this object.
    const Error& error() const;

    // Sets the acceleration of all cloth, m/s².
    bool setGravity(const double gravity[3]);
    // Adds a cloth and returns its index.
    int addCloth(const ClothDescription& cloth);
    // Adds an obstacle and returns its index.
    int addObstacle(const ObstacleDescription& obstacle);
    // Removes a cloth.
    bool removeCloth(int cloth);
    // Removes an obstacle.
    bool removeObstacle(int obstacle);

    // Moves an obstacle to a pose, which it reaches at the end of the next step. position: m. rotation: a quaternion x
    // y z w of any length but 0. teleport: the obstacle is there at once, and sweeps no path.
    bool setPose(int obstacle, const double position[3], const double rotation[4], bool teleport = false);
    // Moves an obstacle's vertices, which reach these positions at the end of the next step. positions: x y z per
    // vertex in the obstacle's own frame, m. `vertexCount` must be the obstacle's. teleport: as in setPose().
    bool setVertices(int obstacle, const float* positions, std::size_t vertexCount, bool teleport = false);

    // Leaves these triangles of an obstacle out of collision, and no others: doors and holes. triangles: `count`
    // indices in its description. No index brings all of them back.
    bool leaveOutTriangles(int obstacle, const std::int32_t* triangles, std::size_t count);

    // Pins nodes, or lets them go with the masses that they had. A pinned node stays where it is, or goes where
    // setPositions() puts it.
    bool setPinned(int cloth, const std::int32_t* nodes, std::size_t count, bool pinned);
    // Moves nodes at once. positions: x y z per node of `nodes`, m. Pinned nodes take the cloth along in the next step.
    // teleport: for cloth that is put elsewhere; Drape then pushes apart what intersects there.
    bool setPositions(int cloth, const std::int32_t* nodes, std::size_t count, const float* positions,
                      bool teleport = false);
    // Sets velocities, x y z per node of `nodes`, m/s. Pinned nodes are refused.
    bool setVelocities(int cloth, const std::int32_t* nodes, std::size_t count, const float* velocities);

    // Runs one step of `dt` seconds, above 0. What the step left out is in statistics().m_status.
    bool step(double dt);

    // Returns Bullet's arrays of a cloth's nodes, valid until the cloth is removed or body() is released, whichever is
    // later.
    bool nodes(int cloth, NodeView& view) const;
    // Copies a cloth's nodes to the caller's arrays, as float.
    bool copyNodes(int cloth, const NodeArrays& arrays) const;
    // Replaces `found` by the contacts of the last step, in canonical order. This function and the next two leave out
    // what has been removed since.
    bool contacts(std::vector<ClothContact>& found) const;
    // Replaces `found` by the contacts of the last step with their impulses. Empty unless
    // plugin().recordContacts(true) was called before that step.
    bool stepContacts(std::vector<ClothStepContact>& found) const;
    // Replaces `found` by the triangles of cloth with self collision that intersected where the last step began.
    bool clothTriangles(std::vector<ClothTriangles>& found) const;

    // Returns problems of the world, one line each; see Plugin::diagnose().
    std::string diagnose() const;
    // Returns the plugin, for statistics(), device(), report() and error(), which names a device that failed. Valid as
    // long as this object.
    Plugin& plugin();
    // Returns the plugin; see above.
    const Plugin& plugin() const;
    // Returns Bullet's world, for what else an app adds to it. Valid as long as this object.
    btSoftRigidDynamicsWorld& world();
    // Returns the cloth's soft body, null for an unknown index. It may outlive this object.
    std::shared_ptr<btSoftBody> body(int cloth) const;

private:
    ClothWorld();
    struct DRAPE_HIDDEN Implementation;
    std::unique_ptr<Implementation> m_implementation;
};
}  // namespace drape
