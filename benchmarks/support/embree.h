// Embree's header, version 4 or 3: Ubuntu 24.04 has the one, Debian 12 the other.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
