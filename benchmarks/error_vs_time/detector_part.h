// The part that measures the cost of single queries against the error of their answers, for the variants of the narrow
// phase, without any simulation.
#pragma once

#include "benchmarks/error_vs_time/trial_run.h"

namespace drape::bench
{
// Adds a row per set of queries, variant and back end: us a query, misses, false hits, and the errors of times,
// distances and normals. Answers of a device must be the host's, bit for bit, or their rows are void. False, with lines
// on standard error, when something could not be measured.
bool measureDetector(const ErrorOptions& options, Table& table);
}  // namespace drape::bench
