#include "bullet_plugin/adapter/motion/bounds_guard.h"

#include "BulletCollision/BroadphaseCollision/btBroadphaseInterface.h"
#include "BulletCollision/BroadphaseCollision/btOverlappingPairCache.h"
#include "bullet_plugin/adapter/collision/body_contacts.h"
#include "bullet_plugin/adapter/motion/motion_bounds.h"
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

btVector3 clamped(const btVector3& place, const btVector3& low, const btVector3& high)
{
    btVector3 inside = place;
    inside.setMax(low);
    inside.setMin(high);
    return inside;
}
}  // namespace

bool holdInBounds(const PluginState& state, btSoftBody& body, BodyContacts* contacts)
{
    const btBroadphaseProxy* const proxy = body.getBroadphaseHandle();
    if (!proxy || !body.m_worldInfo || !body.m_worldInfo->m_broadphase || body.m_nodes.size() == 0) return false;
    const btVector3 low = proxy->m_aabbMin, high = proxy->m_aabbMax;
    btVector3 least = low, greatest = high;  // over the bounds and the nodes; a node that is no number changes nothing
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        least.setMin(body.m_nodes[i].m_x);
        greatest.setMax(body.m_nodes[i].m_x);
    }
    if (!((low - least).length2() > 0) && !((greatest - high).length2() > 0)) return false;
    FindUnpaired unpaired(state, body);
    body.m_worldInfo->m_broadphase->aabbTest(least, greatest, unpaired);
    if (!unpaired.m_found) return false;
    bool any = false;
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        btSoftBody::Node& node = body.m_nodes[i];
        const btVector3 place = clamped(node.m_x, low, high), shift = place - node.m_x;
        if (!(shift.length2() > 0) || !(node.m_im > 0)) continue;
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
