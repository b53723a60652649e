// Projection of contacts on positions: C = n.(sum w_i d_i) - level >= 0 for displacements d_i. Pushes are weighted by
// inverse mass (Müller et al. 2007, Position Based Dynamics, section 3.3). Friction is Coulomb's (Macklin et al. 2014,
// Unified Particle Physics, section 6.1).
#ifndef DRAPE_LIB_CONTACT_ROW_H
#define DRAPE_LIB_CONTACT_ROW_H

#include "../../shared/solver.h"
#include "../geometry/vec3.h"

DRAPE_NAMESPACE_BEGIN

// Contacts in turns with links: the share of a violation that a projection corrects, and the minimum number of sweeps
// over the acting contacts of a group after each sweep over all its contacts. Contacts then share a load however they
// are ordered (docs/design_notes/contact_sweeps.md, "Shared loads").
#define DRAPE_TURN_RELAXATION 0.5f
#define DRAPE_ACTING_SWEEPS 3

// Minimum number of such sweeps, times the substeps of a step. Links pull farther in a longer substep.
#define DRAPE_ACTING_IN_STEP 12

// Returns the displacement of the row's point of the cloth, m.
DRAPE_FUNCTION Vec3 rowDisplacement(const ContactRow* row, const DRAPE_NODE_SPACE SolverNode* nodes)
{
    Vec3 displacement = vec3Scale(nodes[row->m_nodes[0]].m_displacement, row->m_weights[0]);
    for (DRAPE_UINT k = 1; k < row->m_count; ++k)
        displacement = vec3AddScaled(displacement, nodes[row->m_nodes[k]].m_displacement, row->m_weights[k]);
    return displacement;
}

// Returns how far the row's point is below its level, m. passed: the share of the step that has passed, up to 1.
DRAPE_FUNCTION float rowViolation(const ContactRow* row, const DRAPE_NODE_SPACE SolverNode* nodes, float passed)
{
    return row->m_level - (1.0f - passed) * row->m_advance - vec3Dot(row->m_normal, rowDisplacement(row, nodes));
}

// Returns what the row has pushed in this phase, kg m.
DRAPE_FUNCTION Vec3 rowPush(const ContactRow* row)
{
    return vec3AddScaled(row->m_held, row->m_normal, row->m_multiplier);
}

// Returns the push that makes a plane hold, kg m, or takes back an earlier push that is not needed any more. slid: m,
// motion along the surface since the step's start, which friction removes up to Coulomb's bound. more: kg m, along the
// normal. multiplier, held: of the row, which grow by what is returned.
DRAPE_FUNCTION Vec3 pushPlane(Vec3 normal, Vec3 slid, float more, float inverseMobility, float friction,
                              float* multiplier, Vec3* held)
{
    const float before = *multiplier, pushed = drapeMax(0.0f, before + more);
    Vec3 now = vec3AddScaled(*held, slid, -inverseMobility);
    const float most = friction * pushed, wanted2 = vec3Dot(now, now);
    if (wanted2 > most * most) now = vec3Scale(now, most / drapeSqrt(wanted2));
    const Vec3 shift = vec3AddScaled(vec3Sub(now, *held), normal, pushed - before);
    *multiplier = pushed;
    *held = now;
    return shift;
}

// Computes the push of a row; see pushPlane(). Friction acts on the point's motion relative to the obstacle.
// displacement: m, of the row's point. tolerated: m, violation that remains. relaxation: share of the rest that is
// corrected. Returns whether there is anything to do; `worst` grows to the violation that a push can correct. shift: kg
// m; a node moves by its share of it. A row with NaN does nothing.
DRAPE_FUNCTION int pushRow(ContactRow* row, Vec3 displacement, float passed, float tolerated, float relaxation,
                           float* worst, Vec3* shift)
{
    const Vec3 normal = row->m_normal;
    const float along = vec3Dot(normal, displacement);
    const float violation = row->m_level - (1.0f - passed) * row->m_advance - along - tolerated;
    if (!(violation > 0.0f) && !(row->m_multiplier > 0.0f)) return 0;
    *worst = drapeMax(*worst, (violation + tolerated) * row->m_mended);
    const Vec3 slid = vec3Sub(vec3AddScaled(displacement, normal, -along), vec3Scale(row->m_carried, passed));
    *shift = pushPlane(normal, slid, relaxation * violation * row->m_inverseMobility, row->m_inverseMobility,
                       row->m_friction, &row->m_multiplier, &row->m_held);
    return 1;
}

// Pushes the row's nodes; see pushRow().
DRAPE_FUNCTION int projectRow(ContactRow* row, DRAPE_NODE_SPACE SolverNode* nodes, float passed, float tolerated,
                              float relaxation, float* worst)
{
    Vec3 shift;
    if (!pushRow(row, rowDisplacement(row, nodes), passed, tolerated, relaxation, worst, &shift)) return 0;
    for (DRAPE_UINT k = 0; k < row->m_count; ++k)
    {
        DRAPE_NODE_SPACE SolverNode* node = nodes + row->m_nodes[k];
        node->m_displacement = vec3AddScaled(node->m_displacement, shift, row->m_shares[k]);
    }
    return 1;
}

DRAPE_NAMESPACE_END

#endif
