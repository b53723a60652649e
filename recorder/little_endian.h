// Appends a number of four bytes to a file's bytes, the lowest byte first.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>

namespace drape
{
template <typename Number>
void appendLittle(std::string& bytes, Number value)
{
    static_assert(sizeof value == 4, "files have numbers of four bytes");
    std::uint32_t word = 0;
    std::memcpy(&word, &value, sizeof word);
    for (int shift = 0; shift < 32; shift += 8)
        bytes.push_back(static_cast<char>(word >> shift & 0xffu));
}
}  // namespace drape
