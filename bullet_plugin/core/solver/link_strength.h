// The strength of a link in substeps that gives it the stiffness that Bullet's solver would.
//
// Bullet's links correct the share k (kLST) of a violation in each of n iterations per step. A mass that hangs on such
// a link in a resting cloth ends g dt² r / (1 - r) below the rest length, where r = (1 - k)^n is what the iterations
// leave. A solver with s substeps, each of which corrects the share c once, leaves g (dt / s)² (1 - c) / c. Equating
// both gives c = 1 / (1 + s² r / (1 - r)): soft links stretch as in Bullet whatever the substeps, and stiff ones do
// not.
#pragma once

#include <algorithm>
#include <cmath>

namespace drape
{
// Returns the share of a violation that one visit corrects. stiffness: kLST, 0 to 1. iterations: Bullet's per step, at
// least 1. visits: of the link in each substep, at least 1.
inline double visitShare(double stiffness, int iterations, int substeps, int visits)
{
    const double k = std::min(1.0, std::max(0.0, stiffness));
    const double left = std::pow(1 - k, iterations);
    if (!(left < 1)) return 0;
    const double wanted = 1 / (1 + double(substeps) * substeps * left / (1 - left));
    return 1 - std::pow(1 - wanted, 1.0 / visits);
}
}  // namespace drape
