// Contacts of a cloth with rigid bodies, and anchors to them: two-way, since the bodies may yield.
//
// Contacts are of nodes, which the caller found, or of nodes, faces and edges beside the meshes of dynamic bodies.
// Within a step a body stands where the step ends, and its velocity tells where it came from. What the cloth pushes
// changes the body's velocity, and with it how far the body's points come in the rest of the step. A dynamic body with
// a mesh ends the step there; it gains speed evenly over the step as the cloth does, or else the two would push each
// other to and fro. Rows are projected in their order, on one thread (kernels/lib/solver/rigid_row.h). World frame, SI
// units.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/lib/solver/rigid_row.h"
#include "solver_nodes.h"

namespace drape
{
class Substeps;

// A node, face or edge beside a plane of a body.
struct RigidFeature
{
    std::uint32_t m_count;  // number of nodes, up to 3
    std::uint32_t m_nodes[3];
    float m_weights[3];   // weights of the contact's point, sum 1
    bool m_isBlocked[3];  // the node cannot give way, since what holds it does not yield
    float m_advance[3];   // m, how far what holds a blocked node moves it against the normal in the step at most
    std::uint32_t m_body;
    Vec3 m_arm;  // m, from the body's centre of mass to the contact
    RigidPlane m_plane;
    float m_reach;  // m, distance from the plane within which the feature may meet it in a substep's sweeps
};

class RigidRows
{
public:
    bool empty() const { return m_contacts.empty() && m_anchors.empty() && m_features.empty(); }
    void clear();
    // bodies: of all cloths; they must stay in place until the last substep. Call before add().
    void setBodies(std::vector<RigidBody>& bodies) { m_bodies = &bodies; }
    void add(const RigidContact& contact);
    void add(const RigidAnchor& anchor);
    // bodyTime: s, of the bodies' step. The cloth's may be another one (timescale).
    void add(const RigidFeature& feature, float bodyTime);

    const std::vector<RigidBody>& bodies() const { return *m_bodies; }
    const std::vector<RigidContact>& contacts() const { return m_contacts; }
    const std::vector<RigidAnchor>& anchors() const { return m_anchors; }
    // Return what the i-th contact of nodes, or of features, has given the cloth since clear(), N s; friction included.
    // Only substeps of the host count.
    Vec3 contactImpulse(std::size_t i) const { return m_contactImpulses[i]; }
    Vec3 featureImpulse(std::size_t i) const { return m_features[i].m_impulse; }
    // The cloth's position in the order in which a sweep visits cloths.
    void setTurn(std::size_t turn) { m_turn = turn; }
    std::size_t turn() const { return m_turn; }
    // Returns whether all bodies of the rows yield.
    bool bodiesYield() const;
    // Returns the number of rows with bodies that move.
    std::size_t movingRows() const;

    // Begins a substep.
    void begin(SolverNodes& nodes, const Substeps& substeps, int substep);
    // Projects every row of nodes once.
    void project();
    // Projects the rows of features that are near their planes once. relaxation: share of a violation that is
    // corrected.
    void projectFeatures(float relaxation);
    // Ends a substep: the bodies' points have gone on with the bodies' velocities.
    void end();
    // Ends the step: takes from velocities what features gained by recovering a depth that the step began with.
    void limitSpeeds();

    // Returns the impulses of bodies that move by these rows since clear(), about the first body's centre of mass.
    const RigidGiven& given() const { return m_given; }
    // Takes over what rows on a device gave, and the bodies of their moving rows. bodies: as bodies() lists them.
    void takeOver(const RigidGiven& given, const RigidBody* bodies);

private:
    struct FeatureRow
    {
        RigidFeature m_feature;
        bool m_isBlocked;     // a node is
        float m_inverseMass;  // 1/kg, of the nodes at the contact's point that give way
        float m_wholeMass;    // 1/kg, of all its nodes
        float m_pushed;       // N s, along the normal in the step
        Vec3 m_impulse;       // N s, given to the cloth in the step
        RigidRowState m_state;
        RigidRowState m_surplus;  // pushes against what blocked nodes moved by themselves
    };

    void refer(std::uint32_t body);
    Vec3 lagOf(std::uint32_t body) const;
    Vec3 displacementOf(const FeatureRow& row) const;
    float surplusOf(const FeatureRow& row) const;
    float inverseMassOf(const RigidFeature& feature, std::uint32_t k) const;
    float bodyMobility(const RigidFeature& feature) const;
    float mobilityOf(const FeatureRow& row) const { return row.m_inverseMass + bodyMobility(row.m_feature); }
    void push(const RigidFeature& feature, Vec3 by, bool movesBlocked);
    void pushSurplus(FeatureRow& row, float relaxation);

    std::vector<RigidBody>* m_bodies = nullptr;
    std::size_t m_turn = 0;
    std::vector<RigidContact> m_contacts;
    std::vector<RigidAnchor> m_anchors;
    std::vector<RigidRowState> m_contactStates, m_anchorStates;
    std::vector<FeatureRow> m_features;
    std::vector<Vec3> m_contactImpulses;  // N s, by contact
    std::vector<std::uint32_t> m_near;    // features that take part in the substep's sweeps
    SolverNodes* m_nodes = nullptr;       // in a step
    float m_stepTime = 0;                 // s
    RigidGiven m_given = {};
    RigidSubstep m_substep = {};      // for anchors and contacts of nodes
    RigidSubstep m_featureStep = {};  // for features, in the bodies' time
    float m_bodyTime = 0;             // s
};
}  // namespace drape
