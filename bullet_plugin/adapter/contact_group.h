// Gauss-Seidel over some of a body's contacts, on positions: those whose nodes lie in one group of the cloth's
// (cloth_parts.h), in canonical order.
//
// What a contact does, and why, is told in contact_rounds.h. Most contacts never act in a step. A look goes over them
// by blocks of one cloth feature, in float32 and with a margin for rounding; only for those that may be violated, or
// push already, there is a row, made when it is first needed. The results are those of projecting every contact. Groups
// that share no node may be worked on side by side: they write nothing of RoundsNodes but what belongs to their own
// nodes.
#pragma once

#include <cstddef>
#include <vector>

#include "bullet_plugin/adapter/body_contacts.h"
#include "bullet_plugin/adapter/found_contacts.h"
#include "bullet_plugin/adapter/vectors.h"

namespace drape
{
// What the groups of a body share in a step: its nodes that contacts refer to, numbered leaf by leaf. Where they are is
// in m_places: Bullet's nodes are far apart.
struct RoundsNodes
{
    struct Moved
    {
        btScalar m_inverseMass;
        int m_node;
    };

    const BodyContacts* m_contacts = nullptr;
    const FoundContacts* m_found = nullptr;
    btSoftBody* m_body = nullptr;
    std::vector<int> m_movedOfNode;  // index in m_moved, -1 for none
    std::vector<Moved> m_moved;
    std::vector<btVector3> m_places;       // of m_moved
    std::vector<unsigned char> m_shifted;  // likewise: in this round
    float m_margin = 0;                    // m, of the blocks' levels, for rounding
};

// Share of a movable node's inverse mass that a contact's mobility counts as more than it is, where all of the rest of
// its point is held; in proportion where less is. A node that moves little of the point is then not thrown far for it:
// at most 2.8 times the violation in a round, at a fifth of the weight, and the less the smaller its weight.
constexpr btScalar kHeldSoftness = btScalar(0.04);

constexpr btScalar kNearShare = btScalar(0.25);

class ContactGroup
{
public:
    // For a body of another step; memory is kept.
    void clear();
    // Features in canonical order, of nodes first. They stay where they are until the last look.
    void add(const FeatureContacts& feature) { m_features.push_back(&feature); }
    // Once, after the last feature; the nodes' margin is known then.
    void makeBlocks(const RoundsNodes& nodes);

    bool empty() const { return m_features.empty(); }
    std::size_t blockCount() const { return m_blocks.size(); }
    enum class Kinds
    {
        Nodes,
        NodesAndFaces,
        Edges
    };
    // Looks at every contact of such features once and projects those that are due. Returns the worst violation met, m,
    // of what its nodes can mend. Where the stage is another one than before, nothing is pushed yet.
    btScalar look(RoundsNodes& nodes, unsigned stage, Kinds kinds);
    // Lists, for settle(), the contacts that have pushed in this stage and whose planes were taken anew. Returns
    // whether there are any.
    bool listSettling();
    // Projects these once more.
    void settle(RoundsNodes& nodes);
    // Takes out of the nodes' velocities what a contact gained by recovering a depth that the step began with.
    void limitSpeeds(const RoundsNodes& nodes) const;
    // Returns whether a contact that has pushed is left with less than kNearShare of the thickness between its
    // features' points, so that the features may have passed each other.
    bool mayHavePassed(const RoundsNodes& nodes) const;

private:
    // Contacts of one cloth feature side by side; lanes beyond the last one are never violated. The gap is
    // n.(x0 + w1 (x1 - x0) + w2 (x2 - x0)) - level. The level is raised by a margin for rounding.
    struct Block
    {
        Block() {}  // leaves everything to who adds it

        Lanes m_normal[3];
        Lanes m_level;
        Lanes m_weights[2];  // of the second and third node
        int m_moved[3];      // the first one again where unused
        int m_count;         // of nodes
        int m_lanes;         // in use
        const Contact* m_contacts;
    };
    // Indices in m_rows by a block's lanes, -1 for none.
    struct BlockRows
    {
        int m_row[kLanes] = {-1, -1, -1, -1};
    };
    // A contact that acts. All is seen from where its point of the cloth, sum w x, was at the step's start.
    struct Row
    {
        btVector3 m_normal;
        btVector3 m_start;
        btVector3 m_carried;  // m, along the surface, what the obstacle's motion in the step does to it
        btVector3 m_held;     // by friction, in this stage, in units of the multiplier
        btScalar m_weights[3];
        btScalar m_shares[3];  // of a unit multiplier, by node
        int m_moved[3];
        int m_count;
        btScalar m_level;            // m, least n.(sum w x - start)
        btScalar m_inverseMobility;  // of what a unit multiplier moves the weighted point by; 0: nothing moves
        btScalar m_mended;           // share of a violation that a push takes away: 1 where no node is held
        btScalar m_friction;
        btScalar m_multiplier;  // pushed in this stage
        unsigned m_stage;       // for which the plane was renewed
        bool m_renewed;         // in any stage
        bool m_pushed;          // in any stage
        btScalar m_speedLimit;  // m/s outwards when it pushed
        btScalar m_distance;    // m, to keep from the contact's point: the thickness and the target
        const btTransform* m_carry;
        const btVector3* m_carriedStarts;
    };

    void addFeature(const RoundsNodes& nodes, const FeatureContacts& feature);
    static void fillLane(const RoundsNodes& nodes, Block& block, int lane, const Contact& contact);
    static Row makeRow(const RoundsNodes& nodes, const Block& block, int lane);
    static void setPlane(const RoundsNodes& nodes, Row& row, const btScalar weights[3], const btVector3& normal,
                         const btVector3& point);
    static btVector3 startOf(const RoundsNodes& nodes, const Row& row);
    static btVector3 carriedFrom(const RoundsNodes& nodes, const Row& row);
    static btScalar violation(const RoundsNodes& nodes, const Row& row);
    static bool isViolated(const RoundsNodes& nodes, const Row& row) { return violation(nodes, row) > 0; }
    static void renewPlane(const RoundsNodes& nodes, Row& row, Block& block, int lane);
    static Lanes excessOf(const Block& block, const btVector3* places);
    template <int count>
    static Lanes excessOfNodes(const Block& block, const btVector3* places);
    static bool project(RoundsNodes& nodes, Row& row, btScalar& worst);
    template <int count>
    static bool projectNodes(RoundsNodes& nodes, Row& row, btScalar& worst);
    static void limitSpeed(const RoundsNodes& nodes, const Row& row);
    void beginStage(unsigned stage);
    btScalar projectBlock(RoundsNodes& nodes, std::size_t index, unsigned due);

    std::vector<const FeatureContacts*> m_features;
    std::vector<Block> m_blocks;         // in canonical order
    std::size_t m_nodeBlocks = 0;        // of features of one node
    std::size_t m_faceBlocks = 0;        // of those and of three
    std::vector<BlockRows> m_rowsOf;     // of each block
    std::vector<unsigned char> m_holds;  // likewise: a bit for each lane whose row has pushed in this stage
    std::vector<Row> m_rows;
    std::vector<std::size_t> m_holding;  // blocks with rows that have pushed in this stage
    std::vector<Row*> m_settling;        // of those the rows whose planes were taken anew; until the next look
    unsigned m_stage = 0;                // of the last look
};
}  // namespace drape
