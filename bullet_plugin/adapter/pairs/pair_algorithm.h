// Bullet's collision algorithm for one pair of a soft body and a shape that Drape may take. Notes the pair for the
// coming solve, or passes it to Bullet's own algorithm, which is created only when needed.
//
// Guarantee: Drape's collision work does not happen here. The object fits the dispatcher's pool, whose elements have
// the size of Bullet's own concave algorithm and which only asserts.
#pragma once

#include "BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h"
#include "BulletCollision/CollisionDispatch/btCollisionCreateFunc.h"

class btSoftBody;

namespace drape
{
class PluginState;

class PairAlgorithm : public btCollisionAlgorithm
{
public:
    PairAlgorithm(const btCollisionAlgorithmConstructionInfo& info, PluginState& state, bool swapped);
    ~PairAlgorithm() override;

    const PluginState& state() const { return m_state; }

    void processCollision(const btCollisionObjectWrapper* wrapA, const btCollisionObjectWrapper* wrapB,
                          const btDispatcherInfo& info, btManifoldResult* result) override;
    btScalar calculateTimeOfImpact(btCollisionObject* objectA, btCollisionObject* objectB, const btDispatcherInfo& info,
                                   btManifoldResult* result) override;
    void getAllContactManifolds(btManifoldArray& manifolds) override;

private:
    bool take(btSoftBody& cloth, const btCollisionObjectWrapper& obstacleWrap);
    void processStock(const btCollisionObjectWrapper* wrapA, const btCollisionObjectWrapper* wrapB,
                      const btDispatcherInfo& info, btManifoldResult* result);
    void dropStock();

    PluginState& m_state;
    btCollisionAlgorithm* m_stock = nullptr;                        // from the dispatcher's pool
    const btCollisionAlgorithmCreateFunc* m_stockCreate = nullptr;  // made it
    const bool m_swapped;                                           // the mesh is the first of the pair
};

// The function that the dispatcher calls for a new pair. `swapped`: the mesh comes first.
class PairCreateFunction : public btCollisionAlgorithmCreateFunc
{
public:
    PairCreateFunction(PluginState& state, bool swapped);
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* wrapA,
                                                   const btCollisionObjectWrapper* wrapB) override;

private:
    PluginState& m_state;
};
}  // namespace drape
