#include "bullet_plugin/adapter/cloth_cloth/self_collision.h"

#include <algorithm>

#include "BulletCollision/BroadphaseCollision/btBroadphaseProxy.h"
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
    std::vector<float> rest;
    readRest(body, rest);
    SelfColliding& self = m_bodies[&body];
    self.m_thickness = thickness;
    self.m_isAsked = self.m_meetsItself = self.m_meetsOthers = true;
    self.m_revision = ++m_lastRevision;
    self.m_rest.swap(rest);
}

void SelfCollision::startAnew(const btCollisionObject& object)
{
    for (auto& entry : m_bodies)
        if (entry.first == &object) entry.second.m_ends.clear();
}

bool SelfCollision::isAsked(const btSoftBody& body) const
{
    const auto found = m_bodies.find(&body);
    return found != m_bodies.end() && found->second.m_isAsked;
}

bool SelfCollision::asksItself(const btSoftBody& body) const
{
    return m_heedsFlags && (body.m_useSelfCollision || (body.m_cfg.collisions & btSoftBody::fCollision::CL_SELF));
}

bool SelfCollision::asksOthers(const btSoftBody& body) const
{
    return m_heedsFlags && (body.m_cfg.collisions & btSoftBody::fCollision::VF_SS);
}

SelfColliding* SelfCollision::find(const btSoftBody& body)
{
    auto found = m_bodies.find(&body);
    if (!isAsked(body))
    {
        const bool meetsOthers = asksOthers(body), meetsItself = asksItself(body);
        if (!meetsOthers && !meetsItself)
        {
            if (found != m_bodies.end()) m_bodies.erase(found);
            return nullptr;
        }
        if (found == m_bodies.end()) found = m_bodies.emplace(&body, SelfColliding()).first;
        found->second.m_meetsItself = meetsItself;
        found->second.m_meetsOthers = meetsOthers;
    }
    const int proxy = body.getBroadphaseHandle() ? body.getBroadphaseHandle()->m_uniqueId : 0;
    if (found->second.m_proxy != proxy)
    {
        if (!found->second.m_isAsked) found->second.m_rest.clear();
        found->second.m_ends.clear();
        found->second.m_proxy = proxy;
    }
    if (found->second.m_rest.size() != 3 * static_cast<std::size_t>(body.m_nodes.size()))
    {
        found->second.m_revision = ++m_lastRevision;
        readRest(body, found->second.m_rest);
    }
    return &found->second;
}

bool SelfCollision::takes(const btSoftBody& body, const btSoftBody& other)
{
    if (!m_heedsFlags) return false;
    const SelfColliding *const first = find(body), *const second = find(other);
    const int both = body.m_cfg.collisions & other.m_cfg.collisions & btSoftBody::fCollision::SVSmask;
    if (both & (btSoftBody::fCollision::CL_SS | btSoftBody::fCollision::VF_DD)) return false;
    return first && second && first->m_meetsOthers && second->m_meetsOthers;
}

btScalar SelfCollision::thicknessOf(const btSoftBody& body, const SelfColliding& self)
{
    const btScalar asked = self.m_thickness > 0 ? self.m_thickness : 2 * marginOf(*body.getCollisionShape());
    return std::max(kMinThickness, asked);
}
}  // namespace drape
