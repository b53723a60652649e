#include "bullet_plugin/adapter/cloth_cloth/soft_body_filters.h"

#include "BulletCollision/BroadphaseCollision/btBroadphaseInterface.h"
#include "BulletCollision/BroadphaseCollision/btOverlappingPairCache.h"
#include "bullet_plugin/adapter/cloth_cloth/state_hash.h"
#include "bullet_plugin/adapter/pairs/eligibility.h"

namespace drape
{
namespace
{
// Returns null if the body is in no world.
btOverlappingPairCache* pairCacheOf(const btSoftBody& body)
{
    btBroadphaseInterface* const broadphase = body.m_worldInfo ? body.m_worldInfo->m_broadphase : nullptr;
    return broadphase ? broadphase->getOverlappingPairCache() : nullptr;
}

// Bullet's getters of the proxy and of the ignored objects are not const.
btSoftBody& mutableBody(const btSoftBody& body)
{
    return const_cast<btSoftBody&>(body);
}
}  // namespace

bool filtersLetMeet(const btSoftBody& first, const btSoftBody& second)
{
    btBroadphaseProxy *const p = mutableBody(first).getBroadphaseHandle(), *const q = mutableBody(second)
                                                                                          .getBroadphaseHandle();
    if (!p || !q || !respond(first, second) || !respond(second, first)) return false;
    if (!first.checkCollideWith(&second) || !second.checkCollideWith(&first)) return false;
    if (const btOverlappingPairCache* const pairs = pairCacheOf(first)) return pairs->needsBroadphaseCollision(p, q);
    return (p->m_collisionFilterGroup & q->m_collisionFilterMask) != 0 &&
           (q->m_collisionFilterGroup & p->m_collisionFilterMask) != 0;
}

bool hasOwnFilter(const btSoftBody& body)
{
    btOverlappingPairCache* const pairs = pairCacheOf(body);
    return pairs && pairs->getOverlapFilterCallback();
}

std::uint64_t filterHash(const btSoftBody& body)
{
    StateHash hash;
    if (const btBroadphaseProxy* const proxy = body.getBroadphaseHandle())
        hash.add(std::uint64_t(std::uint32_t(proxy->m_collisionFilterGroup)))
            .add(std::uint64_t(std::uint32_t(proxy->m_collisionFilterMask)));
    hash.add(std::uint64_t(body.hasContactResponse()));
    hash.add(std::uint64_t(body.m_collisionDisabledObjects.size()));
    for (int i = 0; i < body.m_collisionDisabledObjects.size(); ++i)
        hash.add(body.m_collisionDisabledObjects[i]);
    for (int i = 0; i < body.getNumObjectsWithoutCollision(); ++i)
        hash.add(mutableBody(body).getObjectWithoutCollision(i));
    return hash.value();
}
}  // namespace drape
