// A cloth of a step and whatever solves its links.
#pragma once

#include "cloth_contacts.h"

namespace drape
{
class ClothRows;
class RigidRows;
class Substeps;
struct KeptStep;

// Links that the caller solves, one iteration at a time. Calls come from the thread of StepSolver::solve(), except
// read() and write(), which may come from any thread for several cloths at once.
class CallersLinks
{
public:
    virtual ~CallersLinks() = default;
    // Returns the number of iterations, at least 1.
    virtual int iterations() const = 0;
    virtual void solve(int iteration) = 0;
    // Sets the nodes' displacements and velocities to those after the last iteration.
    virtual void read(SolverNodes& nodes) = 0;
    // Takes over displacements and velocities of shifted nodes.
    virtual void write(const SolverNodes& nodes) = 0;
};

// A cloth and whatever solves its links: one of the two.
struct SolverCloth
{
    ClothContacts* m_contacts = nullptr;
    Substeps* m_substeps = nullptr;
    CallersLinks* m_links = nullptr;
    RigidRows* m_rigid = nullptr;      // with m_substeps alone; null if there are none
    const KeptStep* m_kept = nullptr;  // with m_substeps alone: the nodes are on the device, not in m_contacts
    bool m_meetsCloth = false;         // it has rows of ClothRows
};
}  // namespace drape
