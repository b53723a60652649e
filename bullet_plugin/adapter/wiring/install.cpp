#include "BulletCollision/BroadphaseCollision/btBroadphaseInterface.h"
#include "BulletCollision/BroadphaseCollision/btOverlappingPairCache.h"
#include "BulletCollision/CollisionDispatch/btCollisionDispatcher.h"
#include "BulletCollision/CollisionDispatch/btCollisionWorld.h"
#include "BulletCollision/CollisionShapes/btCompoundShape.h"
#include "drape/drape.h"
#include "bullet_plugin/adapter/mirrors/mesh_reader.h"
#include "bullet_plugin/adapter/wiring/plugin_state.h"
#include "bullet_plugin/adapter/wiring/wiring.h"
#include "bullet_plugin/core/public_call.h"

namespace drape
{
namespace
{
bool isSoft(const btBroadphaseProxy* proxy)
{
    const btCollisionObject* object = static_cast<const btCollisionObject*>(proxy->m_clientObject);
    return object && object->getInternalType() == btCollisionObject::CO_SOFT_BODY;
}

// Destroys the algorithms of pairs with soft bodies, so that the dispatcher creates new ones.
void cleanSoftPairs(btCollisionDispatcher& dispatcher, btBroadphaseInterface& broadphase)
{
    btOverlappingPairCache& cache = *broadphase.getOverlappingPairCache();
    btBroadphasePairArray& pairs = cache.getOverlappingPairArray();
    for (int i = 0; i < pairs.size(); ++i)
        if (isSoft(pairs[i].m_pProxy0) || isSoft(pairs[i].m_pProxy1)) cache.cleanOverlappingPair(pairs[i], &dispatcher);
}

// Calls give(typeA, typeB) for the types of soft bodies and of shapes that Drape may take, in both orders.
template <class Give>
void forShapeTypes(const Give& give)
{
    for (int type = 0; type < MAX_BROADPHASE_COLLISION_TYPES; ++type)
    {
        if (!isReadableType(type)) continue;
        give(SOFTBODY_SHAPE_PROXYTYPE, type);
        give(type, SOFTBODY_SHAPE_PROXYTYPE);
    }
}

// Returns what the dispatcher had for the types without Drape.
btCollisionAlgorithmCreateFunc* stockFunction(btCollisionDispatcher& dispatcher, int typeA, int typeB)
{
    btCollisionConfiguration* configuration = dispatcher.getCollisionConfiguration();
    if (CollisionConfiguration* own = dynamic_cast<CollisionConfiguration*>(configuration))
        return own->btSoftBodyRigidBodyCollisionConfiguration::getCollisionAlgorithmCreateFunc(typeA, typeB);
    return configuration->getCollisionAlgorithmCreateFunc(typeA, typeB);
}
}  // namespace

bool takeGImpactBack(PluginState& state, const btSoftBody& cloth, const btCollisionObject& obstacle,
                     const btCollisionShape& shape)
{
    if (shape.isCompound())
    {
        const auto& compound = static_cast<const btCompoundShape&>(shape);
        for (int i = 0; i < compound.getNumChildShapes(); ++i)
            if (takeGImpactBack(state, cloth, obstacle, *compound.getChildShape(i))) return true;
        return false;
    }
    if (shape.getShapeType() != GIMPACT_SHAPE_PROXYTYPE) return false;
    auto* const dispatcher = dynamic_cast<btCollisionDispatcher*>(cloth.m_worldInfo->m_dispatcher);
    if (!dispatcher || pluginOf(*dispatcher, cloth, obstacle, shape) || pluginOf(*dispatcher) != &state) return true;
    const int soft = SOFTBODY_SHAPE_PROXYTYPE, gimpact = GIMPACT_SHAPE_PROXYTYPE;
    dispatcher->registerCollisionCreateFunc(soft, gimpact, &state.createFunction(false));
    dispatcher->registerCollisionCreateFunc(gimpact, soft, &state.createFunction(true));
    cleanSoftPairs(*dispatcher, *cloth.m_worldInfo->m_broadphase);
    return true;
}

bool install(Plugin& plugin, btCollisionDispatcher& dispatcher, btBroadphaseInterface& broadphase)
{
    if (!plugin.state()) return false;
    PluginState& state = *plugin.state();
    const auto give = [&](int typeA, int typeB)
    {
        const bool swapped = typeB == SOFTBODY_SHAPE_PROXYTYPE;
        dispatcher.registerCollisionCreateFunc(typeA, typeB, &state.createFunction(swapped));
    };
    return guardedOr(false,
                     [&]
                     {
                         const PluginState* owner = pluginOf(dispatcher);
                         if (owner && owner != &state) return false;
                         forShapeTypes(give);
                         cleanSoftPairs(dispatcher, broadphase);
                         state.forgetWorlds(static_cast<const btDispatcher*>(&dispatcher));
                         return true;
                     });
}

bool install(Plugin& plugin, btCollisionDispatcher& dispatcher, btCollisionWorld& world)
{
    return install(plugin, dispatcher, *world.getBroadphase());
}

bool uninstall(Plugin& plugin, btCollisionDispatcher& dispatcher, btBroadphaseInterface& broadphase)
{
    if (!plugin.state()) return false;
    const auto give = [&](int typeA, int typeB)
    { dispatcher.registerCollisionCreateFunc(typeA, typeB, stockFunction(dispatcher, typeA, typeB)); };
    return guardedOr(false,
                     [&]
                     {
                         if (pluginOf(dispatcher) != plugin.state().get()) return false;
                         forShapeTypes(give);
                         cleanSoftPairs(dispatcher, broadphase);
                         plugin.state()->forgetWorlds(static_cast<const btDispatcher*>(&dispatcher));
                         return true;
                     });
}

bool uninstall(Plugin& plugin, btCollisionDispatcher& dispatcher, btCollisionWorld& world)
{
    return uninstall(plugin, dispatcher, *world.getBroadphase());
}
}  // namespace drape
