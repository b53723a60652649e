// Runs Gauss-Seidel sweeps on positions over the contacts of one group of a cloth (cloth_parts.h): nodes first, then
// faces, then edges, each colour by colour (feature_order.h).
//
// contact_sweep.h explains what a contact does and why. Most contacts never act in a step. A sweep tests them in
// blocks of one cloth feature, with a margin for rounding. A contact gets a row when it is first found violated or
// pushing. The results equal those of projecting every contact. Groups that share no node may run side by side: each
// moves only its own nodes.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "bullet_plugin/core/platform/compiler.h"
#include "bullet_plugin/core/solver/cloth_contacts.h"

namespace drape
{
// Distance between the points of a contact, as a share of the thickness, below which its features may have passed each
// other.
constexpr float kNearShare = 0.25f;

// The cloth of the groups, and what they share in a step.
struct SweptCloth
{
    ClothContacts* m_contacts = nullptr;
    const ContactSource* m_source = nullptr;
    float m_margin = 0;      // m, rounding margin of the blocks' levels
    float m_retreat = 0;     // m, bound on the displacement of a node by an obstacle's motion
    float m_passed = 1;      // share of the step that has passed
    float m_tolerated = 0;   // m, violation that a projection leaves
    int m_actingSweeps = 0;  // see ContactSweep::restart()
    unsigned m_phase = 0;    // see ContactSweep::restart()
    float m_perPush = 0;     // 1/s, velocity that a push of this phase gives per metre
    bool m_records = false;  // impulses are kept, see ContactGroup::forImpulses()

    SolverNodes& nodes() const { return m_contacts->m_nodes; }
    // Bound on how far levels lie above those at the step's end, m.
    float slack() const { return (1 - m_passed) * m_retreat; }
};

class ContactGroup
{
public:
    // Returns the number of blocks of a feature with so many contacts.
    static std::size_t blocksOf(std::uint32_t contacts) { return (contacts + kLanes - 1) / kLanes; }
    // Resets the group for a cloth of another step; memory is kept.
    void clear();
    // Adds a feature; features come in canonical order, nodes first, then faces. They must stay in place until the last
    // sweep.
    void add(const FeatureContacts& feature) { m_features.push_back(&feature); }
    // Sorts the features by colours and builds the blocks. Call once, after the last feature, when the cloth's margin
    // is known.
    void makeBlocks(const SweptCloth& cloth);

    bool empty() const { return m_features.empty(); }
    enum class Kinds
    {
        Nodes,
        NodesAndFaces,
        Edges
    };
    // Tests every contact of these features once and projects those that are due. Returns the worst violation met, m,
    // as far as the contact's nodes can correct it. A new phase begins with no pushes.
    float sweep(const SweptCloth& cloth, Kinds kinds);
    // Projects the contacts that act in this phase m_actingSweeps times, in the order of sweeps.
    void sweepActing(const SweptCloth& cloth);
    // Removes from the nodes' velocities what a contact gained by recovering a depth that the step began with.
    void limitSpeeds(const SweptCloth& cloth, Kinds kinds);
    // Returns whether a contact has pushed in the step.
    bool hasPushed() const;
    // Returns whether a contact that was violated at any time ends with less than kNearShare of the thickness between
    // its features' points, so that the features may have passed each other.
    bool mayHavePassed(const SweptCloth& cloth) const;
    // Calls visit(contact, impulse) for each contact that has pushed in the step: a pointer to the contact, and what it
    // gave the cloth, N s. Call after limitSpeeds(), with SweptCloth::m_records set since makeBlocks().
    template <class Visit>
    void forImpulses(const Visit& visit)
    {
        addImpulses();
        for (std::size_t i = 0; i < m_blocks.size(); ++i)
            for (int lane = 0; lane < kLanes; ++lane)
            {
                const int row = m_rowsOf[i].m_row[lane];
                if (row >= 0 && m_rows[std::size_t(row)].m_acting.m_pushed)
                    visit(m_blocks[i].m_contacts + lane, m_rows[std::size_t(row)].m_impulse);
            }
    }

private:
    static constexpr int kLanes = 4;  // contacts side by side
    using Lanes = DRAPE_VECTOR_OF(float, kLanes);

    // Contacts of one cloth feature side by side; lanes beyond the last one are never violated. The gap is n.(d0 + w1
    // (d1 - d0) + w2 (d2 - d0)) - level. The level is raised by a margin for rounding.
    struct Block
    {
        Block() {}  // uninitialised: the code that adds the block fills it

        Lanes m_normal[3];
        Lanes m_level;
        Lanes m_weights[2];  // second and third node
        int m_nodes[3];      // the first one again where unused
        int m_count;         // number of nodes
        int m_lanes;         // lanes in use
        const Contact* m_contacts;
    };
    // Indices in m_rows by a block's lanes, -1 for none.
    struct BlockRows
    {
        int m_row[kLanes] = {-1, -1, -1, -1};
    };
    struct Row
    {
        ActingContact m_acting;
        Carry m_carry;
        Vec3 m_impulse;  // N s, given in the phases before this one; only if the cloth records
    };

    // Returns the first block of these kinds, and the end of the last one.
    std::pair<std::size_t, std::size_t> rangeOf(Kinds kinds) const;
    void addFeature(const SweptCloth& cloth, const FeatureContacts& feature);
    static void fillLane(const SweptCloth& cloth, Block& block, int lane, const Contact& contact);
    static Row makeRow(const SweptCloth& cloth, const Block& block, int lane);
    static bool turn(const SweptCloth& cloth, const Block& block, int lane, float passed, Row& row,
                     ContactPlane& plane);
    static void renew(const SweptCloth& cloth, Row& row, Block& block, int lane);
    static bool endsNear(const SweptCloth& cloth, const Block& block, int lane, const Row& row, float least);
    static Lanes excessOf(const Block& block, const SolverNode* nodes, float slack);
    template <int count>
    static Lanes excessOfNodes(const Block& block, const SolverNode* nodes, float slack);
    static bool project(const SweptCloth& cloth, ActingContact& acting, float& worst);
    void beginPhase(const SweptCloth& cloth);
    void addImpulses();
    float projectBlock(const SweptCloth& cloth, std::size_t index, unsigned due);

    std::vector<const FeatureContacts*> m_features;
    std::vector<Block> m_blocks;           // in the order of the features
    std::size_t m_nodeBlocks = 0;          // blocks of node features
    std::size_t m_faceBlocks = 0;          // blocks of node and face features
    std::vector<BlockRows> m_rowsOf;       // by block
    std::vector<unsigned char> m_pushing;  // by block: a bit for each lane whose row has pushed in this phase
    std::vector<Row> m_rows;
    std::vector<std::size_t> m_pushingBlocks;  // blocks with rows that have pushed in this phase
    unsigned m_phase = 0;                      // phase of the last sweep
    float m_perPush = 0;                       // 1/s, of that phase
};
}  // namespace drape
