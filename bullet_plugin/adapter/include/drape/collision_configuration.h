// Bullet's soft body collision configuration with cloth against triangle meshes handed to Drape.
//
// Use it in place of btSoftBodyRigidBodyCollisionConfiguration when the dispatcher is built. Pairs that Drape does not
// handle (Plugin::whyStock tells) get Bullet's own algorithm, decided anew at every step; but Bullet itself asks for an
// algorithm only once a pair, so that an object whose shape becomes one of another kind needs its pairs cleaned
// (btOverlappingPairCache::cleanProxyFromPairs). C++11.
#pragma once

#include <memory>

#include "BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h"
#include "drape/precision.h"

namespace drape
{
class Plugin;
class PluginState;

class CollisionConfiguration : public btSoftBodyRigidBodyCollisionConfiguration
{
public:
    explicit CollisionConfiguration(
        Plugin& plugin, const btDefaultCollisionConstructionInfo& info = btDefaultCollisionConstructionInfo());

    btCollisionAlgorithmCreateFunc* getCollisionAlgorithmCreateFunc(int proxyType0, int proxyType1) override;

private:
    std::shared_ptr<PluginState> m_state;
};
}  // namespace drape
