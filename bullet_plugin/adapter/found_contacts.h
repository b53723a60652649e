// The contacts of the last detection, and Bullet's objects for the meshes that they name.
//
// Job: resolve single contacts for the solver, and all of them for Plugin::contacts(), each on demand. Input: the
// pipeline's list, which the pipeline owns; it is valid until the pipeline's next submit. Cost: proportional to the
// contacts resolved.
#pragma once

#include <unordered_map>
#include <vector>

#include "bullet_plugin/adapter/kinematic_motion.h"
#include "bullet_plugin/adapter/node_paths.h"
#include "bullet_plugin/adapter/step_contact.h"
#include "bullet_plugin/core/pipeline/contact_plane.h"
#include "bullet_plugin/core/pipeline/pipeline.h"
#include "drape/plugin.h"

namespace drape
{
class FoundContacts
{
public:
    // Nothing found, nothing named.
    void clear() { *this = FoundContacts(); }
    void nameCloth(MeshId cloth, const btSoftBody* body) { m_bodies[cloth] = body; }
    void nameObstacle(MeshId obstacle, const btCollisionObject* object, const BodyMotion& motion);
    // Returns the motion of the obstacle's points in the step; null when it rests. The transform stays in place until
    // clear().
    const btTransform* carryOf(MeshId obstacle) const;
    // Sets the positions to which an obstacle carries the nodes' starts (see StepContact), for a mesh of a cloth that
    // has this one obstacle alone. The caller owns the array.
    void nameStarts(MeshId cloth, const btVector3* carriedStarts) { m_carriedStarts[cloth] = carriedStarts; }
    // Adds a contact of the caller's own for one node of a body, which resolve() gives back as it is.
    Contact addOwn(const StepContact& contact);
    void set(const Pipeline& pipeline, const ContactList& contacts);
    // Keeps list() as it is now until clear(), whatever is found later.
    void keepList();

    // Resolves the contact's points and gaps along the paths of the body's nodes.
    StepContact resolve(const btSoftBody& body, const NodePaths& paths, const Contact& contact) const;
    // Resolves a contact with its nodes at other positions, see Pipeline. Only faces at a vertex turn their contacts,
    // and a contact that was met keeps its plane; returns false for all others.
    static bool planeAt(const Contact& contact, const float nodes[][3], ContactPlane& plane);
    std::vector<ContactInfo> list() const;

private:
    struct Obstacle
    {
        const btCollisionObject* m_object;
        bool m_moves;
        btTransform m_carry;
    };

    ContactInfo infoOf(const Contact& contact) const;

    std::unordered_map<MeshId, const btSoftBody*> m_bodies;
    std::unordered_map<MeshId, Obstacle> m_obstacles;
    std::unordered_map<MeshId, const btVector3*> m_carriedStarts;  // by cloth
    std::vector<StepContact> m_own;
    const Pipeline* m_pipeline = nullptr;
    ContactList m_contacts;
    std::vector<ContactInfo> m_kept;
    bool m_keeps = false;
};
}  // namespace drape
