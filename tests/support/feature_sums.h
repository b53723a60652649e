// Expected results of kernels/lib/feature_sums.h.
#pragma once

#include <vector>

#include "kernels/shared/feature_sums.h"

namespace drape::test
{
// Returns the sums over slots that have these numbers of hits.
inline std::vector<std::uint32_t> featureSumsOf(const std::vector<std::uint32_t>& counts)
{
    std::vector<std::uint32_t> sums(DRAPE_FEATURE_SUMS, 0);
    for (std::size_t slot = 0; slot < counts.size(); ++slot)
        sums[slot / DRAPE_SUMMED] += counts[slot];
    return sums;
}
}  // namespace drape::test
