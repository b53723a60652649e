#include "bullet_plugin/adapter/motion/motion_bounds.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "BulletCollision/BroadphaseCollision/btBroadphaseInterface.h"
#include "BulletCollision/BroadphaseCollision/btOverlappingPairCache.h"
#include "BulletCollision/CollisionShapes/btCompoundShape.h"
#include "BulletCollision/NarrowPhaseCollision/btPersistentManifold.h"
#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "LinearMath/btAabbUtil2.h"
#include "bullet_plugin/adapter/mirrors/mesh_reader.h"
#include "bullet_plugin/adapter/pairs/eligibility.h"
#include "bullet_plugin/adapter/pairs/margins.h"
#include "bullet_plugin/adapter/solver/body_jobs.h"
#include "bullet_plugin/adapter/wiring/plugin_state.h"

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
        const btCollisionShape& shape = *obstacle.m_object->getCollisionShape();
        if (isSurfaceShape(shape))
            return surfaceMeets(shape, obstacle.m_object->getWorldTransform(), {m_low, m_high}, reach);
        const btVector3 margin(reach, reach, reach);
        return TestAabbAgainstAabb2(m_low - margin, m_high + margin, obstacle.m_low, obstacle.m_high);
    }
    void add(const btVector3& p)
    {
        m_low.setMin(p);
        m_high.setMax(p);
    }
    void add(const Extent& other)
    {
        m_low.setMin(other.m_low);
        m_high.setMax(other.m_high);
    }
    void addMapped(const Extent& other, const btTransform& map)
    {
        for (int corner = 0; corner < 8; ++corner)
            add(map * btVector3(corner & 1 ? other.m_high.x() : other.m_low.x(),
                                corner & 2 ? other.m_high.y() : other.m_low.y(),
                                corner & 4 ? other.m_high.z() : other.m_low.z()));
    }
};

// Minimum change of a mesh's box, as a share of its size: less is rounding.
constexpr btScalar kLeastChange = btScalar(1e-5);

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
struct BodyPath
{
    BodyPath() = default;
    // threads: null for the caller alone.
    BodyPath(const btSoftBody& body, ThreadTeam* threads)
    {
        std::mutex mutex;
        const auto read = [&](std::size_t first, std::size_t last)
        {
            BodyPath part;
            for (std::size_t i = first; i < last; ++i)
            {
                const btSoftBody::Node& node = body.m_nodes[static_cast<int>(i)];
                if (!finite(node.m_x) || !finite(node.m_q)) continue;
                part.m_start.add(node.m_q);
                part.m_end.add(node.m_x);
            }
            const std::lock_guard<std::mutex> lock(mutex);
            m_start.add(part.m_start);
            m_end.add(part.m_end);
        };
        forRanges(static_cast<std::size_t>(body.m_nodes.size()), threads, read);
    }

