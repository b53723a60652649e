// Runs Gauss-Seidel sweeps over the contacts of some bodies, on positions.
//
// Input: bodies between predictMotion and the end of solveConstraints, and their contacts in canonical order. Each
// sweep projects every contact once: C = n.(sum w_i x_i - p) - thickness - target >= 0, weighted by inverse mass
// (Müller et al. 2007, Position Based Dynamics, section 3.3). Friction is Coulomb's (Macklin et al. 2014, Unified
// Particle Physics, section 6.1) with Bullet's coefficient: kDF times the obstacle's friction.
//
// Output: positions, and velocities (x change)/dt (1 - kDP) as in Bullet's own update. limitSpeeds() keeps the sweeps
// from adding energy. Pinned, massless and anchored nodes stay fixed.
//
// Guarantee: the same bits with any number of threads; the order depends on the cloth's cut alone (cloth_parts.h).
// Cost: linear in the contacts, most of which never act (contact_group.h). Reasons:
// docs/design_notes/contact_sweeps.md.
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
// Contacts of one body, as RoundsTeam processes them.
class ContactRounds
{
public:
    // Starts another body; memory is kept. The body, contacts and found contacts must stay unchanged until the last
    // sweep.
    void assign(BodyContacts& contacts, const FoundContacts& found);
    // Prepares the body once after assign(). RoundsTeam::start() does the rest.
    void begin();
    // Begins a stage, with no pushes.
    void restart() { ++m_stage; }

    BodyContacts& contacts() const { return *m_contacts; }

private:
    friend class RoundsTeam;

    enum class Pass
    {
        MakeBlocks,
        Nodes,  // contacts of nodes alone
        NodesAndFaces,
        LimitNodesAndFaces,  // NodesAndFaces after nodes are brought back to their paths
        Edges,
        EdgesAndList,  // Edges, then lists the rows to settle
        Settle,
        LimitSpeeds
    };

    void work(std::size_t group, Pass pass);
    // Processes a leaf, then each ancestor group whose other half is done already.
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
    std::vector<std::size_t> m_firstMoved;            // by leaf, then the end
    std::vector<ContactGroup> m_groups;               // groups of m_parts; more from earlier bodies
    std::vector<btScalar> m_worst;                    // by group: worst violation in this sweep, m
    std::vector<unsigned char> m_settles;             // by group
    std::vector<unsigned char> m_near;                // by group: whether a contact ends near, see ContactGroup
    std::unique_ptr<std::atomic<bool>[]> m_halfDone;  // by group: whether one of its halves is done in this pass
    std::size_t m_blocks = 0;                         // in all groups
    unsigned m_stage = 0;                             // current stage
};

// Sweeps over several bodies at once. The team's threads share them if waking the threads pays.
class RoundsTeam
{
public:
    // Passes of runAndSettle(). Without any, cloth on thin boards keeps moving at 2.5 mm/s (RMS).
    static constexpr int kSettlingPasses = 2;

    explicit RoundsTeam(ThreadTeam& threads) : m_threads(threads) {}

    using Bodies = std::vector<ContactRounds*>;

    // Calls job() for each body, on any thread where the bodies have many nodes.
    template <class Job>
    void forBodies(const Bodies& bodies, const Job& job)
    {
        const auto one = [&](std::size_t i) { job(*bodies[i]); };
        if (areLarge(bodies)) return m_threads.run(bodies.size(), one);
        for (std::size_t i = 0; i < bodies.size(); ++i)
            one(i);
    }

    // Prepares the bodies for sweeps. Call after begin() of each.
    void start(const Bodies& bodies);
    // Copies the bodies' node positions before sweeps (gather), and writes them back with the velocities afterwards
    // (scatter).
    void gather(const Bodies& bodies);
    void scatter(const Bodies& bodies);
    // Runs one sweep over all contacts.
    void run(const Bodies& bodies);
    // Brings nodes that left their paths too far back, then runs one sweep. Only for bodies whose obstacles rest.
    void limitAndRun(const Bodies& bodies);
    // Returns the worst violation met in the last sweep, m.
    static btScalar worst(const ContactRounds& body) { return body.worst(); }
    // Returns the number of contact blocks that a sweep tests.
    static std::size_t blockCount(const ContactRounds& body) { return body.m_blocks; }
    // Runs a sweep over the contacts of nodes alone. They are satisfied exactly afterwards, except at nodes with
    // several.
    void runNodes(const Bodies& bodies);
    // Runs a sweep over all contacts, then kSettlingPasses over those that have pushed in this stage and whose planes
    // were renewed.
    void runAndSettle(const Bodies& bodies);
    // Limits the speeds that contacts gave. Call once, after the last sweep.
    void limitSpeeds(const Bodies& bodies);
    // Returns whether a contact ends so near that a surface may have been passed. Call after limitSpeeds().
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
    std::vector<Leaf> m_leaves;  // current pass
    Bodies m_settling;           // bodies of runAndSettle()
};
}  // namespace drape
