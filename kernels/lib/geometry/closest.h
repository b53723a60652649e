// Closest points of a point and a triangle and of two segments, safe for zero-length edges and zero areas.
// Method: C. Ericson, Real-Time Collision Detection, 2005, sections 5.1.5 and 5.1.9.
#ifndef DRAPE_LIB_CLOSEST_H
#define DRAPE_LIB_CLOSEST_H

#include "vec3.h"

DRAPE_NAMESPACE_BEGIN

#include "../any_width/one.h"
#include "../any_width/closest.h"
#include "../any_width/end.h"

DRAPE_NAMESPACE_END

#endif
