// Runs Gauss-Seidel sweeps on positions over the contacts of one group of a cloth (cloth_parts.h), in canonical
// order.
//
// contact_rounds.h explains what a contact does and why. Most contacts never act in a step. A sweep tests them in
// blocks of one cloth feature, in float32 with a margin for rounding. A contact gets a row when it is first found
// violated or pushing. The results equal those of projecting every contact. Groups that share no node may run side by
// side: each writes only its own nodes' entries of RoundsNodes.
#pragma once

#include <cstddef>
#include <vector>

#include "bullet_plugin/adapter/body_contacts.h"
#include "bullet_plugin/adapter/found_contacts.h"
#include "bullet_plugin/adapter/vectors.h"

namespace drape
{
// Data that the groups of a body share in a step: the nodes that contacts refer to, numbered leaf by leaf. m_places
// holds their positions, since Bullet's nodes are far apart in memory.
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
    std::vector<btVector3> m_places;       // by moved node
    std::vector<unsigned char> m_shifted;  // by moved node: moved in this sweep
    float m_margin = 0;                    // m, rounding margin of the blocks' levels
};

// Share of a movable node's inverse mass that is added to a contact's mobility where the rest of its point is fixed;
// proportionally less where less of it is fixed. It keeps a node with little weight in the point from being thrown
// far. The node moves at most 2.8 times the violation in a sweep, at a weight of a fifth, and less the smaller its
// weight.
constexpr btScalar kHeldSoftness = btScalar(0.04);

constexpr btScalar kNearShare = btScalar(0.25);

class ContactGroup
{
public:
    // Resets the group for a body of another step; memory is kept.
    void clear();
    // Adds a feature; features come in canonical order, nodes first. They must stay in place until the last sweep.
    void add(const FeatureContacts& feature) { m_features.push_back(&feature); }
    // Builds the blocks. Call once, after the last feature, when the nodes' margin is known.
    void makeBlocks(const RoundsNodes& nodes);

    bool empty() const { return m_features.empty(); }
    std::size_t blockCount() const { return m_blocks.size(); }
    enum class Kinds
    {
        Nodes,
        NodesAndFaces,
        Edges
    };
    // Tests every contact of these features once and projects those that are due. Returns the worst violation met, m,
    // as far as the contact's nodes can correct it. A new stage begins with no pushes.
    btScalar look(RoundsNodes& nodes, unsigned stage, Kinds kinds);
    // Lists, for settle(), the contacts that have pushed in this stage and whose planes were renewed. Returns whether
    // there are any.
    bool listSettling();
    // Projects the listed contacts once more.
    void settle(RoundsNodes& nodes);
    // Removes from the nodes' velocities what a contact gained by recovering a depth that the step began with.
    void limitSpeeds(const RoundsNodes& nodes) const;
    // Returns whether a contact that has pushed ends with less than kNearShare of the thickness between its features'
    // points, so that the features may have passed each other.
    bool mayHavePassed(const RoundsNodes& nodes) const;

private:
    // Contacts of one cloth feature side by side; lanes beyond the last one are never violated. The gap is n.(x0 + w1
    // (x1 - x0) + w2 (x2 - x0)) - level. The level is raised by a margin for rounding.
    struct Block
    {
        Block() {}  // uninitialised: the code that adds the block fills it

        Lanes m_normal[3];
        Lanes m_level;
        Lanes m_weights[2];  // second and third node
        int m_moved[3];      // indices of moved nodes; the first one again where unused
        int m_count;         // number of nodes
        int m_lanes;         // lanes in use
        const Contact* m_contacts;
    };
    // Indices in m_rows by a block's lanes, -1 for none.
    struct BlockRows
    {
        int m_row[kLanes] = {-1, -1, -1, -1};
    };
    // A contact that acts. Positions are relative to its point of the cloth, sum w x, at the step's start.
    struct Row
    {
        btVector3 m_normal;
        btVector3 m_start;
        btVector3 m_carried;  // m, along the surface, displacement by the obstacle's motion in the step
        btVector3 m_held;     // friction applied in this stage, in units of the multiplier
        btScalar m_weights[3];
        btScalar m_shares[3];  // by node, displacement per unit multiplier
        int m_moved[3];
        int m_count;
        btScalar m_level;            // m, least n.(sum w x - start)
        btScalar m_inverseMobility;  // weighted point's displacement per unit multiplier; 0: nothing moves
        btScalar m_mended;           // share of a violation that a push corrects: 1 where no node is fixed
        btScalar m_friction;
        btScalar m_multiplier;  // pushed in this stage
        unsigned m_stage;       // in which the plane was renewed
        bool m_renewed;         // in any stage
        bool m_pushed;          // in any stage
        btScalar m_speedLimit;  // m/s outwards when the contact pushed
        btScalar m_distance;    // m, distance to keep from the contact's point: thickness plus target
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
    std::size_t m_nodeBlocks = 0;        // blocks of node features
    std::size_t m_faceBlocks = 0;        // blocks of node and face features
    std::vector<BlockRows> m_rowsOf;     // by block
    std::vector<unsigned char> m_holds;  // by block: a bit for each lane whose row has pushed in this stage
    std::vector<Row> m_rows;
    std::vector<std::size_t> m_holding;  // blocks with rows that have pushed in this stage
    std::vector<Row*> m_settling;        // their rows whose planes were renewed; until the next sweep
    unsigned m_stage = 0;                // stage of the last sweep
};
}  // namespace drape
