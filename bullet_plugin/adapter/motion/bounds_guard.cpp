#include "bullet_plugin/adapter/motion/bounds_guard.h"

#include "BulletCollision/BroadphaseCollision/btBroadphaseInterface.h"
#include "BulletCollision/BroadphaseCollision/btOverlappingPairCache.h"
#include "BulletCollision/CollisionShapes/btCompoundShape.h"
#include "LinearMath/btAabbUtil2.h"
#include "bullet_plugin/adapter/collision/body_contacts.h"
#include "bullet_plugin/adapter/mirrors/surface_reader.h"
#include "bullet_plugin/adapter/motion/motion_bounds.h"
#include "bullet_plugin/adapter/vectors.h"

namespace drape
{
namespace
{
// A box, m.
struct Bounds
{
    btVector3 m_low, m_high;

    bool meets(const Bounds& other) const { return TestAabbAgainstAabb2(m_low, m_high, other.m_low, other.m_high); }
};

// Returns whether a leaf of the shape meets the nodes and not the bounds. Only such a leaf is missed: the broad phase
// may still have a pair of an object that has gone, and a compound makes pairs of the children that meet the bounds.
bool isMissed(const btCollisionShape& shape, const btTransform& pose, const Bounds& nodes, const Bounds& bounds)
{
    if (isSurfaceShape(shape))
    {
        // The cells around the bounds were read, too.
        SurfaceBox read = {bounds.m_low, bounds.m_high};
        read.grow(read.slack());
        const SurfaceBox there = {nodes.m_low, nodes.m_high};
        return surfaceMeets(shape, pose, there, 0) && !read.contains(there);
    }
    if (!shape.isCompound())
    {
        Bounds own;
        shape.getAabb(pose, own.m_low, own.m_high);
        return own.meets(nodes) && !own.meets(bounds);
    }
    const auto& compound = static_cast<const btCompoundShape&>(shape);
    for (int i = 0; i < compound.getNumChildShapes(); ++i)
        if (isMissed(*compound.getChildShape(i), pose * compound.getChildTransform(i), nodes, bounds)) return true;
    return false;
}

// Looks for a mesh that Drape would handle and that has no pair with the body.
class FindUnpaired : public btBroadphaseAabbCallback
{
public:
    FindUnpaired(const PluginState& state, btSoftBody& body, const Bounds& nodes)
        : m_state(state), m_body(body), m_nodes(nodes), m_bounds{body.m_bounds[0], body.m_bounds[1]}
    {
    }

    bool process(const btBroadphaseProxy* proxy) override
    {
        const btCollisionObject* const object = static_cast<const btCollisionObject*>(proxy->m_clientObject);
        // Bullet goes on after false, too.
        if (m_found || !object || object == &m_body || !object->getCollisionShape()) return !m_found;
        btOverlappingPairCache* const pairs = m_body.m_worldInfo->m_broadphase->getOverlappingPairCache();
        const btCollisionShape& shape = *object->getCollisionShape();
        m_found = mayTouch(m_state, m_body, *object) &&
                  (!pairs->findPair(m_body.getBroadphaseHandle(), const_cast<btBroadphaseProxy*>(proxy)) ||
                   isMissed(shape, object->getWorldTransform(), m_nodes, m_bounds));
        return !m_found;
    }

    bool m_found = false;

private:
    const PluginState& m_state;
    btSoftBody& m_body;
    const Bounds m_nodes, m_bounds;
};

btVector3 clamped(const btVector3& place, const btVector3& low, const btVector3& high)
{
    btVector3 inside = place;
    inside.setMax(low);
    inside.setMin(high);
    return inside;
}
}  // namespace

bool leavesBounds(const PluginState& state, btSoftBody& body)
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
    FindUnpaired unpaired(state, body, {least, greatest});
    body.m_worldInfo->m_broadphase->aabbTest(least, greatest, unpaired);
    return unpaired.m_found;
}

bool holdInBounds(const PluginState& state, btSoftBody& body, BodyContacts* contacts)
{
    if (!leavesBounds(state, body)) return false;
    const btVector3 low = body.getBroadphaseHandle()->m_aabbMin, high = body.getBroadphaseHandle()->m_aabbMax;
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
