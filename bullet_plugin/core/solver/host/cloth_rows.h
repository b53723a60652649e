// Contacts of cloth with cloth and with itself, as rows of a step's solver: of a node and a face, or of two edges.
//
// Input: contacts along the predicted paths, in canonical order. Rows are projected in this order, on one thread, in
// turns with the sweeps over links and obstacles' contacts (kernels/lib/solver/contact_row.h). A row's plane follows
// the features: it is taken where they are nearest when a substep's sweeps begin, on the side from which they came.
// Rows of features that are far apart then take no part until the next begin(). A step recovers a tenth of the
// thickness of what was missing at its start, evenly, so that its end can take back the speed. Cloth in many folds has
// no room for more, and would fly apart. Every push is given to one feature and taken from the other, so momentum is
// kept. Friction is Coulomb's. Cost: some 100 ns per row and sweep. Lengths in metres, world frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bullet_plugin/core/solver/solver_nodes.h"
#include "kernels/lib/solver/contact_row.h"

namespace drape
{
// The first m_split nodes are the first feature's, the others the second's: 1 and 3, or 2 and 2.
struct ClothContact
{
    SolverNodes* m_cloths[4];  // each node's; null for one that does not move in the step
    std::uint32_t m_nodes[4];  // index in its cloth
    Vec3 m_resting[4];         // m, positions of nodes without a cloth
    int m_split;
    Vec3 m_normal;      // unit, from the second feature to the side from which the first came
    float m_gap0;       // m, along the normal at the step's start
    float m_thickness;  // m, of the pair
    float m_friction;   // coefficient
};

class ClothRows
{
public:
    void clear() { m_rows.clear(), m_near.clear(); }
    bool empty() const { return m_rows.empty(); }
    void add(const ClothContact& contact);
    // Begins a phase, with no pushes: takes the planes where the nodes are now. passed: share of the step that has
    // passed at the phase's end.
    void begin(float passed);
    // Projects the rows that take part once. relaxation: share of a violation that is corrected. tolerated: share of
    // the thickness that may remain of it. Returns the worst violation met, as a share of the thickness.
    float project(float relaxation, float tolerated);
    // Removes from the nodes' velocities what rows gained by recovering a depth that the step began with. perSecond:
    // 1/s, steps per second.
    void limitSpeeds(float perSecond);

private:
    struct Row
    {
        ClothContact m_contact;
        float m_weights[4];  // by node; the second feature's are negative
        float m_distance;    // m, least at the step's end
        ContactRow m_row;    // its normal, level, multiplier and friction; nodes and weights are those above
    };

    static bool isNear(const Row& row);
    static Vec3 wayOf(const Row& row);
    static Vec3 startOf(const ClothContact& contact, int k);
    static Vec3 displacementOf(const ClothContact& contact, int k);
    static float inverseMassOf(const ClothContact& contact, int k);
    static void takePlane(Row& row, float passed);
    static void push(Row& row, Vec3 by);

    std::vector<Row> m_rows;
    std::vector<std::uint32_t> m_near;  // rows that take part, in order
};
}  // namespace drape
