// One resolved contact, the input of contact sweeps and cuts. Lengths in metres, world frame. Gaps have the thickness
// subtracted: 0 is the resting distance, negative is too close.
#pragma once

#include "BulletSoftBody/btSoftBody.h"

namespace drape
{
struct StepContact
{
    int m_nodes[3];         // -1 where unused
    btScalar m_weights[3];  // sum 1
    btVector3 m_normal;     // unit, from the obstacle to the cloth
    btVector3 m_point;      // on the obstacle
    btScalar m_thickness;
    btScalar m_time;                   // time of impact, 0 to 1; 1 if nothing was passed
    btScalar m_startGap;               // at m_q, relative to the obstacle
    btScalar m_endGap;                 // at the predicted m_x
    btScalar m_targetGap;              // least gap at the step's end: 0, or less when the step began too close
    btScalar m_friction;               // the obstacle's friction times the body's kDF
    const btTransform* m_carry;        // motion of the obstacle's points in the step; null when it rests
    const btVector3* m_carriedStarts;  // by node of the body: start positions carried by a deforming obstacle;
                                       // null if m_carry applies
};

// Returns where the obstacle's motion carries a point from the step's start.
inline btVector3 carried(const btTransform* carry, const btVector3& point)
{
    return carry ? *carry * point : point;
}

// Returns where the obstacle's motion carries a node's start position.
inline btVector3 carriedStart(const btTransform* carry, const btVector3* carriedStarts, int node,
                              const btVector3& start)
{
    return carriedStarts ? carriedStarts[node] : carried(carry, start);
}

// Returns the inverse mass; 0 for a node that contacts may not move: one without mass or anchored to a rigid body.
inline btScalar movableInverseMass(const btSoftBody::Node& node)
{
    return node.m_battach ? btScalar(0) : node.m_im;
}

// Minimum share of the thickness that a step recovers of an initial depth. Only positions recover; no speed remains.
// A tenth quickly corrects cloth that came a little too near while it moved along a curved obstacle.
constexpr btScalar kRecoveredShare = btScalar(0.1);

// Returns the least gap at the step's end. A step that began too close recovers the share kKHR (Bullet's kinetic
// contact hardness) of its depth, or kRecoveredShare of the thickness if that is more. Cloth that starts inside is
// therefore not thrown out.
inline btScalar targetGap(btScalar startGap, btScalar hardness, btScalar thickness)
{
    const btScalar recovered = btMax(startGap + kRecoveredShare * thickness, startGap * (1 - hardness));
    return btMin(btScalar(0), recovered);
}
}  // namespace drape
