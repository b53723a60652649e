// Resolves the contacts of the last detection for the solver, each on demand: most never act in a step.
//
// Input: the list of a step, its meshes and its pairs, which the caller keeps unchanged while contacts are resolved;
// the motion and friction of each obstacle. Cost: proportional to the contacts resolved.
#pragma once

#include <unordered_map>
#include <vector>

#include "bullet_plugin/core/ordering/contact_list.h"
#include "bullet_plugin/core/scene/mesh_id.h"
#include "solver_contact.h"
#include "solver_nodes.h"

namespace drape
{
struct Scene;
struct StepPairs;

// The motion and the surface of an obstacle in the step.
struct ObstacleSurface
{
    bool m_moves = false;
    float m_map[12] = {};  // see Carry
    float m_friction = 0;
};

class ContactSource
{
public:
    // Sets the meshes and pairs of the step, and its list of contacts.
    void set(const Scene& scene, const StepPairs& pairs, ContactList list)
    {
        m_scene = &scene;
        m_pairs = &pairs;
        m_list = list;
        m_onDevice = DeviceContacts();
    }
    // Sets a list on a device that commands may read. No contact can be resolved.
    void setOnDevice(const Scene& scene, const StepPairs& pairs, DeviceContacts onDevice)
    {
        set(scene, pairs, ContactList());
        m_onDevice = onDevice;
    }
    // Returns the meshes; null before set().
    const Scene* scene() const { return m_scene; }
    // Returns the detection's contacts, without those of addOwn().
    ContactList list() const { return m_list; }
    // The detection's list on the device; empty if list() is on the host.
    DeviceContacts onDevice() const { return m_onDevice; }
    // Returns what contacts with an obstacle have in common; resolve() returns it for each.
    const ObstacleSurface& surfaceOf(MeshId obstacle) const { return m_surfaces.at(obstacle); }
    void nameObstacle(MeshId obstacle, const ObstacleSurface& surface) { m_surfaces[obstacle] = surface; }
    // Returns the motion of the obstacle's points in the step; null if it rests. It stays in place until the source
    // ends.
    const float* mapOf(MeshId obstacle) const;
    // Sets the starts to which an obstacle carries the nodes (see Carry), for a mesh of a cloth that has this one
    // obstacle alone. The caller owns the array.
    void nameStarts(MeshId cloth, const Vec3* carriedStarts) { m_carriedStarts[cloth] = carriedStarts; }
    // Adds a contact of the caller's own for one node of a cloth, which resolve() gives back as it is.
    Contact addOwn(const SolverContact& contact);

    // Resolves the contact's points and gaps along the paths of the nodes. friction: of the cloth. hardness: see
    // targetGap().
    SolverContact resolve(const SolverNodes& nodes, float friction, float hardness, const Contact& contact) const;

private:
    const Scene* m_scene = nullptr;
    const StepPairs* m_pairs = nullptr;
    ContactList m_list;
    DeviceContacts m_onDevice;
    std::unordered_map<MeshId, ObstacleSurface> m_surfaces;
    std::unordered_map<MeshId, const Vec3*> m_carriedStarts;  // by cloth
    std::vector<SolverContact> m_own;
};
}  // namespace drape
