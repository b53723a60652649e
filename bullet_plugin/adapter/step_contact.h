// One contact, resolved: what contact rounds and cuts work with.
//
// Lengths in metres, world frame. Gaps have the thickness subtracted: 0 is the resting distance, negative is too close.
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
    btScalar m_time;                   // of impact, 0 to 1; 1 when nothing was passed
    btScalar m_startGap;               // at m_q, as the obstacle sees it
    btScalar m_endGap;                 // at the predicted m_x
    btScalar m_targetGap;              // not to fall below at the step's end: 0, or less when the step began too close
    btScalar m_friction;               // the obstacle's friction times the body's kDF
    const btTransform* m_carry;        // what the obstacle's motion in the step does to its points; null when it rests
    const btVector3* m_carriedStarts;  // by node of the body, where an obstacle that deforms carries the places at
                                       // which nodes start; null where m_carry says so
};

// Where the obstacle's motion carries a point at the step's start.
inline btVector3 carried(const btTransform* carry, const btVector3& point)
{
    return carry ? *carry * point : point;
}

// Returns where the obstacle's motion carries the place at which a node starts.
inline btVector3 carriedStart(const btTransform* carry, const btVector3* carriedStarts, int node,
                              const btVector3& start)
{
    return carriedStarts ? carriedStarts[node] : carried(carry, start);
}

// A node that contacts may move: it has mass and no rigid body holds it.
inline btScalar movableInverseMass(const btSoftBody::Node& node)
{
    return node.m_battach ? btScalar(0) : node.m_im;
}

// Least share of the thickness that a step recovers of a depth that it began with. Only positions recover, no speed is
// left behind; a tenth brings cloth that moved along a curved obstacle, and so came a little too near, back at once.
constexpr btScalar kRecoveredShare = btScalar(0.1);

// Gap that a step is not to end below. One that began too close recovers the share kKHR (Bullet's kinetic contact
// hardness) of its depth, or the share above of the thickness if that is more, so that cloth which starts inside is not
// thrown out.
inline btScalar targetGap(btScalar startGap, btScalar hardness, btScalar thickness)
{
    const btScalar recovered = btMax(startGap + kRecoveredShare * thickness, startGap * (1 - hardness));
    return btMin(btScalar(0), recovered);
}
}  // namespace drape
