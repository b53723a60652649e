// Rows of the detector's part: how often answers were wrong, and what they cost.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "benchmarks/support/table.h"

namespace drape::bench
{
// A variant of a test: the varied setting, its value, and the value's name if it is no number.
struct Variant
{
    std::string m_knob;
    double m_value = 0;
    std::string m_setting;
};

Row detectorRow(const std::string& set, const std::string& method, const Variant& variant);

// Counts of true pairs, misses and false hits.
void fillAnswers(Row& row, const std::vector<bool>& truth, const std::vector<bool>& hits);

// Adds the median, the 99 % quantile and the maximum of the errors: <name>_p50, _p99 and _max. Adds nothing if there
// are none.
void fillErrors(Row& row, const std::string& name, std::vector<double> errors);

// Answers all queries several times (the first time is not counted: drivers may compile then) and fills the µs of one.
// False when `answer` is, which says that the device failed.
bool timeQueries(Row& row, std::size_t queries, const std::function<bool()>& answer);
}  // namespace drape::bench
