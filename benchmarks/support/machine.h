// Describes the machine that a row was measured on.
#pragma once

#include <string>

#include "benchmarks/support/table.h"
#include "drape/report.h"

namespace drape::bench
{
// Returns processor, cores in use, date, and the given commit.
Row describeMachine(const std::string& commit);

// Fills "device" and "driver" of a row.
void fillDevice(Row& row, const DeviceInfo& device);
}  // namespace drape::bench
