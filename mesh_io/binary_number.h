// Numbers of binary files. Works on hosts of either byte order. The caller checks that the bytes are there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

namespace drape
{
enum class NumberType
{
    Int8,
    Uint8,
    Int16,
    Uint16,
    Int32,
    Uint32,
    Float32,
    Float64
};

inline std::size_t numberSize(NumberType type)
{
    constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<int>(type)];
}

// Returns the number at `bytes`, which is exact in a double.
inline double decodeNumber(NumberType type, const char* bytes, bool bigEndian)
{
    const std::size_t size = numberSize(type);
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < size; ++i)
        bits = bits << 8 | static_cast<unsigned char>(bytes[bigEndian ? i : size - 1 - i]);
    const std::uint32_t half = static_cast<std::uint32_t>(bits);
    float single = 0;
    double number = 0;
    switch (type)
    {
        case NumberType::Int8:
            return static_cast<std::int8_t>(bits);
        case NumberType::Int16:
            return static_cast<std::int16_t>(bits);
        case NumberType::Int32:
            return static_cast<std::int32_t>(half);
        case NumberType::Float32:
            std::memcpy(&single, &half, sizeof single);
            return static_cast<double>(single);
        case NumberType::Float64:
            std::memcpy(&number, &bits, sizeof number);
            return number;
        default:
            return static_cast<double>(bits);
    }
}

inline std::uint32_t littleUint32(const std::string& bytes, std::size_t place)
{
    return static_cast<std::uint32_t>(decodeNumber(NumberType::Uint32, bytes.data() + place, false));
}
}  // namespace drape
