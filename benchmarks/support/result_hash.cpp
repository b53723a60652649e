#include "benchmarks/support/result_hash.h"

#include <cstdio>
#include <cstring>

namespace drape::bench
{
std::uint64_t hashBytes(std::uint64_t hash, const void* bytes, std::size_t count)
{
    const unsigned char* from = static_cast<const unsigned char*>(bytes);
    // Mixes words by FNV-1a's step, with the high bits folded down, since a product carries changes upwards only.
    const auto mix = [&hash](std::uint64_t word)
    {
        hash = (hash ^ word) * 0x100000001b3ull;
        hash ^= hash >> 32;
    };
    std::size_t done = 0;
    for (; done + 8 <= count; done += 8)
    {
        std::uint64_t word;
        std::memcpy(&word, from + done, 8);
        mix(word);
    }
    for (; done < count; ++done)
        mix(from[done]);
    mix(count);
    return hash;
}

std::string hashText(std::uint64_t hash)
{
    char text[24];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
}
}  // namespace drape::bench
