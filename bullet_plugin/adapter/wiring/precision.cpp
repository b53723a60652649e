#include "LinearMath/btScalar.h"
#include "drape/precision.h"

namespace drape
{
static_assert(sizeof(btScalar) == (DRAPE_BULLET_DOUBLE ? sizeof(double) : sizeof(float)),
              "Bullet's headers are of the precision that the build was configured for");

#if DRAPE_BULLET_DOUBLE
const char drapeIsBuiltForBulletInDoublePrecision = 1;
#else
const char drapeIsBuiltForBulletInSinglePrecision = 1;
#endif
}  // namespace drape
