#include "bullet_plugin/adapter/motion_bounds.h"

#include <algorithm>
#include <cmath>

#include "BulletCollision/BroadphaseCollision/btBroadphaseInterface.h"
#include "BulletCollision/BroadphaseCollision/btOverlappingPairCache.h"
#include "BulletCollision/CollisionShapes/btCompoundShape.h"
#include "BulletCollision/NarrowPhaseCollision/btPersistentManifold.h"
#include "LinearMath/btAabbUtil2.h"
#include "bullet_plugin/adapter/eligibility.h"
#include "bullet_plugin/adapter/mesh_reader.h"
#include "bullet_plugin/adapter/plugin_state.h"

namespace drape
{
namespace
{
struct Extent
{
    btVector3 m_low = btVector3(SIMD_INFINITY, SIMD_INFINITY, SIMD_INFINITY), m_high = -m_low;

    bool empty() const { return m_low.x() > m_high.x(); }
    bool meets(const StepObstacle& obstacle, btScalar reach) const
    {
        const btVector3 margin(reach, reach, reach);
        return TestAabbAgainstAabb2(m_low - margin, m_high + margin, obstacle.m_low, obstacle.m_high);
    }
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

// Extents of a body's nodes at the start and the end of a step, without nodes that are not finite.
struct Way
{
    explicit Way(const btSoftBody& body)
    {
        for (int i = 0; i < body.m_nodes.size(); ++i)
        {
            const btSoftBody::Node& node = body.m_nodes[i];
            if (!finite(node.m_x) || !finite(node.m_q)) continue;
            m_start.add(node.m_q);
            m_end.add(node.m_x);
        }
    }

    // The paths as an obstacle sees them beside its bounds: those of its own pose, which the motion may not have
    // reached yet.
    Extent seenBy(const StepObstacle& obstacle) const
    {
        const btTransform& pose = obstacle.m_object->getWorldTransform();
        Extent seen;
        seen.addMapped(m_start, pose * obstacle.m_motion.m_start.inverse());
        seen.addMapped(m_end, pose * obstacle.m_motion.m_end.inverse());
        return seen;
    }

    Extent m_start, m_end;
};

// How much farther than the reach an obstacle may be from a body's paths and still widen its bounds, in thresholds that
// Bullet adds to every bounds. Links pull nodes off their paths, and where Bullet makes the pair then, the motion limit
// has to know of it.
constexpr btScalar kNearThresholds = 5;

// The body's part of the reach of contacts, m.
btScalar reachOf(const PluginState& state, const btSoftBody& body)
{
    return (1 + btScalar(state.settings().m_activation)) * body.getCollisionShape()->getMargin();
}

// What bounds of the shape lack of its part of that reach, m: of a compound the most that a child's lack.
btScalar reachBeyondBounds(const btCollisionShape& shape, btScalar activation)
{
    if (isMeshShape(shape.getShapeType())) return activation * shape.getMargin() + marginBeyondBounds(shape);
    btScalar most = 0;
    if (!shape.isCompound()) return most;
    const btCompoundShape& compound = static_cast<const btCompoundShape&>(shape);
    for (int i = 0; i < compound.getNumChildShapes(); ++i)
        most = btMax(most, reachBeyondBounds(*compound.getChildShape(i), activation));
    return most;
}

// Whether Bullet would hand their pair on and Drape find contacts of it once the body is awake.
bool mayTouch(const PluginState& state, const btSoftBody& body, const btCollisionObject& object)
{
    btOverlappingPairCache* pairs = body.m_worldInfo->m_broadphase->getOverlappingPairCache();
    btBroadphaseProxy* proxy = const_cast<btBroadphaseProxy*>(body.getBroadphaseHandle());
    btBroadphaseProxy* other = const_cast<btBroadphaseProxy*>(object.getBroadphaseHandle());
    return respond(body, object) && proxy && other && pairs->needsBroadphaseCollision(proxy, other) &&
           body.checkCollideWith(&object) && object.checkCollideWith(&body) &&
           handlesAny(state, body, object, *object.getCollisionShape());
}

class CollectObstacles : public btBroadphaseAabbCallback
{
public:
    CollectObstacles(KinematicMotions& motions, btScalar activation, bool resting)
        : m_motions(motions), m_activation(activation), m_resting(resting)
    {
    }

