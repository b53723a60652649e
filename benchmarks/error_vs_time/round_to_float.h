// Rounds a double to the nearest float, as a double.
#pragma once

namespace drape::bench
{
// Rounds through memory. At -O2 the vectorizer of GCC 12.2 removes a chain of conversions to float and back, and keeps
// the double unrounded.
inline double roundToFloat(double value)
{
    const volatile float rounded = float(value);
    return double(rounded);
}
}  // namespace drape::bench
