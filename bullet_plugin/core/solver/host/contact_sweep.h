// Runs Gauss-Seidel sweeps over the contacts of some cloths, on positions.
//
// Input: cloths whose nodes are somewhere in their step, and their contacts in canonical order. Each sweep projects
// every contact once (kernels/lib/solver/contact_row.h). Friction is Coulomb's, with the product of the cloth's and the
// obstacle's coefficient. Output: displacements; limitSpeeds() keeps the sweeps from adding energy. Nodes without
// inverse mass stay fixed.
//
// Guarantee: the same bits with any number of threads; the order depends on the cloth's cut alone (cloth_parts.h).
// Cost: linear in the contacts, most of which never act (contact_group.h). Reasons:
// docs/design_notes/contact_sweeps.md.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <vector>

#include "bullet_plugin/core/solver/solver_cloth.h"
#include "bullet_plugin/core/threads/thread_team.h"
#include "contact_group.h"

namespace drape
{
// Returns a bound on the rounding difference between the two computations of a violation, m.
float levelMargin(const ClothContacts& contacts);
// Returns the same for nodes whose coordinates are at most `farthest`, m.
float levelMargin(float farthest, float mostThickness);

// Contacts of one cloth, as SweepTeam processes them.
class ContactSweep
{
public:
    // Starts another cloth; memory is kept. Cloth and source must stay unchanged until the last sweep, except for the
    // nodes. records: keeps impulses, see forImpulses().
    void assign(const SolverCloth& cloth, const ContactSource& source, bool records = false);
    // Prepares the cloth once after assign(). SweepTeam::start() does the rest.
    void begin();
    // Begins a phase, with no pushes. passed: the share of the step that has passed, up to 1; obstacles stand there.
    // actingSweeps: after each sweep; 0 unless links are swept in turns with the contacts, which then share their loads
    // (kernels/lib/solver/contact_row.h). tolerated: m, violation that the sweeps leave. perPush: 1/s, the velocity
    // that the caller gives a node per metre by which the phase moves it; for forImpulses().
    void restart(float passed, int actingSweeps = 0, float tolerated = 0, float perPush = 0)
    {
        m_cloth.m_perPush = perPush;
        m_cloth.m_tolerated = tolerated;
        m_cloth.m_actingSweeps = actingSweeps;
        ++m_cloth.m_phase;
        m_cloth.m_passed = passed;
    }

    const SolverCloth& cloth() const { return *m_owner; }
    ClothContacts& contacts() const { return *m_cloth.m_contacts; }
    SolverNodes& nodes() const { return m_cloth.nodes(); }
    // Returns whether a contact has pushed since begin().
    bool hasPushed() const;
    // Calls visit(contact, impulse) for each contact that has pushed, see ContactGroup::forImpulses().
    template <class Visit>
    void forImpulses(const Visit& visit)
    {
        for (std::size_t group = 0; group < m_parts->groupCount(); ++group)
            m_groups[group].forImpulses(visit);
    }

private:
    friend class SweepTeam;

    enum class Pass
    {
        MakeBlocks,
        Nodes,  // contacts of nodes alone
        NodesAndFaces,
        LimitNodesAndFaces,  // NodesAndFaces after nodes are brought back to their paths
        Edges,
        LimitSpeeds,  // contacts of nodes and faces limit speeds
        LimitEdgeSpeeds
    };

    void work(std::size_t group, Pass pass);
    // Processes a leaf, then each ancestor group whose other half is done already.
    void climb(std::size_t leaf, Pass pass);
    void keepNear(std::size_t leaf);
    float worst() const;
    bool mayHavePassed() const;

    const SolverCloth* m_owner = nullptr;
    SweptCloth m_cloth;
    const ClothParts* m_parts = nullptr;
    std::vector<ContactGroup> m_groups;               // groups of m_parts; more from earlier cloths
    std::vector<float> m_worst;                       // by group: worst violation in this sweep, m
    std::vector<unsigned char> m_near;                // by group: whether a contact ends near, see ContactGroup
    std::unique_ptr<std::atomic<bool>[]> m_halfDone;  // by group: whether one of its halves is done in this pass
    std::size_t m_blocks = 0;                         // in all groups
};

// Sweeps over several cloths at once. The team's threads share them if waking the threads pays.
class SweepTeam
{
public:
    explicit SweepTeam(ThreadTeam& threads) : m_threads(threads) {}

    using Cloths = std::vector<ContactSweep*>;

    // Calls job() for each cloth, on any thread where the cloths have many nodes.
    template <class Job>
    void forCloths(const Cloths& cloths, const Job& job)
    {
        const auto one = [&](std::size_t i) { job(*cloths[i]); };
        if (areLarge(cloths)) return m_threads.run(cloths.size(), one);
        for (std::size_t i = 0; i < cloths.size(); ++i)
            one(i);
    }

    // Prepares the cloths for sweeps. Call after begin() of each.
    void start(const Cloths& cloths);
    // Runs one sweep over all contacts.
    void run(const Cloths& cloths);
    // Brings nodes that left their paths too far back, then runs one sweep. Only for cloths whose obstacles rest.
    void limitAndRun(const Cloths& cloths);
    // Returns the worst violation met in the last sweep, m.
    static float worst(const ContactSweep& cloth) { return cloth.worst(); }
    // Returns the number of contact blocks that a sweep tests.
    static std::size_t blockCount(const ContactSweep& cloth) { return cloth.m_blocks; }
    // Runs a sweep over the contacts of nodes alone. They are satisfied exactly afterwards, except at nodes with
    // several.
    void runNodes(const Cloths& cloths);
    // Limits the speeds that contacts gave. Call once, after the last sweep.
    void limitSpeeds(const Cloths& cloths);
    // Returns whether a contact ends so near that a surface may have been passed. Call after limitSpeeds().
    static bool mayHavePassed(const ContactSweep& cloth) { return cloth.mayHavePassed(); }

private:
    struct Leaf
    {
        ContactSweep* m_cloth;
        std::size_t m_leaf;
    };

    static bool areLarge(const Cloths& cloths);
    void pass(const Cloths& cloths, ContactSweep::Pass pass);

    ThreadTeam& m_threads;
    std::vector<Leaf> m_leaves;  // current pass
};
}  // namespace drape
