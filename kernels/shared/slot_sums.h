// Sums over the contacts of cloth features' slots (kernels/lib/slot_sums.h), for few slots.
#ifndef DRAPE_SHARED_SLOT_SUMS_H
#define DRAPE_SHARED_SLOT_SUMS_H

#include "types.h"

// Slots of a row, whose hits are summed, and rows of which a work-group sums again; all sums; the most slots that have any.
#define DRAPE_SUMMED 16u
#define DRAPE_WIDE_SUMS 64u
#define DRAPE_SLOT_SUMS (DRAPE_WIDE_SUMS * DRAPE_SUMMED)
#define DRAPE_MOST_SUMMED (DRAPE_SLOT_SUMS * DRAPE_SUMMED)

#endif
