// Moving pairs of features whose first time of touching is known: what continuous collision is weighed by.
//
// Four points move on straight lines, a vertex and a face or two edges. The truth is that of the float positions as
// they stand, from the roots of the cubic of their volume in double. Pairs of which double could not be sure (touching
// at a border, at a double root, at the step's ends) are not taken. The same seed gives the same set. Metres.
#pragma once

#include <string>
#include <vector>

#include "kernels/shared/query.h"

namespace drape::bench
{
struct MotionSet
{
    std::string m_name;
    std::vector<CcdQuery> m_queries;
    std::vector<bool> m_truth;    // true if they touch in the step
    std::vector<double> m_times;  // when first, part of the step; 1 where they do not. Empty: not known
};

// Makes pairs of a few centimetres, half of them aimed to touch. They lie near the origin or 100 m from it. Some meet
// inside or outside of a border, at a distance of a thousandth to a millionth of the features' size.
std::vector<MotionSet> makeMotionSets(std::size_t queries);
}  // namespace drape::bench
