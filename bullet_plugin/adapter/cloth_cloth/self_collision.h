// The soft bodies that collide with themselves and with each other: those of Plugin::setSelfCollision(), and those
// whose flags of Bullet's ask for it.
//
// Bodies are compared by address and followed only while a step has them. With Solver::Bullet the flags are Bullet's.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "BulletSoftBody/btSoftBody.h"

namespace drape
{
struct SelfColliding
{
    btScalar m_thickness = 0;   // m; 0 or less: twice the body's margin
    bool m_isAsked = false;     // by the app's call
    bool m_meetsItself = true;  // it collides with itself
    bool m_meetsOthers = true;  // it collides with other bodies for which this is true
    int m_proxy = 0;            // identifies the body in its world; another one may get its address
    int m_revision = 0;         // another one, of all bodies, when m_rest changes
    std::vector<float> m_rest;  // x y z per node, m, where the nodes were when it was switched on
    // The nodes' positions after a step of that solver, x y z per node, m; empty if the body was put elsewhere since.
    std::vector<float> m_ends;
    const void* m_solver = nullptr;  // compared, never followed
    std::uint64_t m_step = 0;        // the solver's number of the step
    std::uint64_t m_filters = 0;     // a hash of filterHash() and the flags above in that step
};

class SelfCollision
{
public:
    // heedsFlags: of Bullet's.
    explicit SelfCollision(bool heedsFlags) : m_heedsFlags(heedsFlags) {}

    void set(const btSoftBody& body, btScalar thickness);
    void clear(const btSoftBody& body) { m_bodies.erase(&body); }
    // Forgets where the body was after the last step, if it is one of these.
    void startAnew(const btCollisionObject& object);
    // Returns whether find() returns anything.
    bool has(const btSoftBody& body) const { return isAsked(body) || asksItself(body) || asksOthers(body); }
    // Returns null if the body collides neither with itself nor with others. Takes new positions at rest if it got
    // other nodes.
    SelfColliding* find(const btSoftBody& body);
    // Returns whether Drape takes the place of Bullet's own algorithm between two bodies that a solver steps.
    bool takes(const btSoftBody& body, const btSoftBody& other);
    // Returns the thickness at which the body collides with itself, m; at least kMinThickness.
    static btScalar thicknessOf(const btSoftBody& body, const SelfColliding& self);

private:
    bool isAsked(const btSoftBody& body) const;
    // Return whether flags of Bullet's ask for it: with itself, and with others.
    bool asksItself(const btSoftBody& body) const;
    bool asksOthers(const btSoftBody& body) const;

    bool m_heedsFlags;
    int m_lastRevision = 0;
    std::unordered_map<const btSoftBody*, SelfColliding> m_bodies;
};
}  // namespace drape
