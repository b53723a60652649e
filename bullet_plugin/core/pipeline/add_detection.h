// Adds up the statistics of a step that detects contacts more than once.
#pragma once

#include <algorithm>

#include "drape/report.h"

namespace drape
{
// One of a step's detections.
enum class Detection
{
    First,  // along the predicted paths
    Again,  // along other paths; its contacts replace earlier ones
    Check   // along the paths of solved cloth; the solver does not receive its contacts
};

// Adds a detection to its step. Status bits, retries and times are those of all detections. Counts are those of the
// contacts that the solver receives; kept obstacles are those of the first detection, which updates the others.
inline void addDetection(StepStatistics& step, const StepStatistics& detection, Detection kind)
{
    step.m_status |= detection.m_status;
    step.m_clothsLeftOut = std::max(step.m_clothsLeftOut, detection.m_clothsLeftOut);
    step.m_invalidNodes = std::max(step.m_invalidNodes, detection.m_invalidNodes);
    step.m_onHost = step.m_onHost || detection.m_onHost;
    step.m_retries += detection.m_retries;
    step.m_waitMs += detection.m_waitMs;
    step.m_refitMs += detection.m_refitMs;
    step.m_broadMs += detection.m_broadMs;
    step.m_narrowMs += detection.m_narrowMs;
    if (kind == Detection::First) step.m_obstaclesKept = detection.m_obstaclesKept;
    if (kind == Detection::Check) return;
    static_cast<StepCounts&>(step) = detection;
    step.m_skipped = detection.m_skipped;
}
}  // namespace drape
