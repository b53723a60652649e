#include "bullet_plugin/adapter/motion_bounds.h"

#include <cmath>

#include "BulletCollision/BroadphaseCollision/btBroadphaseInterface.h"
#include "LinearMath/btAabbUtil2.h"
#include "bullet_plugin/adapter/mesh_reader.h"

namespace drape
{
namespace
{
struct Extent
{
    btVector3 m_low = btVector3(SIMD_INFINITY, SIMD_INFINITY, SIMD_INFINITY), m_high = -m_low;

    bool empty() const { return m_low.x() > m_high.x(); }
    void add(const btVector3& p)
    {
        m_low.setMin(p);
        m_high.setMax(p);
    }
    void addMapped(const Extent& other, const btTransform& map)
    {
        for (int corner = 0; corner < 8; ++corner)
            add(map * btVector3(corner & 1 ? other.m_high.x() : other.m_low.x(),
                                corner & 2 ? other.m_high.y() : other.m_low.y(),
                                corner & 4 ? other.m_high.z() : other.m_low.z()));
    }
};

bool finite(const btVector3& v)
{
    return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z());
}

void widen(btSoftBody& body, const Extent& extent, btScalar reach)
{
    const btVector3 margin(reach, reach, reach);
    body.m_bounds[0].setMin(extent.m_low - margin);
    body.m_bounds[1].setMax(extent.m_high + margin);
}

class CollectMoving : public btBroadphaseAabbCallback
{
public:
    explicit CollectMoving(KinematicMotions& motions) : m_motions(motions) {}

    bool process(const btBroadphaseProxy* proxy) override
    {
        const btCollisionObject* object = static_cast<const btCollisionObject*>(proxy->m_clientObject);
        if (!object || !object->isKinematicObject()) return true;
        const int type = object->getCollisionShape()->getShapeType();
        if (!isMeshShape(type) && type != COMPOUND_SHAPE_PROXYTYPE) return true;
        const BodyMotion motion = m_motions.observe(*object);
        if (motion.moves()) m_found.push_back(MovingObject{object, motion});
        return true;
    }

    std::vector<MovingObject> m_found;

private:
    KinematicMotions& m_motions;
};
}  // namespace

std::vector<MovingObject> movingObjects(const btSoftBody& body, KinematicMotions& motions)
{
    CollectMoving collect(motions);
    btBroadphaseInterface* broadphase = body.m_worldInfo ? body.m_worldInfo->m_broadphase : nullptr;
    const btVector3 far(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
    if (broadphase) broadphase->aabbTest(-far, far, collect);
    return collect.m_found;
}

void coverMotion(btSoftBody& body, btScalar activation, const std::vector<MovingObject>& moving)
{
    Extent start, end;
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        const btSoftBody::Node& node = body.m_nodes[i];
        if (!finite(node.m_x) || !finite(node.m_q)) continue;
        end.add(node.m_x);
        start.add(node.m_q);
    }
    if (end.empty()) return;
    Extent path = start;
    path.add(end.m_low);
    path.add(end.m_high);
    const btScalar reach = (1 + activation) * body.getCollisionShape()->getMargin();
    widen(body, path, reach);
    for (const MovingObject& object : moving)
    {
        // Bullet's bounds of the object are those of its own pose, which the motion may not have reached yet.
        const btTransform& pose = object.m_object->getWorldTransform();
        Extent seen;
        seen.addMapped(start, pose * object.m_motion.m_start.inverse());
        seen.addMapped(end, pose * object.m_motion.m_end.inverse());
        btVector3 low, high;
        object.m_object->getCollisionShape()->getAabb(pose, low, high);
        const btScalar share = reach + activation * object.m_object->getCollisionShape()->getMargin();
        const btVector3 margin(share, share, share);
        if (TestAabbAgainstAabb2(seen.m_low - margin, seen.m_high + margin, low, high)) widen(body, seen, share);
    }
}
}  // namespace drape
