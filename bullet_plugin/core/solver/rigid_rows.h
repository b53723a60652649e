// Contacts of a cloth's nodes with rigid bodies that the caller found, and anchors to rigid bodies: two-way, since the
// bodies may yield.
//
// Within a step a body stands where the step ends, and its velocity tells where it came from. What the cloth pushes
// changes the body's velocity, and with it how far the body's points come in the rest of the step. Rows are projected
// in their order, on one thread (kernels/lib/solver/rigid_row.h). World frame, SI units.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/lib/solver/rigid_row.h"
#include "solver_nodes.h"

namespace drape
{
class RigidRows
{
public:
    bool empty() const { return m_contacts.empty() && m_anchors.empty(); }
    void clear();
    // bodies: of all cloths; they must stay in place until the last substep. Call before add().
    void setBodies(std::vector<RigidBody>& bodies) { m_bodies = &bodies; }
    void add(const RigidContact& contact);
    void add(const RigidAnchor& anchor);

    const std::vector<RigidBody>& bodies() const { return *m_bodies; }
    const std::vector<RigidContact>& contacts() const { return m_contacts; }
    const std::vector<RigidAnchor>& anchors() const { return m_anchors; }
    // The cloth's position in the order in which a sweep visits cloths.
    void setTurn(std::size_t turn) { m_turn = turn; }
    std::size_t turn() const { return m_turn; }
    // Returns whether all bodies of the rows yield.
    bool bodiesYield() const;
    // Returns the number of rows with bodies that move.
    std::size_t movingRows() const;

    // Begins a substep of `time` seconds that ends when the share `passed` of the step has passed. correctionTime: s,
    // see Substeps.
    void begin(SolverNodes& nodes, float time, float correctionTime, float passed);
    // Projects every row once.
    void project();
    // Ends a substep: the bodies' points have gone on with the bodies' velocities.
    void end();

    // Returns the impulses of bodies that move by these rows since clear(), about the first body's centre of mass.
    const RigidGiven& given() const { return m_given; }
    // Takes over what rows on a device gave, and the bodies of their moving rows. bodies: as bodies() lists them.
    void takeOver(const RigidGiven& given, const RigidBody* bodies);

private:
    std::vector<RigidBody>* m_bodies = nullptr;
    std::size_t m_turn = 0;
    std::vector<RigidContact> m_contacts;
    std::vector<RigidAnchor> m_anchors;
    std::vector<RigidRowState> m_contactStates, m_anchorStates;
    RigidGiven m_given = {};
    RigidSubstep m_substep = {};
};
}  // namespace drape
