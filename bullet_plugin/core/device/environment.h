// Reads environment variables, and compares names without case.
#pragma once

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <string>

namespace drape
{
// Returns an empty string for a variable that is not set.
inline std::string variable(const char* name)
{
    const char* const value = std::getenv(name);
    return value ? value : "";
}

inline std::string lowered(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}
}  // namespace drape
