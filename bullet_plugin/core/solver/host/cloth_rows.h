// Contacts of cloth with cloth and with itself, as rows of a step's solver: of a node and a face, or of two edges.
//
// Input: contacts along the predicted paths, in canonical order. Rows are projected in turns with the sweeps over links
// and obstacles' contacts (kernels/lib/solver/contact_row.h). The nodes are cut into parts by where they are, all
// cloths' together (ClothParts); rows within one part go first, side by side with those of other parts. So the result
// is the same bits with any number of threads. A row's plane follows
// the features: it is taken where they are nearest when a substep's sweeps begin, on the side from which they came.
// Rows of features that are far apart then take no part until the next begin(). A step recovers a tenth of the
// thickness of what was missing at its start, evenly, so that its end can take back the speed. Cloth in many folds has
// no room for more, and would fly apart. Every push is given to one feature and taken from the other, so momentum is
// kept. Friction is Coulomb's. Lengths in metres, world frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bullet_plugin/core/solver/solver_nodes.h"
#include "bullet_plugin/core/solver/topology/cloth_parts.h"
#include "bullet_plugin/core/solver/topology/group_climb.h"
#include "bullet_plugin/core/threads/ranges.h"
#include "bullet_plugin/core/threads/thread_team.h"
#include "kernels/lib/solver/contact_row.h"

namespace drape
{
// The first m_split nodes are the first feature's, the others the second's: 1 and 3, or 2 and 2.
struct ClothContact
{
    SolverNodes* m_cloths[4];  // each node's; null for one that does not move in the step
    std::uint32_t m_nodes[4];  // index in its cloth
    std::uint32_t m_ids[4];    // index among all cloths' nodes
    Vec3 m_resting[4];         // m, positions of nodes without a cloth
    std::uint64_t m_key;       // names the pair of features; greater than that of the contact before
    int m_split;
    Vec3 m_normal;          // unit, from the second feature to the side from which the first came
    float m_gap0;           // m, along the normal at the step's start
    float m_thickness;      // m, of the pair
    float m_friction;       // coefficient
    std::uint32_t m_index;  // the caller's, for ClothRows::forImpulses()
};

class ClothRows
{
public:
    explicit ClothRows(ThreadTeam& threads) : m_threads(threads) {}

    // Begins a step. keeps: its contacts' keys name the same features as those of the step before.
    void clear(bool keeps);
    bool empty() const { return m_rows.empty(); }
    // Takes the step's rows, once after clear(). contactAt(i, contact): writes the i-th of `count` contacts; false: it
    // has no row. It is called on the threads of the team. positions: m, of all cloths' nodes.
    template <class ContactAt>
    void assign(std::size_t count, const ContactAt& contactAt, const std::vector<Vec3>& positions)
    {
        m_unordered.resize(count);
        m_groupOf.resize(count);
        m_parts.cut(positions, partSize(count, positions.size()), &m_threads);
        const auto take = [&](std::size_t first, std::size_t last)
        {
            for (std::size_t i = first; i < last; ++i)
            {
                ClothContact contact = {};
                m_groupOf[i] = contactAt(i, contact) ? takeRow(contact, m_unordered[i]) : 0;
            }
        };
        forRanges(count, kLeastShared, kRange, &m_threads, take);
        arrange();
    }
    // Begins a phase: takes the planes where the nodes are now. passed: share of the step that has passed at the
    // phase's end. time: s, of the phase's substep, which starts with the pushes of the one before; 0: with none.
    void begin(float passed, float time);
    // Projects the rows that take part `sweeps` times, or until no violation exceeds `enough`. relaxation: share of a
    // violation that is corrected. tolerated: violation that may remain. All are shares of the thickness.
    void project(int sweeps, float relaxation, float tolerated = 0, float enough = 0);
    // Ends the phase: marks the nodes that it moved, and leaves their cloths' SolverNodes::pushShare() of the ways to
    // be added to the velocities. perPush: 1/s, the velocity that the caller gives a node per metre of that.
    void end(float perPush);
    // Removes from the nodes' velocities what rows gained by recovering a depth that the step began with. perSecond:
    // 1/s, steps per second.
    void limitSpeeds(float perSecond);
    // Calls visit(index, impulse) for each contact that pushed in the step: ClothContact::m_index, and what it gave the
    // first feature and took from the second, N s.
    template <class Visit>
    void forImpulses(const Visit& visit) const
    {
        for (const Row& row : m_rows)
            if (vec3Dot(row.m_impulse, row.m_impulse) > 0) visit(row.m_index, row.m_impulse);
    }

private:
    // A row's pushes in a step's last substep, as forces.
    struct Kept
    {
        std::uint64_t m_key;
        float m_push;  // N
        Vec3 m_held;   // N
    };

