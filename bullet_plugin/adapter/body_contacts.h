// One body's contacts of a step, by cloth feature, as detection gave them. Most never act in a step, so a contact is
// resolved only when it is needed (found_contacts.h). Metres, world frame.
#pragma once

#include <cstdint>
#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_plugin/adapter/cloth_parts.h"
#include "bullet_plugin/adapter/motion_limit.h"
#include "bullet_plugin/adapter/substep_body.h"
#include "bullet_plugin/core/pipeline/pipeline.h"

namespace drape
{
// The contacts of one node, face or edge of a cloth.
struct FeatureContacts
{
    const Contact* m_contacts;  // the pipeline's, until its next submit
    std::uint32_t m_count;
    int m_nodes[3];     // indices of the body's nodes; -1 where unused
    float m_leastTime;  // earliest time of impact; 1 when nothing was passed
};

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

    bool holds(const int nodes[3]) const
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
    btVector3 m_normal;          // unit, direction of the push
    btScalar m_distance;         // m, to move along the normal in this step
    const btTransform* m_carry;  // see StepContact
    const btVector3* m_carriedStarts;
    btScalar m_speedLimit;  // m/s along the normal after the push
};

struct BodyContacts
{
    MeshId m_cloth = kNoMesh;
    btSoftBody* m_body = nullptr;
    const ClothParts* m_parts = nullptr;                             // owned by the cloth's mirror
    btScalar m_leastThickness = SIMD_INFINITY, m_mostThickness = 0;  // over the body's pairs
    std::vector<FeatureContacts> m_features;                         // in canonical order
    MotionLimit m_limit;
    SubstepBody* m_substeps = nullptr;   // solves the body's links; null where Bullet does
    bool m_leftOut = false;              // the body collides with nothing in this step
    bool m_heldTogether = false;         // since the last detection, see stretch.h
    bool m_obstacleJumps = false;        // an obstacle moves farther in the step than its size, or turns far
    bool m_mayHavePassed = false;        // a contact is left so near that a surface may have been passed
    std::vector<TangledPair> m_tangled;  // the body's pairs that are pushed apart
    bool m_wasTangled = false;           // in this step or one shortly before
    std::vector<NodePush> m_pushes;
    std::vector<Contact> m_pushContacts;  // one per push

    // Resets the record for a body of another step. Memory is kept.
    void start(MeshId cloth, btSoftBody* body, const ClothParts& parts)
    {
        m_cloth = cloth;
        m_body = body;
        m_parts = &parts;
        m_leastThickness = SIMD_INFINITY;
        m_mostThickness = 0;
        m_features.clear();
        m_limit.clear();
        m_substeps = nullptr;
        m_leftOut = m_heldTogether = m_obstacleJumps = false;
        m_mayHavePassed = false;
        m_tangled.clear();
        m_wasTangled = false;
        m_pushes.clear();
        m_pushContacts.clear();
    }
};
}  // namespace drape
