// Gauss-Seidel rounds over the contacts of one body, on positions.
//
// Input: a body between predictMotion and the end of solveConstraints, and its contacts in canonical order. Each round
// projects every contact once: C = n.(sum w_i x_i - p) - thickness - target >= 0, weighted by inverse mass (Müller et
// al. 2007, Position Based Dynamics, section 3.3). Within a stage, from restart() to the next, a contact remembers how
// far it has pushed and takes back what others have made needless, so that the rounds tend to the smallest correction;
// pushes that are never taken back lift a node by more than its contacts ask for, and it falls back a step later, for
// ever. Nodes come before faces and edges in canonical order: most faces and edges are free once their nodes are.
// Friction holds the motion since the step's start along the surface, relative to the obstacle's, up to Coulomb's bound
// on the push (Macklin et al. 2014, Unified Particle Physics, section 6.1), with Bullet's coefficient, kDF times the
// obstacle's friction. Velocities follow the positions as in Bullet's own update, (x change)/dt (1 - kDP);
// limitSpeeds() takes out again what a contact gained by recovering a depth that the step began with. So no energy
// comes from the rounds. Pinned, massless and anchored nodes stay. Cost: linear in the contacts.
#pragma once

#include <vector>

#include "bullet_plugin/adapter/step_contact.h"

namespace drape
{
class ContactRounds
{
public:
    ContactRounds(btSoftBody& body, const std::vector<StepContact>& contacts);

    // Begins a stage: nothing is pushed yet.
    void restart();
    // One round over all contacts. Returns the worst violation met, m.
    btScalar run() { return runRows(m_rows.size()); }
    // The same over the contacts of nodes alone, which hold exactly afterwards but for nodes with several.
    void runNodes() { runRows(m_nodeRows); }
    // Once, after the last round.
    void limitSpeeds();

    bool empty() const { return m_rows.empty(); }
    btScalar leastThickness() const { return m_leastThickness; }

private:
    // A node that rows refer to, copied together: Bullet's nodes are far apart.
    struct Moved
    {
        btVector3 m_x, m_start;
        btScalar m_inverseMass;
        int m_node;
    };
    struct Row
    {
        int m_moved[3];
        int m_count;
        btScalar m_weights[3];
        btScalar m_mobility;  // what a unit multiplier moves the weighted point
        btVector3 m_normal;
        btScalar m_level;  // n.(sum w x) at the target
        btScalar m_friction;
        btScalar m_multiplier;  // pushed in this stage
        btVector3 m_held;       // by friction, in this stage, in units of the multiplier
        btVector3 m_carried;    // m, what the obstacle's motion in the step does to the contact's start
        btScalar m_speedLimit;  // m/s outwards when it pushed
        bool m_pushed;          // in any stage
    };

    void addRow(const StepContact& contact, std::vector<int>& movedOfNode);
    btVector3 carriedBy(const Row& row, const btTransform* carry) const;
    btScalar runRows(std::size_t count);
    btScalar project(Row& row);
    void holdBack(Row& row);
    btVector3 pointOf(const Row& row) const;
    void shift(const Row& row, const btVector3& impulse);
    void limitSpeed(const Row& row);

    btSoftBody& m_body;
    std::vector<Moved> m_moved;
    std::vector<Row> m_rows;
    std::size_t m_nodeRows = 0;
    btScalar m_leastThickness = SIMD_INFINITY;
};
}  // namespace drape
