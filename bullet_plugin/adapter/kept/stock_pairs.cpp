#include "bullet_plugin/adapter/kept/stock_pairs.h"

#include "BulletCollision/BroadphaseCollision/btBroadphaseInterface.h"
#include "BulletCollision/CollisionShapes/btCompoundShape.h"
#include "BulletCollision/CollisionShapes/btStaticPlaneShape.h"
#include "BulletSoftBody/btSoftBody.h"
#include "bullet_plugin/adapter/pairs/eligibility.h"
#include "bullet_plugin/adapter/wiring/plugin_state.h"

namespace drape
{
namespace
{
// Returns whether Bullet looks for contacts of the two soft bodies.
bool bothCollide(const btSoftBody& a, const btSoftBody& b)
{
    return (a.m_cfg.collisions & b.m_cfg.collisions & btSoftBody::fCollision::SVSmask) != 0;
}

// Returns whether the body's bounds reach below a static plane, whose own bounds are infinite.
bool reachesBelow(const btSoftBody& body, const btCollisionObject& object, const btStaticPlaneShape& plane)
{
    const btVector3 normal = object.getWorldTransform().getBasis() * plane.getPlaneNormal();
    const btVector3 origin = object.getWorldTransform() * (plane.getPlaneNormal() * plane.getPlaneConstant());
    btVector3 lowest;
    for (int axis = 0; axis < 3; ++axis)
        lowest[axis] = body.m_bounds[normal[axis] > 0 ? 0 : 1][axis];
    return normal.dot(lowest - origin) <= plane.getMargin();
}

// Returns whether Drape handles the pair, with each child of a compound.
bool handlesAll(const PluginState& state, const btSoftBody& body, const btCollisionObject& object,
                const btCollisionShape& shape)
{
    if (!shape.isCompound()) return !reasonForStock(state, body, object, shape);
    const auto& compound = static_cast<const btCompoundShape&>(shape);
    for (int i = 0; i < compound.getNumChildShapes(); ++i)
        if (!handlesAll(state, body, object, *compound.getChildShape(i))) return false;
    return true;
}

class FindStock : public btBroadphaseAabbCallback
{
public:
    FindStock(const PluginState& state, const btSoftBody& body) : m_state(state), m_body(body) {}

    bool process(const btBroadphaseProxy* proxy) override
    {
        const auto* const object = static_cast<const btCollisionObject*>(proxy->m_clientObject);
        m_found = m_found ||
                  (object && object != &m_body && object->getCollisionShape() && isStockPair(m_state, m_body, *object));
        return !m_found;
    }

    bool m_found = false;

private:
    const PluginState& m_state;
    const btSoftBody& m_body;
};
}  // namespace

bool isStockPair(const PluginState& state, const btSoftBody& body, const btCollisionObject& object)
{
    if (!respond(body, object) || !body.checkCollideWith(&object) || !object.checkCollideWith(&body)) return false;
    if (const btSoftBody* const other = btSoftBody::upcast(&object)) return bothCollide(body, *other);
    const btCollisionShape& shape = *object.getCollisionShape();
    if (handlesAll(state, body, object, shape)) return false;
    return shape.getShapeType() != STATIC_PLANE_PROXYTYPE ||
           reachesBelow(body, object, static_cast<const btStaticPlaneShape&>(shape));
}

bool anyStockPair(const PluginState& state, const btSoftBody& body)
{
    FindStock stock(state, body);
    body.m_worldInfo->m_broadphase->aabbTest(body.m_bounds[0], body.m_bounds[1], stock);
    return stock.m_found;
}
}  // namespace drape
