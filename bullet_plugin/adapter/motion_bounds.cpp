#include "bullet_plugin/adapter/motion_bounds.h"

#include <algorithm>
#include <cmath>

#include "BulletCollision/BroadphaseCollision/btBroadphaseInterface.h"
#include "BulletCollision/BroadphaseCollision/btOverlappingPairCache.h"
#include "BulletCollision/NarrowPhaseCollision/btPersistentManifold.h"
#include "LinearMath/btAabbUtil2.h"
#include "bullet_plugin/adapter/eligibility.h"
#include "bullet_plugin/adapter/margins.h"
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

// Share of its size by which a mesh's box changes at least: less is rounding.
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

// Of the places of a body's nodes; nodes that are not finite left out.
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

    Extent m_start, m_end;
};

// The body's part of the reach of contacts, m.
btScalar reachOf(const btSoftBody& body, btScalar activation)
{
    return (1 + activation) * marginOf(*body.getCollisionShape());
}

// A body's way through the step as a moving object sees it, beside the bounds that Bullet has of that object: those of
// its own pose, which the motion may not have reached yet.
struct Sight
{
    Sight(const btSoftBody& body, const Way& way, const MovingObject& object, btScalar activation)
    {
        const btTransform& pose = object.m_object->getWorldTransform();
        const btCollisionShape& shape = *object.m_object->getCollisionShape();
        m_seen.addMapped(way.m_start, pose * object.m_motion.m_start.inverse());
        m_seen.addMapped(way.m_end, pose * object.m_motion.m_end.inverse());
        shape.getAabb(pose, m_low, m_high);
        m_reach = reachOf(body, activation) + activation * marginOf(shape);
    }
    bool comesNear() const
    {
        const btVector3 margin(m_reach, m_reach, m_reach);
        return TestAabbAgainstAabb2(m_seen.m_low - margin, m_seen.m_high + margin, m_low, m_high);
    }

    Extent m_seen;
    btVector3 m_low, m_high;
    btScalar m_reach;  // m, but for what the object's bounds hold
};

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

class CollectMoving : public btBroadphaseAabbCallback
{
public:
    explicit CollectMoving(KinematicMotions& motions) : m_motions(motions) {}

    bool process(const btBroadphaseProxy* proxy) override
    {
        const btCollisionObject* object = static_cast<const btCollisionObject*>(proxy->m_clientObject);
        if (!object || !object->getCollisionShape()) return true;
        const int type = object->getCollisionShape()->getShapeType();
        if (isMeshShape(type)) m_beyond = std::max(m_beyond, marginBeyondBounds(*object->getCollisionShape()));
        bool moves = false;
        if (object->isKinematicObject() && (isMeshShape(type) || type == COMPOUND_SHAPE_PROXYTYPE))
        {
            const BodyMotion motion = m_motions.observe(*object);
            moves = motion.moves();
            if (moves) m_found.m_objects.push_back(MovingObject{object, motion});
        }
        if (isMeshShape(type) && !moves && object->isStaticOrKinematicObject()) addChanging(*proxy, *object);
        return true;
    }

    MovingThings m_found;
    btScalar m_beyond = 0;  // m

private:
    // The broad phase still has the box of the step before.
    void addChanging(const btBroadphaseProxy& proxy, const btCollisionObject& object)
    {
        ChangingMesh mesh;
        mesh.m_object = &object;
        object.getCollisionShape()->getAabb(object.getWorldTransform(), mesh.m_low, mesh.m_high);
        const btVector3 extent = mesh.m_high - mesh.m_low;
        const btScalar size = std::max(extent.x(), std::max(extent.y(), extent.z()));
        // Bullet grows it by the breaking threshold, but for the one that it has of an object that was just added.
        mesh.m_change = std::min(changeOf(mesh, proxy, 0), changeOf(mesh, proxy, gContactBreakingThreshold));
        if (mesh.m_change > kLeastChange * size && mesh.m_change <= size) m_found.m_meshes.push_back(mesh);
    }
    static btScalar changeOf(const ChangingMesh& mesh, const btBroadphaseProxy& proxy, btScalar grown)
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
};

// Returns whether the mesh may come near the box within this step and the next, if it goes on changing as fast.
bool comesNear(const ChangingMesh& mesh, const Extent& extent, btScalar reach)
{
    const btScalar margin = reach + 2 * mesh.m_change;
    const btVector3 grown(margin, margin, margin);
    return TestAabbAgainstAabb2(extent.m_low - grown, extent.m_high + grown, mesh.m_low, mesh.m_high);
}
}  // namespace

MovingThings movingThings(const btSoftBody& body, KinematicMotions& motions, btScalar& beyond)
{
    CollectMoving collect(motions);
    btBroadphaseInterface* broadphase = body.m_worldInfo ? body.m_worldInfo->m_broadphase : nullptr;
    const btVector3 far(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
    if (broadphase) broadphase->aabbTest(-far, far, collect);
    beyond = std::max(beyond, collect.m_beyond);
    return collect.m_found;
}

bool isReached(const PluginState& state, const btSoftBody& body, const MovingThings& moving)
{
    if (moving.empty()) return false;
    Way rest(body);
    rest.m_start = rest.m_end;  // the last step that it was awake in is over
    if (rest.m_end.empty()) return false;
    for (const MovingObject& object : moving.m_objects)
    {
        if (!mayTouch(state, body, *object.m_object)) continue;
        if (Sight(body, rest, object, btScalar(state.settings().m_activation)).comesNear()) return true;
    }
    const btScalar reach = reachOf(body, btScalar(state.settings().m_activation));
    for (const ChangingMesh& mesh : moving.m_meshes)
        if (comesNear(mesh, rest.m_end, reach) && mayTouch(state, body, *mesh.m_object)) return true;
    return false;
}

void coverMotion(btSoftBody& body, btScalar activation, btScalar extra, const MovingThings& moving)
{
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
    widen(body, path, reachOf(body, activation) + extra);
    for (const MovingObject& object : moving.m_objects)
    {
        const Sight sight(body, way, object, activation);
        if (sight.comesNear()) widen(body, sight.m_seen, sight.m_reach + extra);
    }
    for (const ChangingMesh& mesh : moving.m_meshes)
    {
        if (!comesNear(mesh, path, reachOf(body, activation))) continue;
        btVector3 nearest = (path.m_low + path.m_high) / 2;
        nearest.setMax(mesh.m_low);
        nearest.setMin(mesh.m_high);
        Extent there;
        there.add(nearest);
        widen(body, there, 0);
    }
}
}  // namespace drape
