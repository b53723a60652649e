// The part that runs whole simulations: every trial on every scene, and its error.
#pragma once

#include "benchmarks/error_vs_time/trial_run.h"

namespace drape::bench
{
// Adds a row a trial, those that were left out too, with why. Drape's trials that may only change the time must have
// the course of its defaults on the host, bit for bit, or their rows are void. False, with lines on standard error,
// when something could not be measured.
bool measureSimulations(const ErrorOptions& options, Table& table);
}  // namespace drape::bench
