#include "back_contacts.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "contact_view.h"
#include "kernels/lib/vec3.h"

namespace drape
{
namespace
{
// Returns the front direction of an obstacle's feature, not normalised; zero if the surrounding surface has no
// direction.
std::array<float, 3> frontOf(const PooledMesh& mesh, std::uint32_t kind, std::uint32_t feature)
{
    std::array<float, 3> front;
    if (kind == DRAPE_NODE_FACE)
    {
        Vec3 p[3];
        for (int i = 0; i < 3; ++i)
            p[i] = vec3Load(mesh.m_positions.data(),
                            mesh.m_topology.m_triangles[feature - mesh.m_firstTriangle].m_vertices[i]);
        const Vec3 normal = vec3Cross(vec3Sub(p[1], p[0]), vec3Sub(p[2], p[0]));
        front = {normal.x, normal.y, normal.z};
    }
    else
    {
        const NormalCone& cone = kind == DRAPE_FACE_VERTEX ? mesh.m_vertexCones[feature - mesh.m_firstVertex]
                                                           : mesh.m_edgeCones[feature - mesh.m_firstEdge];
        front = {cone.m_axis.x, cone.m_axis.y, cone.m_axis.z};
    }
    if (!mesh.m_poses.m_posed) return front;
    const Pose& pose = mesh.m_poses.m_end;
    std::array<float, 3> turned;
    for (std::size_t row = 0; row < 3; ++row)
        turned[row] = pose[4 * row] * front[0] + pose[4 * row + 1] * front[1] + pose[4 * row + 2] * front[2];
    return turned;
}
}  // namespace

void removeBackContacts(const MeshPool& obstacles, StepResult& result)
{
    bool any = false;
    for (std::size_t slot = 0; slot < obstacles.meshCount(); ++slot)
        any = any || (obstacles.mesh(slot).m_oneSided && !obstacles.mesh(slot).m_vacant);
    if (!any) return;
    const auto onBack = [&](const Contact& contact)
    {
        if (contact.m_kind >= DRAPE_SELF_NODE_FACE) return false;
        const PooledMesh& mesh = obstacles.mesh(obstacleSlot(obstacles, contact));
        if (!mesh.m_oneSided) return false;
        const std::array<float, 3> front = frontOf(mesh, contact.m_kind, contact.m_obstacleFeature);
        return front[0] * contact.m_normal[0] + front[1] * contact.m_normal[1] + front[2] * contact.m_normal[2] < 0.0f;
    };
    std::vector<Contact> kept;
    const ContactList all = result.allContacts();
    std::remove_copy_if(all.begin(), all.end(), std::back_inserter(kept), onBack);
    result.m_contacts.swap(kept);
    result.m_deviceContacts = ContactList();
}
}  // namespace drape
