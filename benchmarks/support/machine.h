// What a row's figures were measured on.
#pragma once

#include <string>

#include "benchmarks/support/table.h"
#include "drape/report.h"

namespace drape::bench
{
// Processor, cores in use, date, commit as given, versions of the peers.
Row describeMachine(const std::string& commit);

// "device", "driver", "platform" of a row.
void fillDevice(Row& row, const DeviceInfo& device);
}  // namespace drape::bench
