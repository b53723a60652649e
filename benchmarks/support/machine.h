// Describes the machine that a row was measured on.
#pragma once

#include <string>

#include "benchmarks/support/table.h"
#include "drape/report.h"

namespace drape::bench
{
// Processor, cores in use, date, commit as given.
Row describeMachine(const std::string& commit);

// "device" and "driver" of a row.
void fillDevice(Row& row, const DeviceInfo& device);
}  // namespace drape::bench
