// Writes what a back end's run has counted into the statistics of a step.
#pragma once

#include "drape/report.h"
#include "kernels/shared/mesh.h"

namespace drape
{
// Replaces the counts of pairs of features and of invalid nodes by those of a back end's run.
inline void writeCounts(const StepCounters& counters, StepStatistics& statistics)
{
    statistics.m_candidates = counters.m_candidates;
    statistics.m_sweptTests = counters.m_swept;
    statistics.m_selfCandidates = counters.m_selfTests;
    statistics.m_selfSweptTests = counters.m_selfSwept;
    statistics.m_invalidNodes = counters.m_invalidNodes;
}
}  // namespace drape
