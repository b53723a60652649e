#include "bullet_plugin/adapter/motion/prediction.h"

#include <cmath>
#include <cstddef>
#include <mutex>

#include "BulletCollision/BroadphaseCollision/btBroadphaseInterface.h"
#include "bullet_plugin/adapter/solver/body_jobs.h"

namespace drape
{
namespace
{
struct Bounds
{
    btVector3 m_low = btVector3(SIMD_INFINITY, SIMD_INFINITY, SIMD_INFINITY), m_high = -m_low;

    // Ignores coordinates that are not a number.
    void add(const Bounds& other)
    {
        for (int axis = 0; axis < 3; ++axis)
        {
            if (other.m_low[axis] < m_low[axis]) m_low[axis] = other.m_low[axis];
            if (other.m_high[axis] > m_high[axis]) m_high[axis] = other.m_high[axis];
        }
    }
};

// The values of a step that all nodes of a body share.
struct NodeStep
{
    explicit NodeStep(const btSoftBody& body)
        : m_dt(body.m_sst.sdt),
          m_gravity(body.m_worldInfo->m_gravity * m_dt),
          m_mostChange(body.m_worldInfo->m_maxDisplacement / m_dt)
    {
    }

    void predict(btSoftBody::Node& node) const
    {
        if (node.m_im > 0) node.m_v += m_gravity;
        node.m_q = node.m_x;
        btVector3 change = node.m_f * node.m_im * m_dt;
        for (int axis = 0; axis < 3; ++axis)
        {
            if (change[axis] > m_mostChange) change[axis] = m_mostChange;
            if (change[axis] < -m_mostChange) change[axis] = -m_mostChange;
        }
        node.m_v += change;
        node.m_x += node.m_v * m_dt;
        node.m_f = btVector3(0, 0, 0);
    }

    btScalar m_dt;
    btVector3 m_gravity;
    btScalar m_mostChange;
};

void setBounds(btSoftBody& body, const Bounds& bounds)
{
    body.m_bounds[0] = body.m_bounds[1] = btVector3(0, 0, 0);
    if (body.m_nodes.size() == 0) return;
    const btScalar margin = body.getCollisionShape()->getMargin();
    const btVector3& first = body.m_nodes[0].m_x;
    for (int axis = 0; axis < 3; ++axis)
    {
        // Bullet compares with the first node: bounds are no number where it is none.
        const bool isNumber = first[axis] == first[axis];
        body.m_bounds[0][axis] = (isNumber ? bounds.m_low[axis] : first[axis]) - margin;
        body.m_bounds[1][axis] = (isNumber ? bounds.m_high[axis] : first[axis]) + margin;
    }
}
}  // namespace

const char* reasonForBulletsPrediction(const btSoftBody& body)
{
    const btSoftBody::Config& config = body.m_cfg;
    if (config.kLF > 0 || config.kDG > 0) return "the soft body is in wind (kLF, kDG)";
    if (config.kPR != 0) return "the soft body has pressure (kPR)";
    if (config.kVC > 0) return "the soft body conserves its volume (kVC)";
    // Bullet finds contacts of two such bodies as far as the volumes of their leaves reach.
    if (config.collisions & (btSoftBody::fCollision::VF_SS | btSoftBody::fCollision::VF_DD))
        return "the soft body collides with soft bodies (VF_SS or VF_DD)";
    if (body.m_pose.m_bframe) return "the soft body has a pose (setPose)";
    if (body.m_clusters.size() > 0) return "the soft body has clusters";
    if (!body.m_fdbvt.empty()) return "the soft body has a tree of faces, as rays make it";
    if (body.m_reducedModel) return "the soft body is a reduced deformable model";
    return body.m_worldInfo ? nullptr : "the soft body belongs to no world (m_worldInfo)";
}

bool isPlain(const btSoftBody& body)
{
    return !reasonForBulletsPrediction(body);
}

bool isPlain(const btSoftBody& body, btScalar dt)
{
    return dt > 0 && body.m_cfg.timescale > 0 && !body.m_bUpdateRtCst && isPlain(body);
}

void beginPlain(btSoftBody& body, btScalar dt)
{
    body.m_sst.sdt = dt * body.m_cfg.timescale;
    body.m_sst.isdt = 1 / body.m_sst.sdt;
    body.m_sst.velmrg = body.m_sst.sdt * 3;
    body.m_sst.radmrg = body.getCollisionShape()->getMargin();
    body.m_sst.updmrg = body.m_sst.radmrg * btScalar(0.25);
}

void setBounds(btSoftBody& body, const btVector3& low, const btVector3& high)
{
    const btScalar margin = body.getCollisionShape()->getMargin();
    body.m_bounds[0] = low - btVector3(margin, margin, margin);
    body.m_bounds[1] = high + btVector3(margin, margin, margin);
}

void predictPlain(btSoftBody& body, btScalar dt, ThreadTeam* threads)
{
    beginPlain(body, dt);
    const NodeStep step(body);
    std::mutex mutex;
    Bounds all;
    const auto predict = [&](std::size_t first, std::size_t last)
    {
        Bounds bounds;
        for (std::size_t i = first; i < last; ++i)
        {
            btSoftBody::Node& node = body.m_nodes[static_cast<int>(i)];
            step.predict(node);
            bounds.add({node.m_x, node.m_x});
        }
        const std::lock_guard<std::mutex> lock(mutex);
        all.add(bounds);
    };
    forRanges(static_cast<std::size_t>(body.m_nodes.size()), threads, predict);
    setBounds(body, all);
    body.m_rcontacts.resizeNoInitialize(0);
    body.m_scontacts.resizeNoInitialize(0);
}

void updateBroadphase(btSoftBody& body)
{
    if (body.m_nodes.size() == 0 || !body.getBroadphaseHandle()) return;
    body.m_worldInfo->m_broadphase->setAabb(body.getBroadphaseHandle(), body.m_bounds[0], body.m_bounds[1],
                                            body.m_worldInfo->m_dispatcher);
}
}  // namespace drape
