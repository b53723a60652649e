// Gauss-Seidel rounds over the contacts of one body, on positions.
//
// Input: a body between predictMotion and the end of solveConstraints, and its contacts in canonical order. Each round
// projects every contact once: C = n.(sum w_i x_i - p) - thickness - target >= 0, weighted by inverse mass (Müller et
// al. 2007, Position Based Dynamics, section 3.3). Within a stage, from restart() to the next, a contact remembers how
// far it has pushed and takes back what others have made needless, so that the rounds tend to the smallest correction;
// pushes that are never taken back lift a node by more than its contacts ask for, and it falls back a step later, for
// ever. A face at a vertex that is violated for the first time in a stage takes its plane anew, where the two are
// nearest as the nodes stand then: at the predicted end, where detection took it, a face that rocks on a corner of the
// obstacle has swung past where it will lie, and is pushed back as far, for ever. One round leaves nodes that several
// contacts push too high: runAndSettle() has such faces take back what is too much before the links pull again.
// Otherwise a contact that others make needless, and that detection reports in one step and not in the
// next, moves the cloth in every other step. Nodes come before faces and edges in canonical order: most faces and edges
// are free once their nodes are. Friction holds the motion since the step's start along the surface, relative to the
// obstacle's, up to Coulomb's bound on the push (Macklin et al. 2014, Unified Particle Physics, section 6.1), with
// Bullet's coefficient, kDF times the obstacle's friction. Velocities follow the positions as in Bullet's own update,
// (x change)/dt (1 - kDP); limitSpeeds() takes out again what a contact gained by recovering a depth that the step
// began with. So no energy comes from the rounds. Pinned, massless and anchored nodes stay.
//
// Cost: linear in the contacts, but most of them never act in a step. A round looks at contacts by blocks of one cloth
// feature, in float32 and with a margin for rounding; only for those that may be violated, or push already, there is a
// row, made when it is first needed. The results are those of projecting every contact.
#pragma once

#include <vector>

#include "bullet_plugin/adapter/body_contacts.h"
#include "bullet_plugin/adapter/found_contacts.h"

namespace drape
{
class ContactRounds
{
public:
    // Without any, cloth on thin boards stirs at 2.5 mm/s (RMS) for ever.
    static constexpr int kSettlingPasses = 2;

    static constexpr int kLanes = 4;  // contacts looked at side by side
    using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));

    // For another body; memory is kept. Both stay as they are until the last round.
    void start(const BodyContacts& contacts, const FoundContacts& found);

    // Begins a stage: nothing is pushed yet.
    void restart();
    // One round over all contacts. Returns the worst violation met, m.
    btScalar run() { return runBlocks(m_blocks.size()); }
    // The same over the contacts of nodes alone, which hold exactly afterwards but for nodes with several.
    void runNodes() { runBlocks(m_nodeBlocks); }
    // A round over all contacts, then kSettlingPasses over those that have pushed in this stage and whose planes were
    // taken anew.
    void runAndSettle();
    // Once, after the last round.
    void limitSpeeds();

    bool empty() const { return m_blocks.empty(); }

private:
    // A node that contacts refer to. Where it is is in m_places: Bullet's nodes are far apart.
    struct Moved
    {
        btScalar m_inverseMass;
        int m_node;
    };
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
        btScalar m_friction;
        btScalar m_multiplier;  // pushed in this stage
        unsigned m_stage;       // for which the plane was renewed
        bool m_renewed;         // in any stage
        bool m_pushed;          // in any stage
        btScalar m_speedLimit;  // m/s outwards when it pushed
        btScalar m_distance;    // m, to keep from the contact's point: the thickness and the target
        const btTransform* m_carry;
    };

    void addFeature(const FeatureContacts& feature);
    int addMoved(int node);
    void fillLane(Block& block, int lane, const Contact& contact) const;
    Row makeRow(const Block& block, int lane) const;
    void setPlane(Row& row, const btScalar weights[3], const btVector3& normal, const btVector3& point) const;
    btVector3 startOf(const Row& row) const;
    bool isViolated(const Row& row) const;
    void renewPlane(Row& row, Block& block, int lane) const;
    void gather();
    void scatter();
    btScalar lookAtBlocks(std::size_t count);
    btScalar runBlocks(std::size_t count);
    static Lanes excessOf(const Block& block, const btVector3* places);
    template <int count>
    static Lanes excessOfNodes(const Block& block, const btVector3* places);
    btScalar projectBlock(std::size_t index, unsigned due);
    bool project(Row& row, btScalar& worst);
    void settle();
    template <int count>
    bool projectNodes(Row& row, btScalar& worst);
    void limitSpeed(const Row& row);

    const BodyContacts* m_contacts = nullptr;
    const FoundContacts* m_found = nullptr;
    btSoftBody* m_body = nullptr;
    std::vector<int> m_movedOfNode;  // index in m_moved, -1 for none
    std::vector<Moved> m_moved;
    std::vector<btVector3> m_places;       // of m_moved
    std::vector<unsigned char> m_shifted;  // likewise: in this round
    float m_farthest = 0;                  // largest coordinate of a path, m
    std::vector<Block> m_blocks;           // in canonical order
    std::vector<BlockRows> m_rowsOf;       // of each
    std::vector<unsigned char> m_holds;    // likewise: a bit for each lane whose row has pushed in this stage
    std::vector<Row> m_rows;
    std::vector<std::size_t> m_holding;  // blocks with rows that have pushed in this stage
    std::vector<Row*> m_settling;        // within settle(): of those the rows whose planes were taken anew
    std::size_t m_nodeBlocks = 0;
    float m_margin = 0;    // m, of the blocks' levels
    unsigned m_stage = 0;  // counts up with each
};
}  // namespace drape
