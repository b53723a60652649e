#include "tools/cloth_drop/run_record.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace drape
{
namespace
{
// The value below which the given share of the sorted values lies (nearest rank).
double percentile(const std::vector<double>& sorted, double share)
{
    if (sorted.empty()) return 0;
    const double rank = std::ceil(share * static_cast<double>(sorted.size()));
    return sorted[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

TimeSummary summariseTimes(std::vector<double> times)
{
    TimeSummary summary;
    if (times.empty()) return summary;
    summary.m_first = times.front();
    std::sort(times.begin(), times.end());
    const std::size_t half = times.size() / 2;
    summary.m_median = times.size() % 2 ? times[half] : 0.5 * (times[half - 1] + times[half]);
    summary.m_p95 = percentile(times, 0.95);
    summary.m_max = times.back();
    return summary;
}

// Returns the median over the steps that had contacts.
double medianOf(const RunRecord& record, double WholeStepParts::*part)
{
    std::vector<double> times;
    for (const StepRecord& step : record.m_steps)
        if (step.m_times.m_contacts > 0) times.push_back(step.m_times.m_parts.*part);
    return summariseTimes(std::move(times)).m_median;
}

// Percentile of depths among `samples` values of which all that are not listed are 0.
double depthPercentile(std::vector<double> depths, std::size_t samples, double share)
{
    const auto above = static_cast<std::size_t>(static_cast<double>(samples) * (1 - share));
    if (depths.size() <= above) return 0;
    std::nth_element(depths.begin(), depths.begin() + static_cast<std::ptrdiff_t>(above), depths.end(),
                     std::greater<>());
    return depths[above];
}
double restSpeedOf(const std::vector<StepRecord>& steps)
{
    const std::size_t count = (steps.size() + 3) / 4;
    double sum = 0;
    for (std::size_t i = steps.size() - count; i < steps.size(); ++i)
        sum += steps[i].m_speed * steps[i].m_speed;
    return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
}
}  // namespace

RunSummary summarise(const RunRecord& record)
{
    RunSummary summary;
    summary.m_countsClothPairs = record.m_countsClothPairs;
    std::vector<double> steps, collisions, finding, depths;
    for (std::size_t i = 0; i < record.m_steps.size(); ++i)
    {
        const StepRecord& step = record.m_steps[i];
        const StepMeasure& measure = step.m_measure;
        summary.m_contactsMax = std::max(summary.m_contactsMax, step.m_times.m_contacts);
        summary.m_penetrationMax = std::max(summary.m_penetrationMax, measure.m_penetrationMax);
        summary.m_gapMin = i == 0 ? measure.m_gapMin : std::min(summary.m_gapMin, measure.m_gapMin);
        if (measure.m_intersectingPairs > summary.m_intersectingPairsMax)
        {
            summary.m_intersectingPairsMax = measure.m_intersectingPairs;
            summary.m_intersectingPairsMaxStep = i + 1;
        }
        summary.m_selfPairsMax = std::max(summary.m_selfPairsMax, step.m_selfPairs);
        summary.m_invalidNodes = std::max(summary.m_invalidNodes, measure.m_invalidNodes);
        depths.insert(depths.end(), measure.m_nodeDepths.begin(), measure.m_nodeDepths.end());
        if (step.m_times.m_contacts == 0) continue;
        ++summary.m_stepsInContact;
        steps.push_back(step.m_times.m_stepMs);
        collisions.push_back(step.m_times.m_collisionMs);
        finding.push_back(step.m_times.m_collisionMs - step.m_times.m_parts.solverMs());
    }
    summary.m_step = summariseTimes(std::move(steps));
    summary.m_collision = summariseTimes(std::move(collisions));
    summary.m_finding = summariseTimes(std::move(finding));
    for (const NamedPart& part : stepParts())
        summary.m_parts.*part.m_ms = medianOf(record, part.m_ms);
    summary.m_penetrationP99 = depthPercentile(std::move(depths), summary.m_stepsInContact * record.m_clothNodes, 0.99);
    if (record.m_steps.empty()) return summary;
    const StepRecord& last = record.m_steps.back();
    summary.m_nodesBelow = last.m_measure.nodesBelow();
    summary.m_nodesThrough = last.m_nodesThrough;
    summary.m_intersectingPairsEnd = last.m_measure.m_intersectingPairs;
    summary.m_selfPairsEnd = last.m_selfPairs;
    summary.m_stretch = last.m_stretch;
    summary.m_restSpeed = restSpeedOf(record.m_steps);
    summary.m_hash = last.m_hash;
    return summary;
}

double rmsSpeed(const std::vector<float>& before, const std::vector<float>& after, double dt)
{
    double sum = 0;
    for (std::size_t i = 0; i < after.size(); ++i)
    {
        const double way = static_cast<double>(after[i]) - static_cast<double>(before[i]);
        sum += way * way;
    }
    return after.empty() ? 0 : std::sqrt(3 * sum / static_cast<double>(after.size())) / dt;
}

std::uint64_t hashFloats(std::uint64_t hash, const std::vector<float>& values)
{
    for (const float value : values)
    {
        std::uint32_t bits = 0;
        std::memcpy(&bits, &value, sizeof bits);
        for (int shift = 0; shift < 32; shift += 8)
            hash = (hash ^ ((bits >> shift) & 0xffu)) * 0x100000001b3ull;
    }
    return hash;
}

std::string hashText(std::uint64_t hash)
{
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
}
}  // namespace drape
