// The table of soft_demo's outcomes for documents.
#pragma once

#include <string>

#include "benchmarks/support/table.h"

namespace drape::bench
{
// Returns a table in Markdown, a line for each scene. rows: Bullet's and Drape's of each scene, in turns. A cell has
// Bullet's value, then Drape's. times: adds the milliseconds of a step.
std::string demoTable(const Table& table, bool times);
}  // namespace drape::bench
