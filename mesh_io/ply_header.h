// The header of a PLY file: its encoding, and its elements with their properties.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mesh_io/binary_number.h"

namespace drape
{
enum class PlyEncoding
{
    Text,
    LittleEndian,
    BigEndian
};

struct PlyProperty
{
    std::string m_name;
    bool m_isList = false;
    NumberType m_countType = NumberType::Uint8;  // type of a list's length
    NumberType m_type = NumberType::Float32;

    // Returns the fewest bytes of a value in a binary file.
    std::size_t smallestSize() const { return numberSize(m_isList ? m_countType : m_type); }
};

struct PlyElement
{
    std::string m_name;
    std::uint64_t m_count = 0;
    std::vector<PlyProperty> m_properties;

    // Returns the property's index, or -1.
    int find(const std::string& name, bool isList) const;
};

struct PlyHeader
{
    PlyEncoding m_encoding = PlyEncoding::Text;
    std::vector<PlyElement> m_elements;
    std::size_t m_bodyStart = 0;
    std::size_t m_lines = 0;
    std::size_t m_unknownLines = 0;  // lines that begin with no keyword of the format
};

// Returns "" or why the file has no PLY header. Header lines may end with LF, CR LF or CR; the first line's end is
// expected at the last line, since the byte after it may be data.
std::string readPlyHeader(const std::string& bytes, PlyHeader& header);
}  // namespace drape
