// Checks that the stages can use the settings.
#pragma once

#include "drape/error.h"
#include "drape/settings.h"

namespace drape
{
// False for the first field that is out of its range (drape/settings.h, drape/methods.h): error then names it, its
// value and the range.
bool checkSettings(const Settings& settings, Error& error);
}  // namespace drape
