// The float nearest to a double, as a double.
#pragma once

namespace drape::bench
{
// Through memory: at -O2 the vectorizer of GCC 12.2 takes a chain of conversions to float and back for nothing and
// keeps the double as it was.
inline double roundToFloat(double value)
{
    const volatile float rounded = float(value);
    return double(rounded);
}
}  // namespace drape::bench
