// Gauss-Seidel rounds over the contacts of some bodies, on positions.
//
// Input: bodies between predictMotion and the end of solveConstraints, and their contacts in canonical order. Each
// round projects every contact once: C = n.(sum w_i x_i - p) - thickness - target >= 0, weighted by inverse mass
// (Müller et al. 2007, Position Based Dynamics, section 3.3). Within a stage, from restart() to the next, a contact
// remembers how far it has pushed and takes back what others have made needless, so that the rounds tend to the
// smallest correction; pushes that are never taken back lift a node by more than its contacts ask for, and it falls
// back a step later, for ever. A face at a vertex that is violated for the first time in a stage takes its plane anew,
// where the two are nearest as the nodes stand then: at the predicted end, where detection took it, a face that rocks
// on a corner of the obstacle has swung past where it will lie, and is pushed back as far, for ever. One round leaves
// nodes that several contacts push too high: runAndSettle() has such faces take back what is too much before the links
// pull again. Otherwise a contact that others make needless, and that detection reports in one step and not in the
// next, moves the cloth in every other step. Friction holds the motion since the step's start along the surface,
// relative to the obstacle's, up to Coulomb's bound on the push (Macklin et al. 2014, Unified Particle Physics, section
// 6.1), with Bullet's coefficient, kDF times the obstacle's friction. Velocities follow the positions as in Bullet's
// own update, (x change)/dt (1 - kDP); limitSpeeds() takes out again what a contact gained by recovering a depth that
// the step began with. So no energy comes from the rounds. Pinned, massless and anchored nodes stay; a face or an
// edge that they hold is pushed the less the more of the contact's point is theirs: else its other nodes, with little
// of the point and all of the push, are thrown as far as they lack leverage.
//
// Order: each body's cloth is cut into groups (cloth_parts.h). A round goes over the contacts of nodes and faces from
// the leaves to the root, then over those of edges likewise; within a group nodes come first: most faces and edges are
// free once their nodes are. With a leaf's edges before faces that reach beyond it, cloth on a torus stirs at 1.8 mm/s
// (RMS) for ever; so, and in canonical order alone, at 0.2. Groups that share no node, and bodies, are worked on by the
// threads of a team side by side; the order that counts depends on the cloth's cut alone, so that the results are the
// same bits with any number of threads.
//
// Cost: linear in the contacts, but most of them never act in a step (contact_group.h).
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <vector>

#include "bullet_plugin/adapter/body_contacts.h"
#include "bullet_plugin/adapter/cloth_parts.h"
#include "bullet_plugin/adapter/contact_group.h"
#include "bullet_plugin/adapter/found_contacts.h"
#include "bullet_plugin/core/threads/thread_team.h"

namespace drape
{
// Of one body; what RoundsTeam works on.
class ContactRounds
{
public:
    // For another body; memory is kept. All three stay as they are until the last round.
    void assign(BodyContacts& contacts, const FoundContacts& found);
    // Once after that. RoundsTeam::start() does the rest.
    void begin();
    // Begins a stage: nothing is pushed yet.
    void restart() { ++m_stage; }

    BodyContacts& contacts() const { return *m_contacts; }

private:
    friend class RoundsTeam;

    enum class Pass
    {
        MakeBlocks,
        Nodes,  // looks at the contacts of these
        NodesAndFaces,
        LimitNodesAndFaces,  // the same, nodes brought back to their paths first
        Edges,
        EdgesAndList,  // the same, and what settles
        Settle,
        LimitSpeeds
    };

    void work(std::size_t group, Pass pass);
    // Works on a leaf and on those of the groups above it whose other half is done already.
    void climb(std::size_t leaf, Pass pass);
    void numberMoved();
    void gather();
    void scatter();
    void keepNear(std::size_t leaf);
    btScalar worst() const;
    bool anySettles() const;
    bool mayHavePassed() const;

    BodyContacts* m_contacts = nullptr;
    const ClothParts* m_parts = nullptr;
    RoundsNodes m_nodes;
    std::vector<std::size_t> m_firstMoved;            // of each leaf, and behind the last
    std::vector<ContactGroup> m_groups;               // those of m_parts; more from earlier bodies
    std::vector<btScalar> m_worst;                    // by group: violation in this round, m
    std::vector<unsigned char> m_settles;             // by group
    std::vector<unsigned char> m_near;                // by group: whether a contact is left near, see ContactGroup
    std::unique_ptr<std::atomic<bool>[]> m_halfDone;  // by group, as m_groups: one of its halves, in this pass
    std::size_t m_blocks = 0;                         // of all groups
    unsigned m_stage = 0;                             // counts up with each
};

// Rounds over several bodies at once. The team's threads share them where that is worth waking them.
class RoundsTeam
{
public:
    // Without any, cloth on thin boards stirs at 2.5 mm/s (RMS) for ever.
    static constexpr int kSettlingPasses = 2;

    explicit RoundsTeam(ThreadTeam& threads) : m_threads(threads) {}

    using Bodies = std::vector<ContactRounds*>;

    // Calls job() for each, on any thread where they have many nodes.
    template <class Job>
    void forBodies(const Bodies& bodies, const Job& job)
    {
        const auto one = [&](std::size_t i) { job(*bodies[i]); };
        if (areLarge(bodies)) return m_threads.run(bodies.size(), one);
        for (std::size_t i = 0; i < bodies.size(); ++i)
            one(i);
    }

    // After begin() of each.
    void start(const Bodies& bodies);
    // Takes over where the bodies' nodes are, before rounds; and gives them back, with the velocities, behind them.
    void gather(const Bodies& bodies);
    void scatter(const Bodies& bodies);
    // One round over all contacts.
    void run(const Bodies& bodies);
    // The same of bodies whose obstacles rest, after nodes that left their paths too far were brought back.
    void limitAndRun(const Bodies& bodies);
    // Worst violation met in the last round, m.
    static btScalar worst(const ContactRounds& body) { return body.worst(); }
    // Of contacts, which a round looks at.
    static std::size_t blockCount(const ContactRounds& body) { return body.m_blocks; }
    // A round over the contacts of nodes alone, which hold exactly afterwards but for nodes with several.
    void runNodes(const Bodies& bodies);
    // A round over all contacts, then kSettlingPasses over those that have pushed in this stage and whose planes were
    // taken anew.
    void runAndSettle(const Bodies& bodies);
    // Once, after the last round.
    void limitSpeeds(const Bodies& bodies);
    // Returns whether a contact is left so near that a surface may have been passed. After limitSpeeds().
    static bool mayHavePassed(const ContactRounds& body) { return body.mayHavePassed(); }

private:
    struct Leaf
    {
        ContactRounds* m_body;
        std::size_t m_leaf;
    };

    static bool areLarge(const Bodies& bodies);
    void pass(const Bodies& bodies, ContactRounds::Pass pass);

    ThreadTeam& m_threads;
    std::vector<Leaf> m_leaves;  // of the pass under way
    Bodies m_settling;           // of runAndSettle()
};
}  // namespace drape
