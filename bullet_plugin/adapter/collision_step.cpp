#include "bullet_plugin/adapter/collision_step.h"

#include <algorithm>

namespace drape
{
namespace
{
btVector3 vectorOf(const float v[3])
{
    return btVector3(btScalar(v[0]), btScalar(v[1]), btScalar(v[2]));
}

btScalar gapAt(const btSoftBody& body, const StepContact& contact, btVector3 btSoftBody::Node::*member,
               const btTransform* carry)
{
    btVector3 at(0, 0, 0);
    for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
        at += body.m_nodes[contact.m_nodes[k]].*member * contact.m_weights[k];
    return contact.m_normal.dot(carried(carry, at) - contact.m_point) - contact.m_thickness;
}

// Both gaps, along the contact's normal. A feature that slid around an edge of the obstacle began behind the plane of
// its contact without having been inside the obstacle: then the depth at the predicted end is all that is known.
void setGaps(const btSoftBody& body, StepContact& contact)
{
    contact.m_endGap = gapAt(body, contact, &btSoftBody::Node::m_x, nullptr);
    contact.m_startGap = gapAt(body, contact, &btSoftBody::Node::m_q, contact.m_carry);
    if (contact.m_startGap < -contact.m_thickness && contact.m_startGap < contact.m_endGap)
        contact.m_startGap = contact.m_endGap;
    contact.m_targetGap = targetGap(contact.m_startGap, body.m_cfg.kKHR, contact.m_thickness);
}

ContactInfo infoOf(const btSoftBody& body, const StepContact& contact)
{
    ContactInfo info;
    info.m_cloth = &body;
    info.m_obstacle = contact.m_object;
    for (int k = 0; k < 3; ++k)
    {
        info.m_nodes[k] = contact.m_nodes[k];
        info.m_weights[k] = static_cast<float>(contact.m_weights[k]);
        info.m_normal[k] = static_cast<float>(contact.m_normal[k]);
        info.m_point[k] = static_cast<float>(contact.m_point[k]);
    }
    info.m_gap = static_cast<float>(contact.m_endGap);
    info.m_thickness = static_cast<float>(contact.m_thickness);
    return info;
}
}  // namespace

BodyContacts* CollisionStep::bodyOf(MeshId cloth)
{
    for (BodyContacts& body : m_bodies)
        if (body.m_cloth == cloth) return &body;
    return nullptr;
}

BodyContacts* CollisionStep::contactsOf(const btSoftBody& body)
{
    for (BodyContacts& entry : m_bodies)
        if (entry.m_body == &body) return &entry;
    return nullptr;
}

const CollisionStep::Obstacle* CollisionStep::obstacleOf(MeshId obstacle) const
{
    for (const Obstacle& entry : m_obstacles)
        if (entry.m_mesh == obstacle) return &entry;
    return nullptr;
}

void CollisionStep::addPair(const PairNote& note)
{
    ClothMirror& cloth = m_state.clothMirror(note);
    const MeshId clothId = bodyOf(cloth.id()) ? cloth.id() : cloth.refresh(m_state.pipeline());
    const MeshId obstacleId = m_state.obstacleMirror(note).refresh(m_state.pipeline(), note.m_kinematic, note.m_motion);
    if (clothId == kNoMesh || obstacleId == kNoMesh) return;
    if (!bodyOf(clothId))
    {
        BodyContacts body;
        body.m_cloth = clothId;
        body.m_body = note.m_cloth;
        m_bodies.push_back(body);
        m_mirrors.push_back(&cloth);
    }
    if (!obstacleOf(obstacleId))
        m_obstacles.push_back(
            Obstacle{obstacleId, note.m_obstacle.m_object, note.m_motion.moves(), note.m_motion.map()});
    for (const Pair& pair : m_pairs)
        if (pair.m_cloth == clothId && pair.m_obstacle == obstacleId) return;
    m_pairs.push_back(Pair{clothId, obstacleId, note.m_thickness});
    btVector3 low, high;
    note.m_obstacle.m_shape->getAabb(note.m_motion.m_end, low, high);
    const Obstacle& obstacle = *obstacleOf(obstacleId);
    bodyOf(clothId)->m_limit.addObstacle(low, high, note.m_thickness, btScalar(m_state.settings().m_activation),
                                         obstacle.m_moves ? &obstacle.m_carry : nullptr);
}

void CollisionStep::uploadNodes()
{
    for (std::size_t i = 0; i < m_bodies.size(); ++i)
    {
        const MeshId cloth = m_bodies[i].m_cloth;
        m_bodies[i].m_limit.record(*m_bodies[i].m_body);
        m_mirrors[i]->writeNodes(m_state.pipeline().clothStart(cloth), m_state.pipeline().clothEnd(cloth));
    }
}

void CollisionStep::begin(const std::vector<PairNote>& notes)
{
    // Adding and removing meshes moves the memory that nodes are written to: mirrors first, nodes after.
    m_state.dropOldMirrors();
    for (const PairNote& note : notes)
        addPair(note);
    if (!m_pairs.empty()) submit();
}

void CollisionStep::submit()
{
    uploadNodes();
    for (const Pair& pair : m_pairs)
        m_state.pipeline().addPair(pair.m_cloth, pair.m_obstacle, static_cast<float>(pair.m_thickness));
    m_state.pipeline().submit();
}

void CollisionStep::receive(const ContactView& view)
{
    BodyContacts* body = bodyOf(view.m_cloth);
    const Obstacle* obstacle = obstacleOf(view.m_obstacle);
    if (!body || !obstacle) return;
    StepContact contact;
    contact.m_object = obstacle->m_object;
    contact.m_carry = obstacle->m_moves ? &obstacle->m_carry : nullptr;
    contact.m_kind = view.m_kind;
    for (int k = 0; k < 3; ++k)
    {
        contact.m_nodes[k] = view.m_nodes[k];
        contact.m_weights[k] = view.m_nodes[k] >= 0 ? btScalar(view.m_weights[k]) : btScalar(0);
    }
    contact.m_normal = vectorOf(view.m_normal);
    contact.m_point = vectorOf(view.m_point);
    contact.m_thickness = view.m_thickness;
    contact.m_time = view.m_time;
    contact.m_friction = body->m_body->m_cfg.kDF * contact.m_object->getFriction();
    setGaps(*body->m_body, contact);
    for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
        body->m_limit.addContactNode(contact.m_nodes[k]);
    body->m_contacts.push_back(contact);
    m_state.m_contacts.push_back(infoOf(*body->m_body, contact));
}

// Waits for the detection under way and takes its contacts in place of any earlier ones of this step.
void CollisionStep::receiveAll()
{
    const StepStatistics before = m_state.m_statistics;
    for (BodyContacts& body : m_bodies)
        body.m_contacts.clear();
    m_state.m_contacts.clear();
    const std::vector<Contact>& contacts = m_state.pipeline().finish();
    m_state.m_statistics = m_state.pipeline().statistics();
    m_state.m_statistics.m_status |= before.m_status;
    m_state.m_statistics.m_retries += before.m_retries;
    m_state.m_statistics.m_uploadMs += before.m_uploadMs;
    m_state.m_statistics.m_waitMs += before.m_waitMs;
    m_state.m_statistics.m_refitMs += before.m_refitMs;
    m_state.m_statistics.m_broadMs += before.m_broadMs;
    m_state.m_statistics.m_narrowMs += before.m_narrowMs;
    m_state.m_contacts.reserve(contacts.size());
    for (const Contact& contact : contacts)
        receive(m_state.pipeline().view(contact));
}

bool CollisionStep::cutPaths()
{
    bool any = false;
    for (BodyContacts& body : m_bodies)
        any = cutAtImpacts(*body.m_body, body.m_contacts, Cut::EachNode) || any;
    return any;
}

void CollisionStep::finish()
{
    m_state.m_contacts.clear();
    m_state.m_statistics = StepStatistics();
    m_state.m_statistics.m_skipped = m_pairs.empty();
    if (m_pairs.empty()) return;
    receiveAll();
    for (int detections = 1; detections < kMostDetections && cutPaths(); ++detections)
    {
        submit();
        receiveAll();
    }
}

bool CollisionStep::cutStrayed(const std::vector<bool>& strayed, Cut cut)
{
    bool any = false;
    for (std::size_t i = 0; i < m_bodies.size(); ++i)
        if (strayed[i]) any = cutAtImpacts(*m_bodies[i].m_body, m_bodies[i].m_contacts, cut) || any;
    return any;
}

void CollisionStep::checkStrayed()
{
    std::vector<bool> strayed;
    for (const BodyContacts& body : m_bodies)
        strayed.push_back(body.m_limit.strayed(*body.m_body));
    if (std::find(strayed.begin(), strayed.end(), true) == strayed.end()) return;
    const std::vector<ContactInfo> published = m_state.m_contacts;
    const StepStatistics before = m_state.m_statistics;
    for (int detections = 1; detections <= kMostDetections; ++detections)
    {
        submit();
        receiveAll();
        if (!cutStrayed(strayed, detections < kMostDetections ? Cut::EachNode : Cut::WholeBody)) break;
    }
    // What is reported stays what the solver was given.
    m_state.m_contacts = published;
    m_state.m_statistics.m_contacts = before.m_contacts;
    m_state.m_statistics.m_candidates = before.m_candidates;
    m_state.m_statistics.m_writeMs = before.m_writeMs;
    m_state.m_statistics.m_finishMs = before.m_finishMs;
}
}  // namespace drape
