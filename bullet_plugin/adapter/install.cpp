#include "BulletCollision/BroadphaseCollision/btBroadphaseInterface.h"
#include "BulletCollision/BroadphaseCollision/btOverlappingPairCache.h"
#include "BulletCollision/CollisionDispatch/btCollisionDispatcher.h"
#include "BulletCollision/CollisionDispatch/btCollisionWorld.h"
#include "drape/drape.h"
#include "bullet_plugin/adapter/mesh_reader.h"
#include "bullet_plugin/adapter/plugin_state.h"

namespace drape
{
namespace
{
bool isSoft(const btBroadphaseProxy* proxy)
{
    const btCollisionObject* object = static_cast<const btCollisionObject*>(proxy->m_clientObject);
    return object && object->getInternalType() == btCollisionObject::CO_SOFT_BODY;
}
}  // namespace

void install(Plugin& plugin, btCollisionDispatcher& dispatcher, btBroadphaseInterface& broadphase)
{
    PluginState& state = *plugin.state();
    state.addWiring(&dispatcher);
    for (int type = 0; type < MAX_BROADPHASE_COLLISION_TYPES; ++type)
    {
        if (!isMeshShape(type)) continue;
        dispatcher.registerCollisionCreateFunc(SOFTBODY_SHAPE_PROXYTYPE, type, &state.createFunction(false));
        dispatcher.registerCollisionCreateFunc(type, SOFTBODY_SHAPE_PROXYTYPE, &state.createFunction(true));
    }
    btOverlappingPairCache& cache = *broadphase.getOverlappingPairCache();
    btBroadphasePairArray& pairs = cache.getOverlappingPairArray();
    for (int i = 0; i < pairs.size(); ++i)
        if (isSoft(pairs[i].m_pProxy0) || isSoft(pairs[i].m_pProxy1)) cache.cleanOverlappingPair(pairs[i], &dispatcher);
}

void install(Plugin& plugin, btCollisionDispatcher& dispatcher, btCollisionWorld& world)
{
    install(plugin, dispatcher, *world.getBroadphase());
}
}  // namespace drape
