#include "bullet_plugin/adapter/solver/rigid_bodies.h"

#include <algorithm>

#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "bullet_plugin/adapter/solver/substep_body.h"
#include "bullet_plugin/adapter/vectors.h"
#include "bullet_plugin/core/solver/link_strength.h"
#include "bullet_plugin/core/solver/solver_contact.h"

namespace drape
{
namespace
{
RigidBody rigidBodyOf(const btRigidBody* rigid)
{
    RigidBody body = {};
    if (!rigid) return body;
    const bool isDynamic = !rigid->isStaticOrKinematicObject();
    body.m_centre = vec3Of(rigid->getWorldTransform().getOrigin());
    if (isDynamic && !rigid->isActive()) return body;  // Bullet leaves it where it is
    body.m_velocity = vec3Of(rigid->getLinearVelocity());
    body.m_spin = vec3Of(rigid->getAngularVelocity());
    if (!isDynamic) return body;
    body.m_moves = 1;
    body.m_inverseMass = vec3Of(rigid->getLinearFactor() * rigid->getInvMass());
    for (int row = 0; row < 3; ++row)
        body.m_inverseInertia[row] =
            vec3Of(rigid->getInvInertiaTensorWorld().getRow(row) * rigid->getAngularFactor()[row]);
    return body;
}

std::uint32_t nodeIndex(const btSoftBody& body, const btSoftBody::Node* node)
{
    return static_cast<std::uint32_t>(node - &body.m_nodes[0]);
}

// Moves the body on from where Bullet's step took it. shift: m. turn: rad.
void displace(btRigidBody& rigid, const btVector3& shift, const btVector3& turn)
{
    btTransform pose = rigid.getWorldTransform();
    pose.setOrigin(pose.getOrigin() + shift);
    const btScalar angle = turn.length();
    if (angle > 0) pose.setRotation((btQuaternion(turn / angle, angle) * pose.getRotation()).normalized());
    rigid.setCenterOfMassTransform(pose);
}
}  // namespace

const char* RigidBodies::reasonForBullet(const btSoftBody& body)
{
    for (int i = 0; i < body.m_rcontacts.size(); ++i)
        if (body.m_rcontacts[i].m_cti.m_colObj->getInternalType() == btCollisionObject::CO_FEATHERSTONE_LINK)
            return "the soft body touches a link of a multibody";
    return nullptr;
}

void RigidBodies::clear()
{
    m_indices.clear();
    m_rigid.clear();
    m_bodies.clear();
}

std::uint32_t RigidBodies::indexOf(const btCollisionObject& object)
{
    const auto added = m_indices.emplace(&object, static_cast<std::uint32_t>(m_bodies.size()));
    if (added.second)
    {
        btRigidBody* const rigid = btRigidBody::upcast(const_cast<btCollisionObject*>(&object));
        m_rigid.push_back(rigid);
        m_bodies.push_back(rigidBodyOf(rigid));
    }
    return added.first->second;
}

void RigidBodies::addRows(const btSoftBody& body, int substeps, const SolverNodes& nodes, RigidRows& rows)
{
    const float dt = float(body.m_sst.sdt), margin = float(body.getCollisionShape()->getMargin());
    rows.setBodies(m_bodies);
    for (int i = 0; i < body.m_anchors.size(); ++i)
    {
        const btSoftBody::Anchor& anchor = body.m_anchors[i];
        const btTransform& pose = anchor.m_body->getWorldTransform();
        RigidAnchor row = {};
        row.m_node = nodeIndex(body, anchor.m_node);
        row.m_body = indexOf(*anchor.m_body);
        row.m_arm = vec3Of(pose.getBasis() * anchor.m_local);
        const Vec3 end = vec3Of(pose * anchor.m_local - vectorOf(nodes.start(row.m_node)));
        row.m_apart = vec3AddScaled(end, rigidVelocity(&m_bodies[row.m_body], row.m_arm), -dt);
        const double hardness = double(body.m_cfg.kAHR * anchor.m_influence);
        row.m_share = float(visitShare(hardness, body.m_cfg.piterations, substeps, 1));
        rows.add(row);
    }
    for (int i = 0; i < body.m_rcontacts.size(); ++i)
    {
        const btSoftBody::RContact& contact = body.m_rcontacts[i];
        const btCollisionObject& object = *contact.m_cti.m_colObj;
        if (!object.hasContactResponse()) continue;
        RigidContact row = {};
        row.m_node = nodeIndex(body, contact.m_node);
        row.m_body = indexOf(object);
        RigidPlane& plane = row.m_plane;
        plane.m_normal = vec3Of(contact.m_cti.m_normal);
        row.m_arm = vec3Of(contact.m_c1);
        const btVector3 start = vectorOf(nodes.start(row.m_node));
        const float advance = dt * vec3Dot(plane.m_normal, rigidVelocity(&m_bodies[row.m_body], row.m_arm));
        plane.m_gap = float(contact.m_cti.m_normal.dot(start) + contact.m_cti.m_offset) + advance;
        // Bullet's contacts act on approaching nodes alone. Beside edges of a mesh their normals may lead inwards.
        const bool leaves = vec3Dot(plane.m_normal, nodes.pathVector(row.m_node)) > advance;
        plane.m_recover =
            plane.m_gap < 0 && !leaves ? targetGap(plane.m_gap, float(contact.m_c4), margin) - plane.m_gap : 0.0f;
        plane.m_friction = float(body.m_cfg.kDF * object.getFriction());
        rows.add(row);
    }
}

// Lets the body end the step where it yields to.
RigidBody& RigidBodies::follow(std::uint32_t index, const DynamicBody& dynamic, btScalar dt)
{
    RigidBody& body = m_bodies[index];
    if (body.m_follows || !body.m_moves) return body;
    body.m_follows = 1;
    const btRigidBody& rigid = *dynamic.m_object;
    const btVector3 force = rigid.getTotalForce() * rigid.getInvMass() * rigid.getLinearFactor();
    const btVector3 gained = (rigid.getLinearVelocity() - dynamic.m_velocity) / dt;
    // Contacts and joints may have taken some or all of it.
    const btScalar share = force.length2() > 0 ? gained.dot(force) / force.length2() : btScalar(0);
    body.m_acceleration = vec3Of(force * std::min(btScalar(1), std::max(btScalar(0), share)));
    const btVector3 moved = rigid.getWorldTransform().getOrigin() - dynamic.m_place;
    body.m_displaced = vec3Of(moved / dt - rigid.getLinearVelocity());
    return body;
}

void RigidBodies::addRow(const DynamicBody& dynamic, btScalar dt, const SolverContact& contact,
                         const SolverNodes& nodes, const SupportedNodes& supported, RigidRows& rows)
{
    RigidFeature row = {};
    rows.setBodies(m_bodies);
    row.m_body = indexOf(*dynamic.m_object);
    for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
    {
        row.m_nodes[row.m_count] = std::uint32_t(contact.m_nodes[k]);
        const NodeSupport* const support = supported.against(nodes, contact.m_nodes[k], contact.m_plane.m_normal);
        row.m_isBlocked[row.m_count] = support != nullptr;
        row.m_advance[row.m_count] = support ? support->m_advance : 0;
        row.m_weights[row.m_count++] = contact.m_plane.m_weights[k];
    }
    // The contact is where the cloth is, so that friction acts on both sides at one point.
    const Vec3 at = vec3AddScaled(contact.m_plane.m_point, contact.m_plane.m_normal, contact.m_thickness);
    row.m_arm = vec3Sub(at, follow(row.m_body, dynamic, dt).m_centre);
    row.m_plane.m_normal = contact.m_plane.m_normal;
    row.m_plane.m_gap = contact.m_gaps.m_start;
    row.m_plane.m_recover = contact.m_gaps.m_start < 0 ? contact.m_gaps.m_target - contact.m_gaps.m_start : 0.0f;
    row.m_plane.m_friction = contact.m_friction;
    row.m_reach = SupportedNodes::kNearBy * contact.m_thickness;
    rows.add(row, float(dt));
}

void RigidBodies::applyImpulses() const
{
    for (std::size_t i = 0; i < m_bodies.size(); ++i)
    {
        if (!m_bodies[i].m_moves) continue;
        btRigidBody& rigid = *m_rigid[i];
        rigid.applyCentralImpulse(vectorOf(m_bodies[i].m_impulse));
        rigid.applyTorqueImpulse(vectorOf(m_bodies[i].m_turning));
        if (m_bodies[i].m_follows) displace(rigid, vectorOf(m_bodies[i].m_shift), vectorOf(m_bodies[i].m_turn));
    }
}
}  // namespace drape
