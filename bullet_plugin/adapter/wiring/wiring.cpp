#include "bullet_plugin/adapter/wiring/wiring.h"

#include "BulletCollision/BroadphaseCollision/btDispatcher.h"
#include "BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h"
#include "BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h"
#include "BulletCollision/CollisionShapes/btTriangleMesh.h"
#include "bullet_plugin/adapter/pairs/pair_algorithm.h"

namespace drape
{
const PluginState* pluginOf(btDispatcher& dispatcher, const btSoftBody& cloth, const btCollisionObject& obstacle,
                            const btCollisionShape& shape)
{
    const btCollisionObjectWrapper clothWrap(nullptr, cloth.getCollisionShape(), &cloth, cloth.getWorldTransform(), -1,
                                             -1);
    const btCollisionObjectWrapper meshWrap(nullptr, &shape, &obstacle, obstacle.getWorldTransform(), -1, -1);
    btCollisionAlgorithm* made = dispatcher.findAlgorithm(&clothWrap, &meshWrap, nullptr, BT_CONTACT_POINT_ALGORITHMS);
    if (!made) return nullptr;
    const PairAlgorithm* own = dynamic_cast<const PairAlgorithm*>(made);
    const PluginState* state = own ? &own->state() : nullptr;
    made->~btCollisionAlgorithm();
    dispatcher.freeCollisionAlgorithm(made);
    return state;
}

const PluginState* pluginOf(btDispatcher& dispatcher)
{
    btSoftBodyWorldInfo info;
    const btSoftBody cloth(&info);
    btTriangleMesh triangles;
    triangles.addTriangle(btVector3(0, 0, 0), btVector3(1, 0, 0), btVector3(0, 0, 1));
    btBvhTriangleMeshShape shape(&triangles, true, false);
    btCollisionObject obstacle;
    obstacle.setCollisionShape(&shape);
    return pluginOf(dispatcher, cloth, obstacle, shape);
}

const char* reasonFromDispatcher(const PluginState& state, const btSoftBody& cloth, const btCollisionObject& obstacle,
                                 const btCollisionShape& shape)
{
    const bool inWorld = cloth.getBroadphaseHandle() && obstacle.getBroadphaseHandle();
    btDispatcher* dispatcher = inWorld && cloth.m_worldInfo ? cloth.m_worldInfo->m_dispatcher : nullptr;
    if (!dispatcher) return nullptr;
    const PluginState* owner = pluginOf(*dispatcher, cloth, obstacle, shape);
    if (owner == &state) return nullptr;
    return owner ? "the world's dispatcher has another plugin's algorithm: drape::uninstall() that plugin first"
                 : "the world's dispatcher does not have Drape's algorithm: make it with a "
                   "drape::CollisionConfiguration, or call drape::install()";
}
}  // namespace drape
