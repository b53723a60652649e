#include "bullet_plugin/adapter/contact_writer.h"

#include <algorithm>
#include <cmath>

#include "BulletSoftBody/btSoftBodyInternals.h"
#include "kernels/shared/contact.h"

namespace drape
{
namespace
{
// Inverse masses of a face that differ by less than this share count as equal: setTotalMass rounds them.
constexpr btScalar kEqualMass = btScalar(1e-3);

// Violation, as a share of the thickness, for which a face or edge is not worth an SContact.
constexpr btScalar kNegligible = btScalar(0.01);

btVector3 weighted(const btSoftBody& body, const StepContact& contact, btVector3 btSoftBody::Node::*member)
{
    btVector3 sum(0, 0, 0);
    for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
        sum += body.m_nodes[contact.m_nodes[k]].*member * contact.m_weights[k];
    return sum;
}

// Motion of the contact's cloth point over the step.
btVector3 motion(const btSoftBody& body, const StepContact& contact)
{
    return weighted(body, contact, &btSoftBody::Node::m_x) - weighted(body, contact, &btSoftBody::Node::m_q);
}

// Coulomb's law as Bullet's rigid contacts apply it: the share of the tangential motion that friction stops.
btScalar stoppedShare(const btVector3& move, const btVector3& normal, btScalar friction)
{
    const btScalar approach = move.dot(normal);
    const btVector3 sliding = move - normal * approach;
    const btScalar cone = approach * friction;
    return sliding.length2() < cone * cone ? btScalar(1) : std::min(friction, btScalar(1));
}

// Identity along the surface, `share` along the normal.
btMatrix3x3 scaleNormal(const btVector3& n, btScalar share)
{
    const btScalar k = share - 1;
    return btMatrix3x3(1 + k * n.x() * n.x(), k * n.x() * n.y(), k * n.x() * n.z(),  //
                       k * n.y() * n.x(), 1 + k * n.y() * n.y(), k * n.y() * n.z(),  //
                       k * n.z() * n.x(), k * n.z() * n.y(), 1 + k * n.z() * n.z());
}

// Hardness that makes Bullet's first iteration push a node that started too close out by kKHR of its depth: Bullet adds
// hardness times the depth at the predicted end, which is deeper by the approach.
btScalar hardness(const StepContact& contact, btScalar kinetic)
{
    if (contact.m_startGap >= 0) return 0;
    return kinetic * std::min(btScalar(1), contact.m_startGap / std::min(contact.m_endGap, -SIMD_EPSILON));
}

btMatrix3x3 impulseMatrix(const btSoftBody& body, const btSoftBody::Node& node, const btCollisionObject& object,
                          const btVector3& arm)
{
    const btRigidBody* rigid = btRigidBody::upcast(&object);
    const btMatrix3x3 noInertia(0, 0, 0, 0, 0, 0, 0, 0, 0);
    return ImpulseMatrix(body.m_sst.sdt, node.m_im, rigid ? rigid->getInvMass() : btScalar(0),
                         rigid ? rigid->getInvInertiaTensorWorld() : noInertia, arm);
}

void appendRigid(btSoftBody& body, const StepContact& contact)
{
    btSoftBody::Node& node = body.m_nodes[contact.m_nodes[0]];
    if (!(movableInverseMass(node) > 0)) return;
    const btVector3 move = node.m_x - node.m_q;
    const btScalar approach = -move.dot(contact.m_normal);
    const btVector3 arm = node.m_x - contact.m_object->getWorldTransform().getOrigin();
    const btScalar share = approachShare(contact.m_startGap, approach, body.m_cfg.piterations);

    btSoftBody::RContact out;
    out.m_cti.m_colObj = contact.m_object;
    out.m_cti.m_normal = contact.m_normal;
    out.m_cti.m_offset = -contact.m_normal.dot(contact.m_point) - contact.m_thickness;
    out.m_cti.m_bary.setZero();
    out.m_node = &node;
    out.m_c0 = impulseMatrix(body, node, *contact.m_object, arm) * scaleNormal(contact.m_normal, share);
    out.m_c1 = arm;
    out.m_c2 = node.m_im * body.m_sst.sdt;
    out.m_c3 = 1 - stoppedShare(move, contact.m_normal, contact.m_friction);
    out.m_c4 = hardness(contact, body.m_cfg.kKHR);
    out.t1.setZero();
    out.t2.setZero();
    body.m_rcontacts.push_back(out);
}

// The weights in the order of the face's nodes. False when the face does not hold the contact's nodes.
bool weightsOnFace(const btSoftBody& body, const StepContact& contact, btVector3& weights)
{
    weights.setZero();
    if (contact.m_face < 0 || contact.m_face >= body.m_faces.size()) return false;
    const btSoftBody::Face& face = body.m_faces[contact.m_face];
    for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
    {
        int corner = 0;
        while (corner < 3 && face.m_n[corner] != &body.m_nodes[contact.m_nodes[k]])
            ++corner;
        if (corner == 3) return false;
        weights[corner] += contact.m_weights[k];
    }
    return true;
}

bool equalMasses(const btSoftBody& body, const StepContact& contact)
{
    btScalar least = SIMD_INFINITY, most = 0;
    for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
    {
        const btScalar inverseMass = movableInverseMass(body.m_nodes[contact.m_nodes[k]]);
        least = std::min(least, inverseMass);
        most = std::max(most, inverseMass);
    }
    return least > 0 && most - least <= kEqualMass * most;
}

btSoftBody::Node proxyNode(const btVector3& point)
{
    btSoftBody::Node node = btSoftBody::Node();  // all zero: no mass, no leaf, no velocity
    node.m_x = node.m_q = point;
    return node;
}
}  // namespace

btScalar approachShare(btScalar startGap, btScalar approach, int iterations)
{
    if (startGap <= 0 || approach <= startGap) return startGap <= 0 ? btScalar(1) : btScalar(0);
    return 1 - std::pow(startGap / approach, btScalar(1) / btScalar(std::max(1, iterations)));
}

void ContactWriter::reset(int proxyCapacity)
{
    m_proxies.resizeNoInitialize(0);
    m_proxies.reserve(proxyCapacity);
}

void ContactWriter::write(btSoftBody& body, const std::vector<StepContact>& contacts)
{
    int rigid = 0, soft = 0;
    for (const StepContact& contact : contacts)
        if (contact.violated()) ++(contact.m_kind == DRAPE_NODE_FACE ? rigid : soft);
    body.m_rcontacts.reserve(body.m_rcontacts.size() + rigid);
    body.m_scontacts.reserve(body.m_scontacts.size() + soft);

    land(body, contacts);
    for (const StepContact& contact : contacts)
    {
        if (!contact.violated()) continue;
        if (contact.m_kind == DRAPE_NODE_FACE)
            appendRigid(body, contact);
        else if (stillViolated(contact))
            appendSoft(body, contact);
    }
}

// One round over the nodes' contacts, each of which puts its node at the thickness.
void ContactWriter::land(const btSoftBody& body, const std::vector<StepContact>& contacts)
{
    m_landed.resize(static_cast<std::size_t>(body.m_nodes.size()));
    for (const StepContact& contact : contacts)
        for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
            m_landed[static_cast<std::size_t>(contact.m_nodes[k])] = body.m_nodes[contact.m_nodes[k]].m_x;
    for (const StepContact& contact : contacts)
    {
        if (contact.m_kind != DRAPE_NODE_FACE || !contact.violated()) continue;
        btVector3& at = m_landed[static_cast<std::size_t>(contact.m_nodes[0])];
        const btScalar gap = contact.m_normal.dot(at - contact.m_point) - contact.m_thickness;
        if (gap < 0) at -= contact.m_normal * gap;
    }
}

bool ContactWriter::stillViolated(const StepContact& contact) const
{
    btVector3 at(0, 0, 0);
    for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
        at += m_landed[static_cast<std::size_t>(contact.m_nodes[k])] * contact.m_weights[k];
    const btScalar gap = contact.m_normal.dot(at - contact.m_point) - contact.m_thickness;
    return gap < -kNegligible * contact.m_thickness;
}

void ContactWriter::appendSoft(btSoftBody& body, const StepContact& contact)
{
    btVector3 weights;
    if (!equalMasses(body, contact) || !weightsOnFace(body, contact, weights)) return;
    m_proxies.push_back(proxyNode(contact.m_point));
    btSoftBody::SContact out;
    out.m_node = &m_proxies[m_proxies.size() - 1];
    out.m_face = &body.m_faces[contact.m_face];
    out.m_weights = weights;
    out.m_normal = -contact.m_normal;  // Bullet's points from the face to the node
    out.m_margin = contact.m_thickness + solverTarget(contact.m_startGap, body.m_cfg.kKHR);
    out.m_friction = stoppedShare(motion(body, contact), contact.m_normal, contact.m_friction);
    out.m_cfm[0] = 0;
    out.m_cfm[1] = 1 / weights.length2();
    body.m_scontacts.push_back(out);
}

void ContactWriter::removeSoftContacts(btSoftBody& body, int sizeBefore)
{
    while (body.m_scontacts.size() > sizeBefore)
        body.m_scontacts.pop_back();
}
}  // namespace drape
