#include "bullet_plugin/adapter/collision/found_contacts.h"

#include "BulletCollision/CollisionDispatch/btCollisionObject.h"
#include "bullet_plugin/adapter/vectors.h"

namespace drape
{
void FoundContacts::nameObstacle(MeshId obstacle, const btCollisionObject* object, const BodyMotion& motion)
{
    m_obstacles[obstacle] = object;
    ObstacleSurface surface;
    surface.m_moves = motion.moves();
    writePose(motion.map(), surface.m_map);
    surface.m_friction = float(object->getFriction());
    m_source.nameObstacle(obstacle, surface);
}

void FoundContacts::set(Pipeline& pipeline, const ContactList& contacts)
{
    m_pipeline = &pipeline;
    m_source.set(pipeline.scene(), pipeline.pairs(), contacts);
}

void FoundContacts::setOnDevice(Pipeline& pipeline, const DeviceContacts& contacts)
{
    m_pipeline = &pipeline;
    m_source.setOnDevice(pipeline.scene(), pipeline.pairs(), contacts);
}

void FoundContacts::keepList()
{
    m_kept = list();
    m_keeps = true;
}

ContactInfo FoundContacts::infoOf(const Contact& contact) const
{
    const ContactView view = m_pipeline->view(contact);
    ContactInfo info;
    info.m_cloth = m_bodies.at(view.m_cloth);
    info.m_obstacle = m_obstacles.at(view.m_obstacle);
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
    if (!m_pipeline) return infos;
    const ContactList contacts = m_pipeline->bringContacts();
    infos.reserve(contacts.size());
    for (const Contact& contact : contacts)
        infos.push_back(infoOf(contact));
    return infos;
}
}  // namespace drape