    struct Row
    {
        const SolverNodes* m_cloths[4];  // null for a node that does not move in the step
        SolverNode* m_nodes[4];          // one that does not move has no inverse mass
        NodeState* m_states[4];
        Vec3 m_starts[4];          // m
        float m_inverseMasses[4];  // 1/kg
        float m_weights[4];        // by node; the second feature's are negative
        std::uint32_t m_ids[4];    // see ClothContact
        std::uint32_t m_order;     // among the contacts that have a row
        Kept m_kept;
        int m_split;        // nodes of the first feature
        float m_gap0;       // m
        float m_distance;   // m, least at the step's end
        float m_thickness;  // m
        float m_friction;
        float m_inverseMobility;  // kg
        std::uint32_t m_index;
        Vec3 m_normal;   // unit, of the phase's plane
        Vec3 m_impulse;  // N s, given in the phases that have ended
    };

    // A row that takes part in a phase: what a sweep reads and writes, side by side.
    struct Acting
    {
        SolverNode* m_nodes[4];
        float m_weights[4];
        float m_shares[4];  // by node, displacement per unit of the multiplier, 1/kg
        Vec3 m_normal;
        float m_level;       // m, least displacement along the normal
        Vec3 m_held;         // friction, in units of the multiplier
        float m_multiplier;  // kg m
        float m_inverseMobility, m_friction, m_thickness;
        std::uint32_t m_hasMoved;  // nodes, in this phase
    };

    // Minimum rows for sharing them among threads, and rows of a range.
    static constexpr std::size_t kLeastShared = 2048, kRange = 512;

    static std::size_t partSize(std::size_t rows, std::size_t nodes);
    std::uint32_t takeRow(const ClothContact& contact, Row& row);
    void arrange();
    static Vec3 wayOf(const Acting& acting);
    static Acting takePlane(Row& row, float passed);
    static void repeat(const Row& row, float time, Acting& acting);
    void endRow(Row& row, const Acting& acting, float perPush) const;
    static void sharePush(const Row& row, const Acting& acting, Vec3 push);
    void findKept(std::size_t first, std::size_t last);
    static void shift(Acting& acting, Vec3 by);
    std::uint32_t groupOf(const Row& row) const;
    // Calls work(acting row, index of its row) for the group's rows that take part.
    template <class Work>
    void forActing(std::size_t group, const Work& work)
    {
        for (std::size_t i = m_firsts[group]; i < m_actingEnds[group]; ++i)
            work(m_acting[i], m_actingRows[i]);
    }
    static void limitSpeed(Row& row, float perSecond);
    ThreadTeam* threads() const;

    ThreadTeam& m_threads;
    SolverNode m_fixed = {};  // stands for all nodes that do not move in the step
    NodeState m_fixedState = {};
    ClothParts m_parts;
    GroupClimb m_climb;
    std::vector<Row> m_rows, m_unordered;
    std::vector<std::uint32_t> m_groupOf;  // by contact; 0: it has no row
    std::vector<std::uint32_t> m_placeOf;  // by contact, in m_rows
    std::vector<std::uint32_t> m_orderOf;  // by contact, see Row
    std::vector<Kept> m_kept;              // sorted by key; the last step's
    float m_time = 0;                      // s, of the phase's substep; 0: none
    std::vector<std::size_t> m_firsts;     // by group, the first of its rows; then the end
    std::vector<Acting> m_acting;          // by group, from m_firsts on: rows that take part
    std::vector<std::uint32_t> m_actingRows;
    std::vector<std::size_t> m_actingEnds;  // by group, in m_acting
    std::vector<float> m_worst;             // by group, the violation that the last sweep met
};
}  // namespace drape
