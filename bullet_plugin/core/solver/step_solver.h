// Solves one step of some cloths: their links, and Gauss-Seidel sweeps over their contacts between the links'
// iterations and after them.
//
// A cloth's links are the core's own, in substeps (substeps.h), or the caller's. Input: nodes at the ends of their
// paths, and contacts along these. Output: displacements and velocities at the step's end.
//
// Guarantee: no contact ends violated by more than kClosingTolerance if DRAPE_LEAST_CLOSING sweeps suffice. Sweeps
// continue while a violation exceeds what the next step would recover. Results are the same bits with any number of
// threads.
//
// Cost: linear in the contacts; kContactSweeps per iteration or substep, and closing sweeps after them
// (kernels/lib/solver/closing_sweeps.h). Reasons: docs/design_notes/contact_sweeps.md.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

#include "bullet_plugin/core/solver/device/packed_step.h"
#include "bullet_plugin/core/solver/host/contact_sweep.h"
#include "bullet_plugin/core/solver/host/substeps.h"
#include "solver_cloth.h"

namespace drape
{
// Sweeps over the contacts in each substep, one after each sweep over the links, or before each iteration of the
// caller's links. What links and contacts leave each other becomes motion. On the bunny nodes of a cloth of 33 x 33
// nodes at rest end their steps at 8.7 mm/s (RMS) if all sweeps over the links come first. In turns it is 0.2 mm/s.
constexpr int kContactSweeps = Substeps::kLinkSweeps;

// Returns the number of sweeps over acting contacts after each sweep in turns with links, for so many substeps.
inline int actingSweepsOf(int substeps)
{
    return std::max(DRAPE_ACTING_SWEEPS, DRAPE_ACTING_IN_STEP / substeps);
}

// Worst violation that may remain, as a share of the thickness: before DRAPE_LEAST_CLOSING sweeps are done, and after.
// The second is less than what the next step recovers, since later contacts of a sweep may increase a violation that
// was measured earlier in it.
constexpr float kClosingTolerance = 0.01f;
constexpr float kMostViolation = 0.0625f;
// Violation that closing sweeps leave after substeps, as a share of the thickness. Corrections that small would
// undo how links and contacts share a load, in every step (docs/design_notes/contact_sweeps.md, "Rest").
constexpr float kTolerated = 0.005f;
static_assert(kTolerated < kClosingTolerance, "else sweeps never reach the tolerance");

// Returns kTolerated as a distance, m.
inline float toleratedViolation(const ClothContacts& contacts)
{
    return kTolerated * contacts.m_leastThickness;
}

static_assert(kMostViolation < DRAPE_RECOVERED_SHARE, "else cloth comes nearer from step to step");

class StepSolver
{
public:
    explicit StepSolver(ThreadTeam& threads) : m_team(threads), m_threads(threads) {}

    // Solves the cloths and marks them as solved. Cloths with CallersLinks are written back; nodes of others stay where
    // the solver leaves them. free: cloths without contacts, limits or rigid rows. stage: solves the cloths that fit
    // (PackedStep); null if there is none. If the device fails, the host solves them all. Returns the number of cloths
    // that the device solved. rows: contacts between the cloths, which must all be in `cloths` and have
    // the same number of substeps; stage is null then.
    std::size_t solve(const std::vector<SolverCloth>& cloths, const std::vector<SolverCloth>& free,
                      const ContactSource& source, SolveStage* stage = nullptr, ClothRows* rows = nullptr);
    // Enqueues the whole step of the cloths, behind a detection whose contacts stay on the device if there is one.
    // Returns false, with nothing enqueued, if the device cannot solve all of them.
    bool submitBehind(const std::vector<SolverCloth>& cloths, const std::vector<SolverCloth>& free,
                      const ContactSource& source, SolveStage& stage);
    // Takes over the results and marks the cloths as solved. hasWaited: the host has waited for that detection, which
    // must have run once. Other cloths stay as they were, for solve(): those with a path that meets a surface, those
    // that may have passed one if their nodes stay on the device, and all if the device failed. Returns the number of
    // cloths solved.
    std::size_t finishBehind(SolveStage& stage, bool hasWaited);
    // Runs the closing sweeps alone, for cloths whose nodes are at the ends of the paths along which their contacts
    // were found.
    void close(const std::vector<SolverCloth>& cloths, const ContactSource& source);
    // Makes the coming calls keep the impulses of contacts. Nothing else changes.
    void recordImpulses(bool records) { m_records = records; }
    // Calls visit(contact, impulse) for each contact that pushed a cloth in the last solve() or close() on the host: a
    // pointer to the contact, and the impulse that it gave the cloth, N s. Empty unless recordImpulses() was on.
    template <class Visit>
    void forImpulses(const Visit& visit)
    {
        if (!m_records) return;
        for (ContactSweep* sweep : m_touching)
            sweep->forImpulses(visit);
    }

private:
    // The nodes of a cloth, and its links, which are the core's.
    struct LinkedNodes
    {
        SolverNodes* m_nodes;
        Substeps* m_substeps;
    };

    using Cloths = SweepTeam::Cloths;

    // Divides the cloths among the device and the host.
    void divide(const std::vector<SolverCloth>& cloths, const std::vector<SolverCloth>& free, const SolveStage* stage);
    void keepMomenta(const std::vector<SolverCloth>& cloths);
    std::size_t takeResults(const SolveWorkWord* words, SolveStage& stage, bool behind);
    void solveOnHost(const std::vector<SolverCloth>& cloths, const std::vector<SolverCloth>& free,
                     const ContactSource& source);
    void begin(const ContactSource& source);
    template <class Job>
    void forEach(const std::vector<LinkedNodes>& cloths, const Job& job);
    template <class Job>
    void forSubsteps(const Job& job);
    void applyLimits(const Cloths& cloths);
    void sweepContacts(int iteration);
    void restart(int iteration);
    void sweepInTurns();
    void shareRows(bool closing);
    void beginRows(int iteration);
    void closeRows();
    void endIteration(int iteration);
    void iterate();
    void runAgain(const Cloths& cloths);
    void holdOthers();
    void settle();
    void beginClosing();
    void close();

    SweepTeam m_team;
    ThreadTeam& m_threads;
    std::vector<SolverCloth> m_cloths;
    std::vector<std::unique_ptr<ContactSweep>> m_sweeps;  // one for each of m_cloths; kept for their memory
    // Cloths of the step, cloths with contacts, and subsets of one iteration or sweep.
    Cloths m_all, m_touching, m_iterating, m_turn, m_meeting, m_open, m_resting, m_others;
    std::vector<LinkedNodes> m_own;  // working memory of forSubsteps()
    ClothRows* m_rows = nullptr;     // the step's; null for none
    // The cloth with rows whose pushes become velocity in the longest time; see shareRows().
    const SolverCloth* m_slowest = nullptr;
    bool m_records = false;
    PackedStep m_packed;
    std::vector<const SolverCloth*> m_keeping;                               // working memory of keepMomenta()
    std::vector<SolverCloth> m_onDevice, m_onHost, m_freeOnHost, m_refused;  // working memory of solve()
};
}  // namespace drape
