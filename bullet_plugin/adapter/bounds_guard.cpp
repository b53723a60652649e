#include "bullet_plugin/adapter/bounds_guard.h"

#include "BulletCollision/BroadphaseCollision/btBroadphaseInterface.h"
#include "BulletCollision/BroadphaseCollision/btOverlappingPairCache.h"
#include "bullet_plugin/adapter/body_contacts.h"
#include "bullet_plugin/adapter/motion_bounds.h"
#include "bullet_plugin/adapter/vectors.h"

namespace drape
{
namespace
{
// Looks for a mesh that Drape would handle and that has no pair with the body.
class FindUnpaired : public btBroadphaseAabbCallback
{
public:
    FindUnpaired(const PluginState& state, btSoftBody& body) : m_state(state), m_body(body) {}

    bool process(const btBroadphaseProxy* proxy) override
    {
        const btCollisionObject* const object = static_cast<const btCollisionObject*>(proxy->m_clientObject);
        if (!object || object == &m_body || !object->getCollisionShape()) return true;
        btOverlappingPairCache* const pairs = m_body.m_worldInfo->m_broadphase->getOverlappingPairCache();
        m_found = mayTouch(m_state, m_body, *object) &&
                  !pairs->findPair(m_body.getBroadphaseHandle(), const_cast<btBroadphaseProxy*>(proxy));
        return !m_found;
    }

    bool m_found = false;

private:
    const PluginState& m_state;
    btSoftBody& m_body;
};
}  // namespace

bool holdInBounds(const PluginState& state, btSoftBody& body, BodyContacts* contacts)
{
    const btBroadphaseProxy* const proxy = body.getBroadphaseHandle();
    if (!proxy || !body.m_worldInfo || !body.m_worldInfo->m_broadphase || body.m_nodes.size() == 0) return false;
    btVector3 low = body.m_nodes[0].m_x, high = low;
    for (int i = 1; i < body.m_nodes.size(); ++i)
    {
        low.setMin(body.m_nodes[i].m_x);
        high.setMax(body.m_nodes[i].m_x);
    }
    btVector3 inner = low, outer = high;
    inner.setMax(proxy->m_aabbMin);
    outer.setMin(proxy->m_aabbMax);
    if (inner == low && outer == high) return false;
    FindUnpaired unpaired(state, body);
    body.m_worldInfo->m_broadphase->aabbTest(low, high, unpaired);
    if (!unpaired.m_found) return false;
    bool any = false;
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        btSoftBody::Node& node = body.m_nodes[i];
        btVector3 place = node.m_x;
        place.setMax(proxy->m_aabbMin);
        place.setMin(proxy->m_aabbMax);
        const btVector3 shift = place - node.m_x;
        if (shift.fuzzyZero() || !(node.m_im > 0)) continue;
        any = true;
        node.m_x = place;
        node.m_v += shift * body.m_sst.isdt;
        if (!contacts) continue;
        contacts->nodes().shift(std::size_t(i), vec3Of(shift));
        contacts->nodes().setVelocity(std::size_t(i), vec3Of(node.m_v));
        contacts->m_contacts.m_mayHavePassed = true;
    }
    return any;
}
}  // namespace drape