    bool process(const btBroadphaseProxy* proxy) override
    {
        const btCollisionObject* object = static_cast<const btCollisionObject*>(proxy->m_clientObject);
        if (!object || !object->isStaticOrKinematicObject()) return true;
        const btCollisionShape& shape = *object->getCollisionShape();
        if (!isMeshShape(shape.getShapeType()) && shape.getShapeType() != COMPOUND_SHAPE_PROXYTYPE) return true;
        const btTransform& pose = object->getWorldTransform();
        StepObstacle obstacle;
        obstacle.m_object = object;
        obstacle.m_motion = object->isKinematicObject() ? m_motions.observe(*object) : BodyMotion{pose, pose};
        if (!obstacle.m_motion.moves() && !m_resting) return true;
        shape.getAabb(pose, obstacle.m_low, obstacle.m_high);
        obstacle.m_reach = reachBeyondBounds(shape, m_activation);
        m_found.push_back(obstacle);
        return true;
    }

    std::vector<StepObstacle> m_found;

private:
    KinematicMotions& m_motions;
    const btScalar m_activation;
    const bool m_resting;
};
}  // namespace

std::vector<StepObstacle> stepObstacles(const PluginState& state, const btSoftBody& body, KinematicMotions& motions,
                                        bool resting)
{
    CollectObstacles collect(motions, btScalar(state.settings().m_activation), resting);
    btBroadphaseInterface* broadphase = body.m_worldInfo ? body.m_worldInfo->m_broadphase : nullptr;
    const btVector3 far(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
    if (broadphase) broadphase->aabbTest(-far, far, collect);
    return collect.m_found;
}

bool isReached(const PluginState& state, const btSoftBody& body, const std::vector<StepObstacle>& obstacles)
{
    const auto moves = [](const StepObstacle& obstacle) { return obstacle.m_motion.moves(); };
    if (std::none_of(obstacles.begin(), obstacles.end(), moves)) return false;
    Way rest(body);
    rest.m_start = rest.m_end;  // the last step that it was awake in is over
    if (rest.m_end.empty()) return false;
    const btScalar reach = reachOf(state, body);
    return std::any_of(obstacles.begin(), obstacles.end(),
                       [&](const StepObstacle& obstacle)
                       {
                           return moves(obstacle) && rest.seenBy(obstacle).meets(obstacle, reach + obstacle.m_reach) &&
                                  mayTouch(state, body, *obstacle.m_object);
                       });
}

void coverMotion(const PluginState& state, btSoftBody& body, const std::vector<StepObstacle>& obstacles)
{
    if (obstacles.empty()) return;
    const Way way(body);
    if (way.m_end.empty()) return;
    Extent path = way.m_start;
    path.add(way.m_end.m_low);
    path.add(way.m_end.m_high);
    if (!finite(body.m_bounds[0]) || !finite(body.m_bounds[1]))
    {
        body.m_bounds[0] = path.m_low;
        body.m_bounds[1] = path.m_high;
    }
    const btScalar own = reachOf(state, body);
    for (const StepObstacle& obstacle : obstacles)
    {
        const btScalar reach = own + obstacle.m_reach;
        const Extent seen = obstacle.m_motion.moves() ? way.seenBy(obstacle) : path;
        const btScalar nearness = reach + kNearThresholds * gContactBreakingThreshold;
        if (!path.meets(obstacle, nearness) && !seen.meets(obstacle, nearness)) continue;
        if (!mayTouch(state, body, *obstacle.m_object)) continue;
        widen(body, path, reach);
        widen(body, seen, reach);
    }
}
}  // namespace drape
