// Includes Embree's header, version 4 or 3: Ubuntu 24.04 has version 4, Debian 12 version 3.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
