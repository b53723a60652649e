#include "bullet_plugin/adapter/pairs/pair_algorithm.h"

#include <new>

#include "BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h"
#include "BulletSoftBody/btSoftBodyConcaveCollisionAlgorithm.h"
#include "bullet_plugin/adapter/pairs/eligibility.h"
#include "bullet_plugin/adapter/wiring/plugin_state.h"
#include "bullet_plugin/core/public_call.h"

namespace drape
{
static_assert(sizeof(PairAlgorithm) <= sizeof(btSoftBodyConcaveCollisionAlgorithm),
              "the dispatcher's pool holds elements of that size");

PairAlgorithm::PairAlgorithm(const btCollisionAlgorithmConstructionInfo& info, PluginState& state, bool swapped)
    : btCollisionAlgorithm(info), m_state(state), m_swapped(swapped)
{
}

PairAlgorithm::~PairAlgorithm()
{
    dropStock();
    m_state.forget(this);
}

void PairAlgorithm::processCollision(const btCollisionObjectWrapper* wrapA, const btCollisionObjectWrapper* wrapB,
                                     const btDispatcherInfo& info, btManifoldResult* result)
{
    const btCollisionObjectWrapper& clothWrap = m_swapped ? *wrapB : *wrapA;
    btSoftBody* cloth = const_cast<btSoftBody*>(btSoftBody::upcast(clothWrap.getCollisionObject()));
    if (!cloth) return;
    const bool forStock = guarded([&] { return !take(*cloth, m_swapped ? *wrapA : *wrapB); },
                                  [&](const CaughtException& caught)
                                  {
                                      m_state.fail("drape::PairAlgorithm::processCollision", caught);
                                      return false;
                                  });
    if (forStock) processStock(wrapA, wrapB, info, result);
}

// Notes the pair for the coming solve. Returns false if Bullet's own algorithm must handle it.
bool PairAlgorithm::take(btSoftBody& cloth, const btCollisionObjectWrapper& obstacleWrap)
{
    const btCollisionObject& obstacle = *obstacleWrap.getCollisionObject();
    const btCollisionShape& shape = *obstacleWrap.getCollisionShape();
    if (!m_state.steppingSolver(cloth)) m_state.markUnstepped(cloth);
    // Bullet's algorithm for a concave shape asks for one for the hull of each triangle.
    const bool isPart = !obstacleWrap.m_parent && &shape != obstacle.getCollisionShape();
    if (isPart || reasonForStock(m_state, cloth, obstacle, shape))
    {
        m_state.forget(this);
        return !stockCanTake(obstacle, shape, obstacleWrap.getWorldTransform());
    }
    dropStock();
    if (cloth.isActive() && respond(cloth, obstacle)) m_state.note(this, cloth, obstacleWrap);
    return true;
}

void PairAlgorithm::processStock(const btCollisionObjectWrapper* wrapA, const btCollisionObjectWrapper* wrapB,
                                 const btDispatcherInfo& info, btManifoldResult* result)
{
    const int type = (m_swapped ? wrapA : wrapB)->getCollisionShape()->getShapeType();
    btCollisionAlgorithmCreateFunc& create = m_state.stockCreateFunction(type, m_swapped);
    if (m_stockCreate != &create) dropStock();
    if (!m_stock)
    {
        btCollisionAlgorithmConstructionInfo construction(m_dispatcher, 0);
        m_stock = create.CreateCollisionAlgorithm(construction, wrapA, wrapB);
        m_stockCreate = &create;
    }
    if (m_stock) m_stock->processCollision(wrapA, wrapB, info, result);
}

void PairAlgorithm::dropStock()
{
    if (!m_stock) return;
    m_stock->~btCollisionAlgorithm();
    m_dispatcher->freeCollisionAlgorithm(m_stock);
    m_stock = nullptr;
}

btScalar PairAlgorithm::calculateTimeOfImpact(btCollisionObject* objectA, btCollisionObject* objectB,
                                              const btDispatcherInfo& info, btManifoldResult* result)
{
    return m_stock ? m_stock->calculateTimeOfImpact(objectA, objectB, info, result) : btScalar(1);
}

void PairAlgorithm::getAllContactManifolds(btManifoldArray& manifolds)
{
    if (m_stock) m_stock->getAllContactManifolds(manifolds);
}

PairCreateFunction::PairCreateFunction(PluginState& state, bool swapped) : m_state(state)
{
    m_swapped = swapped;
}

btCollisionAlgorithm* PairCreateFunction::CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                                   const btCollisionObjectWrapper*,
                                                                   const btCollisionObjectWrapper*)
{
    void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(PairAlgorithm));
    return new (memory) PairAlgorithm(info, m_state, m_swapped);
}
}  // namespace drape
