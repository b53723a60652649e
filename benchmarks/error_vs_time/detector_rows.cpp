#include "benchmarks/error_vs_time/detector_rows.h"

#include <algorithm>

#include "benchmarks/error_vs_time/trial_run.h"
#include "benchmarks/support/samples.h"

namespace drape::bench
{
namespace
{
constexpr std::size_t kLeastRuns = 3, kMostRuns = 9;
constexpr double kSeconds = 1;
}  // namespace

Row detectorRow(const std::string& set, const std::string& method, const Variant& variant)
{
    Row row;
    row["part"] = kDetectorPart;
    row["scene"] = set;
    row["method"] = method;
    row["knob"] = variant.m_knob;
    row["value"] = variant.m_value;
    row["setting"] = variant.m_setting;
    row["ended"] = "whole";
    return row;
}

void fillAnswers(Row& row, const std::vector<bool>& truth, const std::vector<bool>& hits)
{
    std::size_t present = 0, misses = 0, falseHits = 0;
    for (std::size_t i = 0; i < truth.size(); ++i)
    {
        present += truth[i];
        misses += truth[i] && !hits[i];
        falseHits += !truth[i] && hits[i];
    }
    row["queries"] = truth.size();
    row["true_pairs"] = present;
    row["misses"] = misses;
    row["false_hits"] = falseHits;
    if (present == 0) return;
    row["miss_rate"] = double(misses) / double(present);
    row["false_per_true"] = double(falseHits) / double(present);
}

void fillErrors(Row& row, const std::string& name, std::vector<double> errors)
{
    if (errors.empty()) return;
    std::sort(errors.begin(), errors.end());
    row[name + "_p50"] = errors[errors.size() / 2];
    row[name + "_p99"] = errors[errors.size() * 99 / 100];
    row[name + "_max"] = errors.back();
}

bool timeQueries(Row& row, std::size_t queries, const std::function<bool()>& answer)
{
    bool good = answer();
    const Samples times = repeat(kLeastRuns, kMostRuns, kSeconds,
                                 [&]
                                 {
                                     const Clock::time_point start = Clock::now();
                                     good = good && answer();
                                     return millisecondsSince(start);
                                 });
    if (!good || queries == 0) return good;
    row["query_median_us"] = 1000 * times.median() / double(queries);
    row["query_p5_us"] = 1000 * times.quantile(0.05) / double(queries);
    row["query_p95_us"] = 1000 * times.quantile(0.95) / double(queries);
    return true;
}
}  // namespace drape::bench
