// Whether Methods are such as the stages can work by.
#pragma once

#include "drape/error.h"
#include "drape/methods.h"

namespace drape
{
// False for the first field that is out of its range (drape/methods.h): error then names it, its value and the range.
bool checkMethods(const Methods& methods, Error& error);
}  // namespace drape
