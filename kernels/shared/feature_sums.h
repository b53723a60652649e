// Sums over the numbers of contacts of cloth features (kernels/lib/ordering/feature_sums.h), for few features.
#ifndef DRAPE_SHARED_FEATURE_SUMS_H
#define DRAPE_SHARED_FEATURE_SUMS_H

#include "types.h"

// Features per row, whose contacts are summed; rows that a work-group sums again; number of all sums; maximum features
// that have sums.
#define DRAPE_SUMMED 16u
#define DRAPE_WIDE_SUMS 64u
#define DRAPE_FEATURE_SUMS (DRAPE_WIDE_SUMS * DRAPE_SUMMED)
#define DRAPE_MOST_SUMMED (DRAPE_FEATURE_SUMS * DRAPE_SUMMED)

#endif
