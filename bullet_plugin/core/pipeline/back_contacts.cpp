#include "back_contacts.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "bullet_plugin/core/lists/contact_view.h"
#include "kernels/lib/geometry/rigid_motion.h"
#include "kernels/lib/geometry/vec3.h"

namespace drape
{
namespace
{
// Returns the cone of an obstacle's normals at a contact's feature, in the mesh's frame. A face without area has a NaN
// axis.
NormalCone coneOf(const PooledMesh& mesh, std::uint32_t kind, std::uint32_t feature)
{
    if (kind == DRAPE_FACE_VERTEX) return mesh.m_vertexCones[feature - mesh.m_firstVertex];
    if (kind != DRAPE_NODE_FACE) return mesh.m_edgeCones[feature - mesh.m_firstEdge];
    Vec3 p[3];
    for (int i = 0; i < 3; ++i)
        p[i] = vec3Load(mesh.m_positions.data(),
                        mesh.m_topology.m_triangles[feature - mesh.m_firstTriangle].m_vertices[i]);
    const Vec3 normal = vec3Cross(vec3Sub(p[1], p[0]), vec3Sub(p[2], p[0]));
    return NormalCone{vec3Scale(normal, 1 / vec3Length(normal)), 1};
}

// The one-sided obstacles of a step, and which contacts are on their backs.
class OneSidedObstacles
{
public:
    explicit OneSidedObstacles(const Scene& scene) : m_scene(scene), m_maps(scene.m_obstacles.meshCount())
    {
        for (std::size_t slot = 0; slot < m_maps.size(); ++slot)
        {
            const PooledMesh& mesh = scene.m_obstacles.mesh(slot);
            if (!mesh.m_oneSided || mesh.m_vacant) continue;
            m_any = true;
            if (mesh.m_poses.moves()) m_maps[slot] = makeMotion(mesh.m_poses, mesh.m_box, std::uint32_t(slot));
        }
    }

    bool any() const { return m_any; }

    bool haveOnBack(const Contact& contact) const
    {
        if (contact.m_kind >= DRAPE_SELF_NODE_FACE) return false;
        const std::size_t slot = obstacleSlot(m_scene.m_obstacles, contact);
        const PooledMesh& mesh = m_scene.m_obstacles.mesh(slot);
        if (!mesh.m_oneSided) return false;
        NormalCone cone = coneOf(mesh, contact.m_kind, contact.m_obstacleFeature);
        if (mesh.m_poses.m_posed) cone.m_axis = mapDirection(mesh.m_poses.m_end.data(), cone.m_axis);
        const Vec3 normal = vec3Load(contact.m_normal, 0);
        return vec3Dot(cone.m_axis, normal) < 0 || (contact.m_time < 1 && leaves(cone, wayOf(contact, slot)));
    }

private:
    // Returns the motion of the contact's point of the cloth in the step, relative to the obstacle, m.
    Vec3 wayOf(const Contact& contact, std::size_t slot) const
    {
        const Vec3 start = clothPoint(m_scene.m_cloths, m_scene.m_clothNodes.start(), contact);
        const Vec3 end = clothPoint(m_scene.m_cloths, m_scene.m_clothNodes.end(), contact);
        const bool moves = m_scene.m_obstacles.mesh(slot).m_poses.moves();
        return vec3Sub(end, moves ? mapPoint(m_maps[slot].m_map, start) : start);
    }

    // Returns whether the path leads away from the front of every face at the feature. From the front, such a path
    // meets none of them.
    static bool leaves(const NormalCone& cone, Vec3 path)
    {
        if (!(cone.m_cosine > 0)) return false;
        const float sine = std::sqrt(std::max(0.0f, 1 - cone.m_cosine * cone.m_cosine));
        return vec3Dot(cone.m_axis, path) > sine * vec3Length(path);
    }

    const Scene& m_scene;
    std::vector<ObstacleMotion> m_maps;  // by slot; only those of moving obstacles are set
    bool m_any = false;
};
}  // namespace

bool hasOneSided(const Scene& scene)
{
    return OneSidedObstacles(scene).any();
}

void removeBackContacts(const Scene& scene, StepResult& result)
{
    const OneSidedObstacles obstacles(scene);
    if (!obstacles.any()) return;
    std::vector<Contact> kept;
    const ContactList all = result.allContacts();
    std::remove_copy_if(all.begin(), all.end(), std::back_inserter(kept),
                        [&](const Contact& contact) { return obstacles.haveOnBack(contact); });
    result.m_contacts.swap(kept);
    result.m_deviceContacts = ContactList();
}
}  // namespace drape
