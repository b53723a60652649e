// Times of repeated runs: least, median, 95th percentile.
#pragma once

#include <algorithm>
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
    // Returns the sample nearest to the quantile `share` (0 to 1), or 0 without samples.
    double quantile(double share) const;
    // Returns the median, or 0 without samples. An even number of samples has the mean of the two middle ones.
    double median() const;

    // Sets <prefix>min_ms, <prefix>median_ms and <prefix>p95_ms, and without a prefix how many samples they are of;
    // nothing without samples.
    void fill(Row& row, const std::string& prefix = "") const;

private:
    std::vector<double> m_values;
};

// Repeats of what is short, at least: fewer say nothing of a median and a 95th percentile.
constexpr std::size_t kLeastRepeats = 5;
constexpr double kShortMs = 50;

// Runs take (which returns ms) until `least` runs were made and then until `most` or the time is used up, whichever
// comes first; of what takes less than kShortMs kLeastRepeats are made in any case.
template <typename Take>
Samples repeat(std::size_t least, std::size_t most, double seconds, Take take)
{
    Samples samples;
    const Clock::time_point start = Clock::now();
    const auto wanted = [&]
    {
        const std::size_t floor = samples.quantile(0) < kShortMs ? kLeastRepeats : least;
        return samples.count() < std::max(least, floor) ||
               (samples.count() < most && millisecondsSince(start) < 1000 * seconds);
    };
    while (wanted())
        samples.add(take());
    return samples;
}
}  // namespace drape::bench
