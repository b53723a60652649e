// Checks of arguments of ClothWorld. A check that fails throws InvalidInput, which ends the public call.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "drape/cloth_records.h"
#include "drape/mesh_description.h"

namespace drape
{
// Its text names the argument that is wrong and what it should be.
class InvalidInput : public std::runtime_error
{
    using std::runtime_error::runtime_error;
};

inline void require(bool good, const char* wrong)
{
    if (!good) throw InvalidInput(wrong);
}

// NaN is in no range.
inline void requireNumber(double value, double low, double high, const char* wrong)
{
    require(value >= low && value <= high, wrong);
}

// Refuses a missing array, and values that are not finite.
template <typename Value>
void requireValues(const Value* values, std::size_t count, const char* name)
{
    if (count > 0 && !values) throw InvalidInput(std::string(name) + ": the array is missing");
    for (std::size_t i = 0; i < count; ++i)
        if (!std::isfinite(values[i]))
            throw InvalidInput(std::string(name) + ": value " + std::to_string(i) + " is not finite");
}

// Refuses a missing array, and indices outside [0, limit). thing: what they are indices of.
inline void requireIndices(const std::int32_t* indices, std::size_t count, std::size_t limit, const char* name,
                           const char* thing)
{
    if (count > 0 && !indices) throw InvalidInput(std::string(name) + ": the array is missing");
    for (std::size_t i = 0; i < count; ++i)
        if (indices[i] < 0 || std::size_t(indices[i]) >= limit)
            throw InvalidInput(std::string(name) + ": there is no " + thing + " " + std::to_string(indices[i]) +
                               " among " + std::to_string(limit));
}

inline void requireNodes(const std::int32_t* nodes, std::size_t count, std::size_t nodeCount, const char* name)
{
    requireIndices(nodes, count, nodeCount, name, "node");
}

// Refuses a mesh that Bullet cannot have: indices out of range, positions that are not finite, too many of anything.
void requireMesh(const MeshDescription& mesh);
}  // namespace drape
