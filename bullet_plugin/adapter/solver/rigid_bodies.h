// The rigid bodies that cloth touches or hangs on in a step: contacts that Bullet's own algorithms found
// (btSoftBody::m_rcontacts), contacts with the meshes of dynamic bodies, and anchors, as rows of the core's solver.
//
// Contacts and anchors act as those of btSoftBody::solveConstraints() do: friction is the product of both coefficients,
// what a depth recovers follows kKHR or kCHR, and anchors follow kAHR and their influence. Cost: linear in both.
#pragma once

#include <unordered_map>
#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_plugin/adapter/collision/body_contacts.h"
#include "bullet_plugin/core/solver/rigid_rows.h"
#include "bullet_plugin/core/solver/solver_contact.h"
#include "bullet_plugin/core/solver/supported_nodes.h"

namespace drape
{
class RigidBodies
{
public:
    // Returns why rows cannot stand for the body's contacts; null if they can.
    static const char* reasonForBullet(const btSoftBody& body);

    void clear();
    // Adds the body's contacts and anchors. substeps: their number in the step. nodes: with recorded paths.
    void addRows(const btSoftBody& body, int substeps, const SolverNodes& nodes, RigidRows& rows);
    // Adds a contact of a cloth with the mesh of a dynamic body. dt: s, of Bullet's step. nodes: the cloth's.
    void addRow(const DynamicBody& dynamic, btScalar dt, const SolverContact& contact, const SolverNodes& nodes,
                const SupportedNodes& supported, RigidRows& rows);
    // Gives the rigid bodies what the cloth pushed. Those with contacts of addRow() go where they yielded to.
    void applyImpulses() const;

private:
    std::uint32_t indexOf(const btCollisionObject& object);
    RigidBody& follow(std::uint32_t index, const DynamicBody& dynamic, btScalar dt);

    std::unordered_map<const btCollisionObject*, std::uint32_t> m_indices;
    std::vector<btRigidBody*> m_rigid;  // by index; null for an object that is none
    std::vector<RigidBody> m_bodies;
};
}  // namespace drape
