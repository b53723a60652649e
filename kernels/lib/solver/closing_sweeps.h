// The number of sweeps that close a cloth's contacts at the end of a step (core/solver/step_solver.h).
#ifndef DRAPE_LIB_CLOSING_SWEEPS_H
#define DRAPE_LIB_CLOSING_SWEEPS_H

#include "../../shared/types.h"

DRAPE_NAMESPACE_BEGIN

// Closing sweeps up to which the finer tolerance counts.
#define DRAPE_LEAST_CLOSING 8u

// Budget of further sweeps, in contact blocks examined: a millisecond or two. A cloth with few contacts may take more
// sweeps, between the minimum and the maximum below.
#define DRAPE_FURTHER_BLOCKS 65536u
#define DRAPE_LEAST_FURTHER 24u
#define DRAPE_MOST_FURTHER 120u

// Contacts of a feature that are examined side by side.
#define DRAPE_BLOCK_CONTACTS 4u

// Returns the maximum number of closing sweeps over so many contact blocks.
DRAPE_FUNCTION DRAPE_UINT mostClosingSweeps(DRAPE_UINT blocks)
{
    const DRAPE_UINT affordable = DRAPE_FURTHER_BLOCKS / (blocks > 0u ? blocks : 1u);
    if (affordable < DRAPE_LEAST_FURTHER) return DRAPE_LEAST_CLOSING + DRAPE_LEAST_FURTHER;
    return DRAPE_LEAST_CLOSING + (affordable < DRAPE_MOST_FURTHER ? affordable : DRAPE_MOST_FURTHER);
}

// Returns whether a cloth needs another closing sweep after `done` sweeps, the last of which met the violation `worst`.
// fine, most: m, the violations that may remain before DRAPE_LEAST_CLOSING sweeps are done, and after.
DRAPE_FUNCTION int needsClosing(DRAPE_UINT done, DRAPE_UINT blocks, float worst, float fine, float most)
{
    if (done < DRAPE_LEAST_CLOSING) return worst > fine;
    return done < mostClosingSweeps(blocks) && worst > most;
}

DRAPE_NAMESPACE_END

#endif
