// Hashes a result's bytes. Two computations that agree in every bit have equal hashes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace drape::bench
{
// Goes on from `hash`; kEmptyHash to begin. Eight bytes a multiplication: results have up to a hundred megabytes.
constexpr std::uint64_t kEmptyHash = 0xcbf29ce484222325ull;
std::uint64_t hashBytes(std::uint64_t hash, const void* bytes, std::size_t count);

template <typename T>
std::uint64_t hashOf(const std::vector<T>& values, std::uint64_t hash = kEmptyHash)
{
    static_assert(std::is_trivially_copyable<T>::value, "records without padding");
    return hashBytes(hash, values.data(), values.size() * sizeof(T));
}

// Returns 16 hex digits.
std::string hashText(std::uint64_t hash);
}  // namespace drape::bench
