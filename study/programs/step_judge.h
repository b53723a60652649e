// Holds the steps of a run against the same steps of another.
//
// Contacts alone do not tell a wrong step where there are none, so that as many candidates are asked for, too, and a
// run with one wrong step is wrong as a whole.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/support/step_method.h"

namespace drape::bench
{
// Returns whether two runs found the same in every step: contacts, bit for bit, and as many candidates where
// bothListTriangles. A line on standard error says which step of `name` did not.
bool agree(const std::string& name, const std::vector<StepOutcome>& run, const std::vector<StepOutcome>& reference,
           bool bothListTriangles);

// Voids a row of a run that does not agree with its reference.
void judgeStep(Row& row, const StepOutcome& reference, bool agrees);
}  // namespace drape::bench
