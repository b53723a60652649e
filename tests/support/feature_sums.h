// Expected results of kernels/lib/ordering/feature_sums.h.
#pragma once

#include <vector>

#include "kernels/shared/feature_sums.h"

namespace drape::test
{
// Returns the sums over features that have these numbers of contacts.
inline std::vector<std::uint32_t> featureSumsOf(const std::vector<std::uint32_t>& counts)
{
    std::vector<std::uint32_t> sums(DRAPE_FEATURE_SUMS, 0);
    for (std::size_t feature = 0; feature < counts.size(); ++feature)
        sums[feature / DRAPE_SUMMED] += counts[feature];
    return sums;
}
}  // namespace drape::test
