// Checks that the stages can use the settings.
#pragma once

#include "drape/error.h"
#include "drape/settings.h"

namespace drape
{
// Returns false for the first field outside its range (drape/settings.h); error then names the field,
// its value and the range.
bool checkSettings(const Settings& settings, Error& error);
}  // namespace drape
