#include "drape/collision_configuration.h"

#include "drape/plugin.h"
#include "bullet_plugin/adapter/mirrors/mesh_reader.h"
#include "bullet_plugin/adapter/wiring/plugin_state.h"

namespace drape
{
CollisionConfiguration::CollisionConfiguration(Plugin& plugin, const btDefaultCollisionConstructionInfo& info)
    : btSoftBodyRigidBodyCollisionConfiguration(info), m_state(plugin.state())
{
}

CollisionConfiguration::~CollisionConfiguration()
{
    if (m_state) m_state->forgetWorlds(static_cast<const btCollisionConfiguration*>(this));
}

btCollisionAlgorithmCreateFunc* CollisionConfiguration::getCollisionAlgorithmCreateFunc(int proxyType0, int proxyType1)
{
    const auto stock = [&]
    { return btSoftBodyRigidBodyCollisionConfiguration::getCollisionAlgorithmCreateFunc(proxyType0, proxyType1); };
    if (!m_state) return stock();
    if (proxyType0 == SOFTBODY_SHAPE_PROXYTYPE && isReadableType(proxyType1)) return &m_state->createFunction(false);
    if (isReadableType(proxyType0) && proxyType1 == SOFTBODY_SHAPE_PROXYTYPE) return &m_state->createFunction(true);
    return stock();
}
}  // namespace drape
