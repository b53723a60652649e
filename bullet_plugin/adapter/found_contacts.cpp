#include "bullet_plugin/adapter/found_contacts.h"

#include <algorithm>

namespace drape
{
namespace
{
// Kind of the contacts that addOwn() makes, whose obstacle feature is their index; no kind of the pipeline's.
constexpr std::uint32_t kOwnKind = 0xffffffffu;

btVector3 vectorOf(const float v[3])
{
    return btVector3(btScalar(v[0]), btScalar(v[1]), btScalar(v[2]));
}

btScalar gapAt(const StepContact& contact, const btVector3* places, const btTransform* carry)
{
    btVector3 at(0, 0, 0);
    for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
        at += places[contact.m_nodes[k]] * contact.m_weights[k];
    return contact.m_normal.dot(carried(carry, at) - contact.m_point) - contact.m_thickness;
}

// Sets both gaps along the contact's normal. A feature that slid around an edge of the obstacle began behind its
// contact's plane without having been inside the obstacle. Only the depth at the predicted end is known then.
void setGaps(const btSoftBody& body, const NodePaths& paths, StepContact& contact)
{
    contact.m_endGap = gapAt(contact, paths.m_end.data(), nullptr);
    contact.m_startGap = contact.m_carriedStarts ? gapAt(contact, contact.m_carriedStarts, nullptr)
                                                 : gapAt(contact, paths.m_start.data(), contact.m_carry);
    if (contact.m_startGap < -contact.m_thickness && contact.m_startGap < contact.m_endGap)
        contact.m_startGap = contact.m_endGap;
    contact.m_targetGap = targetGap(contact.m_startGap, body.m_cfg.kKHR, contact.m_thickness);
}
}  // namespace

void FoundContacts::nameObstacle(MeshId obstacle, const btCollisionObject* object, const BodyMotion& motion)
{
    m_obstacles[obstacle] = Obstacle{object, motion.moves(), motion.map()};
}

const btTransform* FoundContacts::carryOf(MeshId obstacle) const
{
    const Obstacle& entry = m_obstacles.at(obstacle);
    return entry.m_moves ? &entry.m_carry : nullptr;
}

Contact FoundContacts::addOwn(const StepContact& own)
{
    Contact contact = {};
    contact.m_kind = kOwnKind;
    contact.m_obstacleFeature = static_cast<std::uint32_t>(m_own.size());
    contact.m_weights[0] = 1;
    contact.m_time = 1;
    for (int axis = 0; axis < 3; ++axis)
    {
        contact.m_normal[axis] = static_cast<float>(own.m_normal[axis]);
        contact.m_point[axis] = static_cast<float>(own.m_point[axis]);
    }
    m_own.push_back(own);
    return contact;
}

void FoundContacts::set(const Pipeline& pipeline, const ContactList& contacts)
{
    m_pipeline = &pipeline;
    m_contacts = contacts;
}

void FoundContacts::keepList()
{
    m_kept = list();
    m_keeps = true;
}

StepContact FoundContacts::resolve(const btSoftBody& body, const NodePaths& paths, const Contact& found) const
{
    if (found.m_kind == kOwnKind) return m_own[found.m_obstacleFeature];
    const ContactView view = m_pipeline->view(found);
    StepContact contact;
    for (int k = 0; k < 3; ++k)
    {
        contact.m_nodes[k] = view.m_nodes[k];
        contact.m_weights[k] = view.m_nodes[k] >= 0 ? btScalar(view.m_weights[k]) : btScalar(0);
    }
    contact.m_normal = vectorOf(view.m_normal);
    contact.m_point = vectorOf(view.m_point);
    contact.m_thickness = view.m_thickness;
    contact.m_time = view.m_time;
    const Obstacle& obstacle = m_obstacles.at(view.m_obstacle);
    contact.m_carry = obstacle.m_moves ? &obstacle.m_carry : nullptr;
    const auto starts = m_carriedStarts.find(view.m_cloth);
    contact.m_carriedStarts = starts == m_carriedStarts.end() ? nullptr : starts->second;
    contact.m_friction = body.m_cfg.kDF * obstacle.m_object->getFriction();
    setGaps(body, paths, contact);
    return contact;
}

bool FoundContacts::planeAt(const Contact& contact, const float nodes[][3], ContactPlane& plane)
{
    return contact.m_kind == DRAPE_FACE_VERTEX && !(contact.m_time < 1) && drape::planeAt(contact, nodes, plane);
}

ContactInfo FoundContacts::infoOf(const Contact& contact) const
{
    const ContactView view = m_pipeline->view(contact);
    ContactInfo info;
    info.m_cloth = m_bodies.at(view.m_cloth);
    info.m_obstacle = m_obstacles.at(view.m_obstacle).m_object;
    for (int k = 0; k < 3; ++k)
    {
        info.m_nodes[k] = view.m_nodes[k];
        info.m_weights[k] = view.m_nodes[k] >= 0 ? view.m_weights[k] : 0.0f;
        info.m_normal[k] = view.m_normal[k];
        info.m_point[k] = view.m_point[k];
    }
    info.m_gap = view.m_gap1 - view.m_thickness;
    info.m_thickness = view.m_thickness;
    return info;
}

std::vector<ContactInfo> FoundContacts::list() const
{
    if (m_keeps) return m_kept;
    std::vector<ContactInfo> infos;
    infos.reserve(m_contacts.size());
    for (const Contact& contact : m_contacts)
        infos.push_back(infoOf(contact));
    return infos;
}
}  // namespace drape
