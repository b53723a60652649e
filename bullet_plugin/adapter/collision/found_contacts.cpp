#include "bullet_plugin/adapter/collision/found_contacts.h"

#include "BulletCollision/CollisionDispatch/btCollisionObject.h"
#include "bullet_plugin/adapter/mirrors/mirrors.h"
#include "bullet_plugin/adapter/vectors.h"

namespace drape
{
namespace
{
// Returns the feature with these nodes.
ContactFeature featureOf(const int nodes[3])
{
    return nodes[1] < 0 ? ContactFeature::AtNode : nodes[2] < 0 ? ContactFeature::AtEdge : ContactFeature::AtFace;
}
}  // namespace

void FoundContacts::nameObstacle(const ObstacleMirror& mirror, const BodyMotion& motion)
{
    const MeshId obstacle = mirror.id();
    const btCollisionObject* const object = mirror.key().m_object;
    m_obstacles[obstacle] = &mirror;
    m_objects[obstacle] = object;
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
    info.m_obstacle = m_objects.at(view.m_obstacle);
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

StepContact FoundContacts::recordOf(const Contact& contact) const
{
    const ContactView view = m_pipeline->view(contact);
    const ObstacleMirror& obstacle = *m_obstacles.at(view.m_obstacle);
    StepContact record = {};
    record.m_cloth.m_body = m_bodies.at(view.m_cloth);
    record.m_cloth.m_feature = featureOf(view.m_nodes);
    for (int k = 0; k < 3; ++k)
    {
        record.m_cloth.m_nodes[k] = view.m_nodes[k];
        record.m_cloth.m_weights[k] = view.m_nodes[k] >= 0 ? view.m_weights[k] : 0.0f;
        record.m_other.m_nodes[k] = -1;
        record.m_point[k] = view.m_point[k];
        record.m_normal[k] = view.m_normal[k];
    }
    record.m_object = obstacle.key().m_object;
    record.m_shape = obstacle.key().m_shape;
    const TriangleName name =
        view.m_obstacleTriangle < 0 ? TriangleName{-1, -1} : obstacle.nameOf(std::size_t(view.m_obstacleTriangle));
    record.m_part = name.m_part;
    record.m_triangle = name.m_triangle;
    record.m_objectFeature = view.m_kind == DRAPE_NODE_FACE     ? ContactFeature::AtFace
                             : view.m_kind == DRAPE_FACE_VERTEX ? ContactFeature::AtNode
                                                                : ContactFeature::AtEdge;
    record.m_thickness = view.m_thickness;
    record.m_predictedGap = view.m_gap1 - view.m_thickness;
    record.m_timeOfImpact = view.m_time;
    return record;
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
