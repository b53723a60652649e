#include "bullet_plugin/adapter/contacts/contact_records.h"

#include <algorithm>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_plugin/adapter/collision/found_contacts.h"
#include "bullet_plugin/adapter/vectors.h"
#include "bullet_plugin/core/solver/rigid_rows.h"

namespace drape
{
namespace
{
// Returns where the point is now, m; the origin for a point of no body.
btVector3 placeOf(const ClothPoint& point)
{
    btVector3 place(0, 0, 0);
    for (int k = 0; k < 3 && point.m_body && point.m_nodes[k] >= 0; ++k)
        place += point.m_body->m_nodes[point.m_nodes[k]].m_x * btScalar(point.m_weights[k]);
    return place;
}

btVector3 vectorOf(const float v[3])
{
    return btVector3(btScalar(v[0]), btScalar(v[1]), btScalar(v[2]));
}

void write(const btVector3& from, float to[3])
{
    float* out = to;
    writePosition(from, out);
}

void addImpulse(StepContact& contact, Vec3 impulse)
{
    contact.m_impulse[0] += impulse.x;
    contact.m_impulse[1] += impulse.y;
    contact.m_impulse[2] += impulse.z;
}

// Makes the i-th contact of a body that Bullet's algorithm found.
StepContact contactOfBullets(const btSoftBody& body, int i)
{
    const btSoftBody::RContact& found = body.m_rcontacts[i];
    const btVector3 normal = found.m_cti.m_normal;
    const btScalar margin = body.getCollisionShape()->getMargin(), gap = normal.dot(found.m_node->m_x);
    StepContact contact = {};
    contact.m_cloth = {&body, ContactFeature::AtNode, {int(found.m_node - &body.m_nodes[0]), -1, -1}, {1, 0, 0}};
    contact.m_other = {nullptr, ContactFeature::AtNode, {-1, -1, -1}, {0, 0, 0}};
    contact.m_object = found.m_cti.m_colObj;
    contact.m_part = contact.m_triangle = -1;
    contact.m_objectFeature = ContactFeature::AtFace;
    contact.m_isBullets = true;
    // Bullet's plane is where a node rests.
    write(found.m_node->m_x - normal * (gap + found.m_cti.m_offset + margin), contact.m_point);
    write(normal, contact.m_normal);
    contact.m_thickness = float(margin);
    contact.m_predictedGap = float(gap + found.m_cti.m_offset);
    contact.m_timeOfImpact = 1;
    return contact;
}
}  // namespace

void ContactRecords::begin()
{
    m_running.clear();
    m_index.clear();
}

ContactPush ContactRecords::pushOf(const FoundContacts& found, const Contact& contact, Vec3 impulse)
{
    return {keyOf(contact), found.recordOf(contact), impulse};
}

void ContactRecords::addDetected(const FoundContacts& found)
{
    const ContactList contacts = found.source().list();
    m_running.reserve(m_running.size() + contacts.size());
    for (const Contact& contact : contacts)
        add({keyOf(contact), found.recordOf(contact), vec3(0, 0, 0)});
}

void ContactRecords::add(const ContactPush& push)
{
    const auto added = m_index.emplace(push.m_key, m_running.size());
    if (added.second) m_running.push_back(push.m_contact);
    addImpulse(m_running[added.first->second], push.m_impulse);
}

void ContactRecords::add(const StepContact& contact, Vec3 impulse)
{
    m_running.push_back(contact);
    addImpulse(m_running.back(), impulse);
}

void ContactRecords::addBullets(const btSoftBody& body, const RigidRows& rows)
{
    std::size_t row = 0;
    for (int i = 0; i < body.m_rcontacts.size(); ++i)
        if (body.m_rcontacts[i].m_cti.m_colObj->hasContactResponse())
            add(contactOfBullets(body, i), rows.contactImpulse(row++));
}

void ContactRecords::end()
{
    m_list.swap(m_running);
    m_running.clear();
    m_index.clear();
    for (StepContact& contact : m_list)
    {
        const btVector3 normal = vectorOf(contact.m_normal);
        const btVector3 from = contact.m_other.m_body ? placeOf(contact.m_other) : vectorOf(contact.m_point);
        contact.m_gap = float(normal.dot(placeOf(contact.m_cloth) - from)) - contact.m_thickness;
        contact.m_normalImpulse = float(normal.dot(vectorOf(contact.m_impulse)));
    }
}
}  // namespace drape
