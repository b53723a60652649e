// One body of a step with pairs: what the solver takes of it, and what Bullet's side needs beside that. Metres, world
// frame.
#pragma once

#include <unordered_map>
#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_plugin/core/solver/cloth_contacts.h"

namespace drape
{
// Largest speed after a step, m/s relative to the cloth as a whole, of a node whose cloth was tangled shortly before.
// Keeps links that were stretched meanwhile from throwing the node.
constexpr btScalar kMostTangledSpeed = 3;

// The marked nodes of a pair that began its step intersecting. A contact that would keep a marked node on the wrong
// side must not act.
struct TangledPair
{
    MeshId m_obstacle;
    std::vector<unsigned char> m_wrongSide;  // by node
    std::vector<unsigned char> m_meets;      // by node: belongs to a face that meets the obstacle

    bool contains(const int nodes[3]) const
    {
        bool allMeet = nodes[1] >= 0;
        for (int k = 0; k < 3 && nodes[k] >= 0; ++k)
        {
            if (m_wrongSide[static_cast<std::size_t>(nodes[k])]) return false;
            allMeet = allMeet && m_meets[static_cast<std::size_t>(nodes[k])];
        }
        return !allMeet;
    }
};

// A displacement for a node on the wrong side of an obstacle, or for a node of a face on the wrong side.
struct NodePush
{
    int m_node;
    btVector3 m_normal;   // unit, direction of the push
    btScalar m_distance;  // m, to move along the normal in this step
    Carry m_carry;
    btScalar m_speedLimit;  // m/s along the normal after the push
};

// A dynamic body of an obstacle, which may yield.
struct DynamicBody
{
    btRigidBody* m_object;
    btVector3 m_velocity;  // m/s, before Bullet's step
    btVector3 m_place;     // m, its origin then
};

// A contact with the mesh of one.
struct DynamicContact
{
    const Contact* m_contact;  // the pipeline's, until its next submit
    DynamicBody m_body;
};

// The end of a node's path, and its velocity there.
struct PathEnd
{
    btVector3 m_position, m_velocity;  // m, m/s
};

struct BodyContacts
{
    MeshId m_cloth = kNoMesh;
    btSoftBody* m_body = nullptr;
    ClothContacts m_contacts;
    bool m_leftOut = false;              // the body collides with nothing in this step
    bool m_heldTogether = false;         // since the last detection, see stretch.h
    bool m_obstacleJumps = false;        // an obstacle moves farther in the step than its size, or turns far
    bool m_hasDeformedPair = false;      // an obstacle's vertices move in the step
    bool m_isStopped = false;            // by the last checkOffPath()
    bool m_hasDynamicPair = false;       // an obstacle is a dynamic body, which the cloth pushes
    bool m_isOnDevice = false;           // see kept_bodies.h
    bool m_meetsSurface = false;         // the host must solve it: a path meets a surface, or the like
    bool m_isOffPath = false;            // the solver left its path so far that it may have passed a surface
    std::vector<TangledPair> m_tangled;  // the body's pairs that are pushed apart
    bool m_wasTangled = false;           // in this step or one shortly before
    std::vector<NodePush> m_pushes;
    std::vector<Contact> m_pushContacts;            // one per push
    std::vector<DynamicContact> m_dynamicContacts;  // not among m_contacts
    std::unordered_map<int, PathEnd> m_wholePaths;  // by node: ends of paths that dynamic obstacles alone cut

    SolverNodes& nodes() { return m_contacts.m_nodes; }
    const SolverNodes& nodes() const { return m_contacts.m_nodes; }
    // Speed that a node loses per metre of its path that is taken away, 1/s, as in Bullet's own update.
    float perSecond() const { return m_contacts.m_perSecond * m_contacts.m_undamped; }

    // Resets the record for a body of another step. Memory is kept.
    void start(MeshId cloth, btSoftBody* body, const ClothParts& parts, const FeatureOrder& order)
    {
        m_cloth = cloth;
        m_body = body;
        m_contacts.start(cloth, parts, &order);
        m_contacts.m_friction = float(body->m_cfg.kDF);
        m_contacts.m_hardness = float(body->m_cfg.kKHR);
        m_contacts.m_perSecond = float(body->m_sst.isdt);
        m_contacts.m_undamped = float(1 - body->m_cfg.kDP);
        m_leftOut = m_heldTogether = m_obstacleJumps = m_hasDeformedPair = m_hasDynamicPair = m_isStopped = false;
        m_isOnDevice = m_meetsSurface = m_isOffPath = false;
        m_tangled.clear();
        m_wasTangled = false;
        m_pushes.clear();
        m_pushContacts.clear();
        m_dynamicContacts.clear();
        m_wholePaths.clear();
    }
};
}  // namespace drape
