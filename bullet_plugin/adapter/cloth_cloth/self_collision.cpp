#include "bullet_plugin/adapter/cloth_cloth/self_collision.h"

#include "bullet_plugin/adapter/pairs/margins.h"
#include "bullet_plugin/adapter/vectors.h"

namespace drape
{
namespace
{
void readRest(const btSoftBody& body, std::vector<float>& rest)
{
    rest.resize(3 * static_cast<std::size_t>(body.m_nodes.size()));
    float* out = rest.data();
    for (int i = 0; i < body.m_nodes.size(); ++i)
        writePosition(body.m_nodes[i].m_x, out);
}
}  // namespace

void SelfCollision::set(const btSoftBody& body, btScalar thickness)
{
    SelfColliding self = {thickness, {}};
    readRest(body, self.m_rest);
    m_bodies[&body] = std::move(self);
}

const SelfColliding* SelfCollision::find(const btSoftBody& body)
{
    const auto found = m_bodies.find(&body);
    if (found == m_bodies.end()) return nullptr;
    if (found->second.m_rest.size() != 3 * static_cast<std::size_t>(body.m_nodes.size()))
        readRest(body, found->second.m_rest);
    return &found->second;
}

btScalar SelfCollision::thicknessOf(const btSoftBody& body, const SelfColliding& self)
{
    return self.m_thickness > 0 ? self.m_thickness : 2 * marginOf(*body.getCollisionShape());
}
}  // namespace drape
