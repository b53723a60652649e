// The soft bodies that collide with themselves and with each other (Plugin::setSelfCollision()).
//
// Bodies are compared by address and followed only while a step has them.
#pragma once

#include <unordered_map>
#include <vector>

#include "BulletSoftBody/btSoftBody.h"

namespace drape
{
struct SelfColliding
{
    btScalar m_thickness;       // m; 0: twice the body's margin
    std::vector<float> m_rest;  // x y z per node, m, where the nodes were when it was switched on
};

class SelfCollision
{
public:
    void set(const btSoftBody& body, btScalar thickness);
    void clear(const btSoftBody& body) { m_bodies.erase(&body); }
    bool any() const { return !m_bodies.empty(); }
    // Returns null if the body does not collide with itself. Takes new positions at rest if it got other nodes.
    const SelfColliding* find(const btSoftBody& body);
    // Returns the thickness at which the body collides with itself, m.
    static btScalar thicknessOf(const btSoftBody& body, const SelfColliding& self);

private:
    std::unordered_map<const btSoftBody*, SelfColliding> m_bodies;
};
}  // namespace drape
