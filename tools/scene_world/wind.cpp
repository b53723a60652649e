#include "tools/scene_world/wind.h"

#include <algorithm>
#include <cmath>

#include "tools/scene_world/scene_bodies.h"

namespace drape
{
namespace
{
constexpr btScalar kFacesOfANode = 6;  // number of faces that push an inner node
}

void addWind(btSoftBody& body, const SceneWind& wind, double dt)
{
    const btVector3 blows = vectorOf(wind.m_velocity);
    const auto pressure = btScalar(0.5 * wind.m_airDensity * wind.m_drag);
    for (int i = 0; i < body.m_faces.size(); ++i)
    {
        btSoftBody::Node* const* const nodes = body.m_faces[i].m_n;
        btVector3 normal = (nodes[1]->m_x - nodes[0]->m_x).cross(nodes[2]->m_x - nodes[0]->m_x);
        const btScalar twice = normal.length();
        if (!(twice > 0)) continue;
        normal /= twice;
        const btVector3 moves = (nodes[0]->m_v + nodes[1]->m_v + nodes[2]->m_v) / btScalar(3);
        const btScalar speed = normal.dot(blows - moves);
        const btScalar force = pressure * twice / 2 * speed * std::abs(speed) / 3;
        for (int k = 0; k < 3; ++k)
        {
            if (!(nodes[k]->m_im > 0)) continue;
            const btScalar most = std::abs(speed) / (nodes[k]->m_im * btScalar(dt) * kFacesOfANode);
            nodes[k]->m_f += std::clamp(force, -most, most) * normal;
        }
    }
}
}  // namespace drape
