// Times of repeated runs: least, median, 95th percentile.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "benchmarks/support/table.h"

namespace drape::bench
{
using Clock = std::chrono::steady_clock;

inline double millisecondsSince(Clock::time_point start)
{
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

class Samples
{
public:
    void add(double ms) { m_values.push_back(ms); }
    bool empty() const { return m_values.empty(); }
    std::size_t count() const { return m_values.size(); }
    double sum() const;
    // The value below which the share (0 to 1) of the samples lies: the nearest of them. 0 when there is none.
    double quantile(double share) const;
    double median() const { return quantile(0.5); }

    // Sets <prefix>min_ms, <prefix>median_ms and <prefix>p95_ms; nothing without samples.
    void fill(Row& row, const std::string& prefix = "") const;

private:
    std::vector<double> m_values;
};

// Runs take (which returns ms) until `least` runs were made and then until `most` or the time is used up, whichever
// comes first.
template <typename Take>
Samples repeat(std::size_t least, std::size_t most, double seconds, Take take)
{
    Samples samples;
    const Clock::time_point start = Clock::now();
    while (samples.count() < least || (samples.count() < most && millisecondsSince(start) < 1000 * seconds))
        samples.add(take());
    return samples;
}
}  // namespace drape::bench
