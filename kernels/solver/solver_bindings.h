// Arguments of the kernels that solve cloths (shared/bindings.h). input, work, topology: see SolveLayout. contacts: of
// the step, in canonical order, behind their head. nodes, marks: of a work-group's leaf. kept: nodes that stay on the
// device. detected: the detection's nodes.
#ifndef DRAPE_SOLVER_BINDINGS_H
#define DRAPE_SOLVER_BINDINGS_H

#include "../shared/bindings.h"
#include "../shared/contact.h"
#include "../shared/kept_nodes.h"
#include "../shared/mesh.h"
#include "../shared/rigid.h"
#include "../shared/solve_step.h"

#define DRAPE_ORDER_CONTACTS                                                                                        \
    DRAPE_VALUE(SolveLayout, layout), DRAPE_READS(SolveInputWord, input), DRAPE_READS(SolveTopologyWord, topology), \
        DRAPE_READS(Contact, contacts), DRAPE_UPDATES(SolveWorkWord, work)

#define DRAPE_SOLVE_GROUPS DRAPE_ORDER_CONTACTS, DRAPE_VALUE(SolvePass, pass)

#define DRAPE_SOLVE_LEAVES DRAPE_SOLVE_GROUPS, DRAPE_LOCAL(SolverNode, nodes), DRAPE_LOCAL(DRAPE_UINT, marks)

#define DRAPE_SOLVE_RIGID                                                                                  \
    DRAPE_VALUE(SolveLayout, layout), DRAPE_VALUE(RigidLayout, rigid), DRAPE_READS(SolveInputWord, input), \
        DRAPE_UPDATES(SolveWorkWord, work)

#define DRAPE_PREDICT_KEPT                                                                        \
    DRAPE_VALUE(KeptLaunch, launch), DRAPE_READS(KeptCloth, cloths), DRAPE_READS(KeptNode, kept), \
        DRAPE_UPDATES(float, detected)

#define DRAPE_SOLVE_KEPT                                                                                         \
    DRAPE_VALUE(KeptLaunch, launch), DRAPE_VALUE(SolveLayout, layout), DRAPE_READS(SolveTopologyWord, topology), \
        DRAPE_READS(KeptCloth, cloths), DRAPE_UPDATES(KeptNode, kept), DRAPE_UPDATES(SolveWorkWord, work)

#ifndef __OPENCL_VERSION__
namespace drape::kernels
{
DRAPE_BIND(takePaths, DRAPE_ORDER_CONTACTS)
DRAPE_BIND(countContacts, DRAPE_ORDER_CONTACTS)
DRAPE_BIND(placeBuckets, DRAPE_ORDER_CONTACTS)
DRAPE_BIND(gatherContacts, DRAPE_ORDER_CONTACTS)
DRAPE_BIND(prepareContacts, DRAPE_ORDER_CONTACTS)
DRAPE_BIND(solveCloths, DRAPE_SOLVE_LEAVES)
DRAPE_BIND(solveSmallCloths, DRAPE_SOLVE_LEAVES)
DRAPE_BIND(sweepLeaves, DRAPE_SOLVE_LEAVES)
DRAPE_BIND(sweepGroups, DRAPE_SOLVE_GROUPS)
DRAPE_BIND(passNodes, DRAPE_SOLVE_GROUPS)
DRAPE_BIND(takeRigid, DRAPE_SOLVE_RIGID)
DRAPE_BIND(projectRigid, DRAPE_SOLVE_RIGID, DRAPE_VALUE(SolvePass, pass))
DRAPE_BIND(predictKept, DRAPE_PREDICT_KEPT)
DRAPE_BIND(takeKeptPaths, DRAPE_SOLVE_KEPT)
DRAPE_BIND(keepNodes, DRAPE_SOLVE_KEPT, DRAPE_UPDATES(KeptBounds, bounds))
}  // namespace drape::kernels
#endif

#endif
