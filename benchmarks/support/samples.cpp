#include "benchmarks/support/samples.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace drape::bench
{
double Samples::sum() const
{
    return std::accumulate(m_values.begin(), m_values.end(), 0.0);
}

double Samples::quantile(double share) const
{
    if (m_values.empty()) return 0;
    std::vector<double> sorted = m_values;
    std::sort(sorted.begin(), sorted.end());
    return sorted[static_cast<std::size_t>(std::lround(share * static_cast<double>(sorted.size() - 1)))];
}

double Samples::median() const
{
    if (m_values.empty()) return 0;
    std::vector<double> sorted = m_values;
    std::sort(sorted.begin(), sorted.end());
    return (sorted[(sorted.size() - 1) / 2] + sorted[sorted.size() / 2]) / 2;
}

void Samples::fill(Row& row, const std::string& prefix) const
{
    if (m_values.empty()) return;
    row[prefix + "min_ms"] = quantile(0);
    row[prefix + "median_ms"] = median();
    row[prefix + "p95_ms"] = quantile(0.95);
    if (prefix.empty()) row["repeats"] = m_values.size();
}
}  // namespace drape::bench
