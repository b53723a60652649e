// Bodies that leave each other no room in a step. They end it where they started it, and share their momentum: they
// move on together, as after a perfectly inelastic impact.
//
// Metres, world frame. Cost: linear in the nodes.
#pragma once

#include <functional>
#include <vector>

#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "BulletSoftBody/btSoftBody.h"

namespace drape
{
class HeldGroup
{
public:
    // Returns where a node started the step.
    using StartOf = std::function<btVector3(std::size_t)>;

    // A body that is there already is not added again.
    void add(btSoftBody& body, StartOf startOf);
    // start: the body's pose at the step's start. One that is kept from moving along an axis
    // makes all come to rest; with one that is kept from turning none turns.
    void add(btRigidBody& body, const btTransform& start);
    // Makes all come to rest: something that nothing moves is among them. Held nodes have the same effect.
    void rest() { m_rests = true; }
    // Puts all free nodes and rigid bodies back, and gives them the velocities.
    void hold() const;

private:
    struct Cloth
    {
        btSoftBody* m_body;
        StartOf m_startOf;
    };
    struct Rigid
    {
        btRigidBody* m_body;
        btTransform m_start;
    };

    bool hasHeldNode() const;

    std::vector<Cloth> m_cloths;
    std::vector<Rigid> m_rigid;
    bool m_rests = false, m_turns = true;
};
}  // namespace drape