    // The extents of a body on the device.
    explicit BodyPath(const KeptBoxes& boxes)
    {
        const auto toExtent = [&](int box)
        {
            Extent extent;
            for (int axis = 0; axis < 3; ++axis)
            {
                extent.m_low[axis] = btScalar(boxes.m_low[box][axis]);
                extent.m_high[axis] = btScalar(boxes.m_high[box][axis]);
            }
            return extent;
        };
        m_start = toExtent(0);
        m_end = toExtent(2);
    }
    static BodyPath of(const PluginState& state, const btSoftBody& body, ThreadTeam* threads)
    {
        return state.m_kept.isOnDevice(body) ? BodyPath(state.m_kept.boxesOf(body)) : BodyPath(body, threads);
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

// Widens the bounds to the obstacle's surface point that is nearest to the middle of the paths.
void reachTo(btSoftBody& body, const Extent& path, const StepObstacle& obstacle)
{
    btVector3 nearest = (path.m_low + path.m_high) / 2;
    nearest.setMax(obstacle.m_low);
    nearest.setMin(obstacle.m_high);
    Extent there;
    there.add(nearest);
    widen(body, there, 0);
}

// Distance beyond the reach, in Bullet's bounds thresholds, at which an obstacle still widens the bounds of a body's
// paths. Links pull nodes off their paths. If Bullet makes the pair then, the motion limit has to know the obstacle.
constexpr btScalar kNearThresholds = 5;

// The body's part of the reach of contacts, m.
btScalar reachOf(const PluginState& state, const btSoftBody& body)
{
    return (1 + btScalar(state.settings().m_activation)) * marginOf(*body.getCollisionShape());
}

// Returns how far the shape's bounds fall short of its part of that reach, m: for a compound the most of any child.
btScalar reachBeyondBounds(const btCollisionShape& shape, btScalar activation)
{
    if (isReadable(shape)) return activation * meshMargin(shape) + marginBeyondBounds(shape);
    btScalar most = 0;
    if (!shape.isCompound()) return most;
    const btCompoundShape& compound = static_cast<const btCompoundShape&>(shape);
    for (int i = 0; i < compound.getNumChildShapes(); ++i)
        most = btMax(most, reachBeyondBounds(*compound.getChildShape(i), activation));
    return most;
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
        if (!object || !object->getCollisionShape()) return true;
        if (!object->isStaticOrKinematicObject() && !btRigidBody::upcast(object) && !isLink(*object)) return true;
        const btCollisionShape& shape = *object->getCollisionShape();
        if (!shape.isCompound() && !isReadable(shape)) return true;
        const btTransform& pose = object->getWorldTransform();
        StepObstacle obstacle;
        obstacle.m_object = object;
        obstacle.m_motion = motionOf(*object);
        obstacle.m_isDynamic = !object->isStaticOrKinematicObject();
        shape.getAabb(pose, obstacle.m_low, obstacle.m_high);
        // Bullet's box of a dynamic body changes with its velocity.
        const bool mayChange = (shape.isCompound() || isMeshShape(shape)) && object->isStaticOrKinematicObject() &&
                               !obstacle.m_motion.moves();
        obstacle.m_change = mayChange ? changeOf(obstacle, *proxy) : btScalar(0);
        if (!obstacle.isActive() && !m_resting) return true;
        obstacle.m_reach = reachBeyondBounds(shape, m_activation);
        m_found.push_back(obstacle);
        return true;
    }

    std::vector<StepObstacle> m_found;

private:
    // Bullet has predicted a dynamic body's pose at the step's end.
    BodyMotion motionOf(const btCollisionObject& object) const
    {
        const btTransform& pose = object.getWorldTransform();
        if (object.isKinematicObject()) return m_motions.observe(object);
        const bool moves = !object.isStaticObject() && object.isActive();
        return BodyMotion{pose, moves ? object.getInterpolationWorldTransform() : pose};
    }
    // The broad phase still has the box of the step before, grown by the breaking threshold but for an object that was
    // just added. A box that changes by more than its size is another pose.
    static btScalar changeOf(const StepObstacle& mesh, const btBroadphaseProxy& proxy)
    {
        const btVector3 extent = mesh.m_high - mesh.m_low;
        const btScalar size = std::max(extent.x(), std::max(extent.y(), extent.z()));
        const btScalar change = std::min(changeOf(mesh, proxy, 0), changeOf(mesh, proxy, gContactBreakingThreshold));
        return change > kLeastChange * size && change <= size ? change : btScalar(0);
    }
    static btScalar changeOf(const StepObstacle& mesh, const btBroadphaseProxy& proxy, btScalar grown)
    {
        btScalar change = 0;
        for (int axis = 0; axis < 3; ++axis)
        {
            change = std::max(change, btFabs(mesh.m_low[axis] - grown - proxy.m_aabbMin[axis]));
            change = std::max(change, btFabs(mesh.m_high[axis] + grown - proxy.m_aabbMax[axis]));
        }
        return change;
    }

    KinematicMotions& m_motions;
    const btScalar m_activation;
    const bool m_resting;
};

// Returns how far a dynamic body's points come in the step, m, at most.
btScalar wayOf(const StepObstacle& obstacle)
{
    const BodyMotion& motion = obstacle.m_motion;
    const btScalar turn = motion.m_start.getRotation().angleShortestPath(motion.m_end.getRotation());
    return (motion.m_end.getOrigin() - motion.m_start.getOrigin()).length() +
           turn * (obstacle.m_high - obstacle.m_low).length();
}

// Returns how far a hit may bring a dynamic body from where Bullet predicts it, m: a heavy body that meets a light one
// leaves it with twice its own speed.
btScalar farthestStray(const std::vector<BodyPath>& paths, const std::vector<StepObstacle>& obstacles)
{
    btScalar most = 0;
    for (const StepObstacle& obstacle : obstacles)
        if (obstacle.m_isDynamic && obstacle.m_motion.moves()) most = std::max(most, wayOf(obstacle));
    if (most == 0) return 0;
    for (const BodyPath& path : paths)
    {
        if (path.m_end.empty() || path.m_start.empty()) continue;
        most = std::max(most, (path.m_end.m_low - path.m_start.m_low).length());
        most = std::max(most, (path.m_end.m_high - path.m_start.m_high).length());
    }
    return 2 * most;
}

// farthest: m, see farthestStray().
void coverMotion(const PluginState& state, btSoftBody& body, const BodyPath& bodyPath, btScalar farthest,
                 const std::vector<StepObstacle>& obstacles)
{
    if (bodyPath.m_end.empty()) return;
    Extent path = bodyPath.m_start;
    path.add(bodyPath.m_end.m_low);
    path.add(bodyPath.m_end.m_high);
    if (!finite(body.m_bounds[0]) || !finite(body.m_bounds[1]))
    {
        body.m_bounds[0] = path.m_low;
        body.m_bounds[1] = path.m_high;
    }
    const btScalar own = reachOf(state, body);
    for (const StepObstacle& obstacle : obstacles)
    {
        const btScalar reach = own + obstacle.m_reach;
        const Extent seen = obstacle.m_motion.moves() ? bodyPath.seenBy(obstacle) : path;
        const btScalar nearness = reach + kNearThresholds * gContactBreakingThreshold;
        const btScalar stray = obstacle.m_isDynamic ? farthest : 2 * obstacle.m_change;
        const bool mayArrive = stray > 0 && path.meets(obstacle, reach + stray);
        if (!path.meets(obstacle, nearness) && !seen.meets(obstacle, nearness) && !mayArrive) continue;
        if (!mayTouch(state, body, *obstacle.m_object)) continue;
        if (mayArrive) reachTo(body, path, obstacle);
        widen(body, path, reach);
        widen(body, seen, reach);
    }
}
}  // namespace

