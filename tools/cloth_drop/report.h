// Turns run records into what the user gets: JSON, CSV and a table.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tools/cloth_drop/run_record.h"

namespace drape
{
struct NamedRun
{
    std::string m_name;  // key of the JSON object: drape, bullet_stock …
    RunRecord m_record;
};

// The one run's keys; or, by name, an object per run, and the ratios of the collision medians to the first run's.
nlohmann::ordered_json asJson(const std::vector<NamedRun>& runs, bool byName);

// A header line and a row a step.
std::string asCsv(const RunRecord& record, double dt);

// Returns a table for reading, with a column per run.
std::string asTable(const std::vector<NamedRun>& runs);
}  // namespace drape
