// Whether settings are such as the stages can work by.
#pragma once

#include "drape/error.h"
#include "drape/settings.h"

namespace drape
{
// False for the first field that is out of its range (drape/settings.h): error then names it, its value
// and the range.
bool checkSettings(const Settings& settings, Error& error);
}  // namespace drape
