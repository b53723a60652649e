// Keeps an app in one of Bullet's precisions from linking a library built for the other: their records differ in size.
//
// BT_USE_DOUBLE_PRECISION is Bullet's macro, set by the app. DRAPE_BULLET_DOUBLE describes the library; its CMake
// package and its pkg-config file define it. The preprocessor reports a mismatch if both are known. Otherwise the
// linker misses a symbol whose name says which precision the app asks for. Cost: one pointer per translation unit.
#pragma once

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
extern const char DRAPE_BUILT_FOR;

namespace
{
__attribute__((used)) const char* const kBuiltFor = &DRAPE_BUILT_FOR;
}
}  // namespace drape

#undef DRAPE_BUILT_FOR
