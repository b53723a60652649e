// Rows of the detector's part: how often answers were wrong, and what they cost.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "benchmarks/support/table.h"

namespace drape::bench
{
// A variant of a test: what is turned, its value, and the value's name where it is no number.
struct Variant
{
    std::string m_knob;
    double m_value = 0;
    std::string m_setting;
};

Row detectorRow(const std::string& set, const std::string& method, const Variant& variant);

// Counts of true pairs, misses and false hits.
void fillAnswers(Row& row, const std::vector<bool>& truth, const std::vector<bool>& hits);

// Half, 99 % and all of the errors are at most so large: <name>_p50, _p99 and _max. Nothing where there is none.
void fillErrors(Row& row, const std::string& name, std::vector<double> errors);

// Answers all queries several times (the first time is not counted: drivers may compile then) and fills the µs of one.
// False when `answer` is, which says that the device failed.
bool timeQueries(Row& row, std::size_t queries, const std::function<bool()>& answer);
}  // namespace drape::bench
