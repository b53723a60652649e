// Bullet's soft body collision configuration with Drape's algorithm for cloth against triangle meshes, planes, height
// fields and convex shapes.
//
// Use it in place of btSoftBodyRigidBodyCollisionConfiguration when the dispatcher is built. Drape decides at every
// step which pairs it handles; Plugin::whyStock() names the reason for the others, which Bullet's own algorithm
// handles. Bullet asks for an algorithm once per pair: after an object's shape changes its kind, clean its pairs
// (btOverlappingPairCache::cleanProxyFromPairs). C++11.
#pragma once

#include <memory>

#include "BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h"
#include "drape/export.h"
#include "drape/precision.h"

namespace drape
{
class Plugin;
class PluginState;

// Registers Drape's algorithm. It shares the plugin's state and must outlive the world, as Bullet demands.
class DRAPE_EXPORT CollisionConfiguration : public btSoftBodyRigidBodyCollisionConfiguration
{
public:
    // Registers the algorithm of `plugin`; `info` is passed to Bullet.
    explicit CollisionConfiguration(
        Plugin& plugin, const btDefaultCollisionConstructionInfo& info = btDefaultCollisionConstructionInfo());

    // Ends after the dispatcher, as Bullet demands.
    ~CollisionConfiguration() override;

    // Returns Drape's algorithm for a soft body and a shape that Drape may handle, Bullet's own otherwise. Called by
    // Bullet.
    btCollisionAlgorithmCreateFunc* getCollisionAlgorithmCreateFunc(int proxyType0, int proxyType1) override;

private:
    std::shared_ptr<PluginState> m_state;
};
}  // namespace drape