bool mayTouch(const PluginState& state, const btSoftBody& body, const btCollisionObject& object)
{
    btOverlappingPairCache* pairs = body.m_worldInfo->m_broadphase->getOverlappingPairCache();
    btBroadphaseProxy* proxy = const_cast<btBroadphaseProxy*>(body.getBroadphaseHandle());
    btBroadphaseProxy* other = const_cast<btBroadphaseProxy*>(object.getBroadphaseHandle());
    return respond(body, object) && proxy && other && pairs->needsBroadphaseCollision(proxy, other) &&
           body.checkCollideWith(&object) && object.checkCollideWith(&body) &&
           handlesAny(state, body, object, *object.getCollisionShape());
}

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
    const auto isActive = [](const StepObstacle& obstacle) { return obstacle.isActive(); };
    if (std::none_of(obstacles.begin(), obstacles.end(), isActive)) return false;
    BodyPath rest = BodyPath::of(state, body, nullptr);
    (state.m_kept.isOnDevice(body) ? rest.m_end : rest.m_start) =
        state.m_kept.isOnDevice(body) ? rest.m_start : rest.m_end;  // the last step that it was awake in is over
    if (rest.m_end.empty()) return false;
    const btScalar reach = reachOf(state, body);
    return std::any_of(obstacles.begin(), obstacles.end(),
                       [&](const StepObstacle& obstacle)
                       {
                           if (!obstacle.isActive()) return false;
                           const btScalar margin = reach + obstacle.m_reach + 2 * obstacle.m_change;
                           return rest.seenBy(obstacle).meets(obstacle, margin) &&
                                  mayTouch(state, body, *obstacle.m_object);
                       });
}

void coverMotions(const PluginState& state, const std::vector<btSoftBody*>& bodies,
                  const std::vector<StepObstacle>& obstacles, ThreadTeam& threads)
{
    if (obstacles.empty()) return;
    const auto sizeOf = [&](std::size_t i)
    { return bodies[i]->isActive() ? static_cast<std::size_t>(bodies[i]->m_nodes.size()) : 0; };
    std::vector<BodyPath> paths(bodies.size());
    forBodies(bodies.size(), threads, sizeOf,
              [&](std::size_t i, ThreadTeam* team) { paths[i] = BodyPath::of(state, *bodies[i], team); });
    const btScalar farthest = farthestStray(paths, obstacles);
    // Filters of the app are called on this thread alone.
    for (std::size_t i = 0; i < bodies.size(); ++i)
        if (bodies[i]->isActive()) coverMotion(state, *bodies[i], paths[i], farthest, obstacles);
}
}  // namespace drape
