// One contact as the adapter works with it between detection and the end of the closing pass.
//
// Lengths in metres, world frame. Gaps have the thickness subtracted: 0 is the resting distance, negative is too close.
// Node pointers are those of the current step; nothing here outlives SoftBodySolver::solveConstraints except for
// debugging.
#pragma once

#include <cstdint>

#include "BulletSoftBody/btSoftBody.h"

namespace drape
{
struct StepContact
{
    const btCollisionObject* m_object;
    std::uint32_t m_kind;   // DRAPE_NODE_FACE …
    int m_nodes[3];         // -1 where unused
    int m_face;             // a face of the body that holds the feature
    btScalar m_weights[3];  // sum 1
    btVector3 m_normal;     // unit, from the obstacle to the cloth
    btVector3 m_point;      // on the obstacle
    btScalar m_thickness;
    btScalar m_startGap;         // at m_q
    btScalar m_endGap;           // at the predicted m_x
    btScalar m_targetGap;        // not to fall below at the step's end: 0, or less when the step began too close
    btScalar m_friction;         // the obstacle's friction times the body's kDF
    btScalar m_speedBefore = 0;  // m/s along the normal before the closing pass
    btScalar m_pushed = 0;       // multiplier spent by the closing pass; 0 when it left the contact alone

    bool violated() const { return m_endGap < 0; }
};

// A node that contacts may move: it has mass and no rigid body holds it.
inline btScalar movableInverseMass(const btSoftBody::Node& node)
{
    return node.m_battach ? btScalar(0) : node.m_im;
}

// Gap that Bullet's solver restores when a step began at startGap: a step that began too close recovers the share kKHR
// (Bullet's kinetic contact hardness) of the depth, so that cloth which starts inside is not thrown out.
inline btScalar solverTarget(btScalar startGap, btScalar hardness)
{
    return startGap >= 0 ? btScalar(0) : startGap * (1 - hardness);
}

// Share of the thickness that the closing pass recovers in one step at least. It moves positions only and leaves no
// speed behind; a tenth brings cloth that moved along a curved obstacle, and so came a little too near, back at once.
constexpr btScalar kRecoveredShare = btScalar(0.1);

// Gap that the closing pass does not let a step fall below.
inline btScalar closingTarget(btScalar startGap, btScalar hardness, btScalar thickness)
{
    const btScalar recovered = startGap + kRecoveredShare * thickness;
    const btScalar solver = solverTarget(startGap, hardness);
    return recovered < solver ? solver : recovered < 0 ? recovered : btScalar(0);
}
}  // namespace drape
