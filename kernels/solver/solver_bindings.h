// Arguments of the kernels that solve cloths (shared/bindings.h). input, work, topology: see SolveLayout. contacts: of
// the step, in canonical order. nodes: of the work-group's cloth.
#ifndef DRAPE_SOLVER_BINDINGS_H
#define DRAPE_SOLVER_BINDINGS_H

#include "../shared/bindings.h"
#include "../shared/contact.h"
#include "../shared/solve_step.h"

#define DRAPE_SOLVE_CLOTHS                                                                                          \
    DRAPE_VALUE(SolveLayout, layout), DRAPE_READS(SolveInputWord, input), DRAPE_READS(SolveTopologyWord, topology), \
        DRAPE_READS(Contact, contacts), DRAPE_UPDATES(SolveWorkWord, work), DRAPE_LOCAL(SolverNode, nodes)

#ifndef __OPENCL_VERSION__
namespace drape::kernels
{
DRAPE_BIND(solveCloths, DRAPE_SOLVE_CLOTHS)
DRAPE_BIND(solveSmallCloths, DRAPE_SOLVE_CLOTHS)
}  // namespace drape::kernels
#endif

#endif
