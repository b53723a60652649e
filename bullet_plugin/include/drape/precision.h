// Keeps an app in one of Bullet's precisions from linking a library built for the other: their records differ in size.
//
// BT_USE_DOUBLE_PRECISION is Bullet's macro, set by the app. DRAPE_BULLET_DOUBLE describes the library; its CMake
// package and its pkg-config file define it. The preprocessor reports a mismatch if both are known. Otherwise the
// linker misses a symbol whose name says which precision the app asks for. Cost: one pointer per translation unit.
#pragma once

#include "drape/export.h"

#ifdef BT_USE_DOUBLE_PRECISION
#if defined(DRAPE_BULLET_DOUBLE) && !DRAPE_BULLET_DOUBLE
#error "This Drape library is built for Bullet in single precision, and BT_USE_DOUBLE_PRECISION is defined."
#endif
#define DRAPE_BUILT_FOR drapeIsBuiltForBulletInDoublePrecision
#else
#if defined(DRAPE_BULLET_DOUBLE) && DRAPE_BULLET_DOUBLE
#error "This Drape library is built for Bullet in double precision, and BT_USE_DOUBLE_PRECISION is not defined."
#endif
#define DRAPE_BUILT_FOR drapeIsBuiltForBulletInSinglePrecision
#endif

namespace drape
{
extern DRAPE_EXPORT const char DRAPE_BUILT_FOR;

#ifdef _MSC_VER
// Other linkers keep a symbol that nobody reads; Microsoft's compares two texts instead.
#ifdef BT_USE_DOUBLE_PRECISION
#pragma detect_mismatch("drape's precision of Bullet", "double")
#else
#pragma detect_mismatch("drape's precision of Bullet", "single")
#endif
#else
namespace
{
__attribute__((used)) const char* const kBuiltFor = &DRAPE_BUILT_FOR;
}
#endif
}  // namespace drape

#undef DRAPE_BUILT_FOR
