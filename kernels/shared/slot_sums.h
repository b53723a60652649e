// Sums over the contacts of cloth features' slots (kernels/lib/slot_sums.h), for few slots.
#ifndef DRAPE_SHARED_SLOT_SUMS_H
#define DRAPE_SHARED_SLOT_SUMS_H

#include "types.h"

// Slots per row, whose contacts are summed; rows that a work-group sums again; number of all sums; maximum slots that
// have sums.
#define DRAPE_SUMMED 16u
#define DRAPE_WIDE_SUMS 64u
#define DRAPE_SLOT_SUMS (DRAPE_WIDE_SUMS * DRAPE_SUMMED)
#define DRAPE_MOST_SUMMED (DRAPE_SLOT_SUMS * DRAPE_SUMMED)

#endif
