#include "mesh_io/ply_header.h"

#include <sstream>
#include <utility>

namespace drape
{
namespace
{
bool findType(const std::string& name, NumberType& type)
{
    static constexpr std::pair<const char*, NumberType> types[] = {
        {"char", NumberType::Int8},      {"int8", NumberType::Int8},       {"uchar", NumberType::Uint8},
        {"uint8", NumberType::Uint8},    {"short", NumberType::Int16},     {"int16", NumberType::Int16},
        {"ushort", NumberType::Uint16},  {"uint16", NumberType::Uint16},   {"int", NumberType::Int32},
        {"int32", NumberType::Int32},    {"uint", NumberType::Uint32},     {"uint32", NumberType::Uint32},
        {"float", NumberType::Float32},  {"float32", NumberType::Float32}, {"double", NumberType::Float64},
        {"float64", NumberType::Float64}};
    for (const auto& known : types)
        if (name == known.first)
        {
            type = known.second;
            return true;
        }
    return false;
}

std::string readProperty(std::istringstream& words, PlyHeader& header)
{
    PlyProperty property;
    std::string type, countType;
    words >> type;
    property.m_isList = type == "list";
    if (property.m_isList) words >> countType >> type;
    words >> property.m_name;
    if (header.m_elements.empty()) return "a property before the first element";
    if (!findType(type, property.m_type)) return "unknown type '" + type.substr(0, 32) + "'";
    if (property.m_isList && !findType(countType, property.m_countType))
        return "unknown type '" + countType.substr(0, 32) + "'";
    if (property.m_name.empty()) return "a property without a name";
    header.m_elements.back().m_properties.push_back(property);
    return "";
}

std::string readElement(std::istringstream& words, PlyHeader& header)
{
    PlyElement element;
    std::string count;
    words >> element.m_name >> count;
    if (count.empty() || count.size() > 18 || count.find_first_not_of("0123456789") != std::string::npos)
        return "an element without a count";
    element.m_count = std::stoull(count);
    header.m_elements.push_back(element);
    return "";
}

std::string readFormat(std::istringstream& words, PlyHeader& header)
{
    std::string encoding;
    words >> encoding;
    if (encoding == "ascii")
        header.m_encoding = PlyEncoding::Text;
    else if (encoding == "binary_little_endian")
        header.m_encoding = PlyEncoding::LittleEndian;
    else if (encoding == "binary_big_endian")
        header.m_encoding = PlyEncoding::BigEndian;
    else
        return "unknown format '" + encoding.substr(0, 32) + "'";
    return "";
}

// Returns the line end that the file's first line has, or an empty text without a line.
std::string lineEndOf(const std::string& bytes)
{
    const std::size_t end = bytes.find_first_of("\r\n");
    if (end == std::string::npos) return "";
    return bytes.compare(end, 2, "\r\n") == 0 ? "\r\n" : bytes.substr(end, 1);
}
}  // namespace

int PlyElement::find(const std::string& name, bool isList) const
{
    for (std::size_t i = 0; i < m_properties.size(); ++i)
        if (m_properties[i].m_name == name && m_properties[i].m_isList == isList) return static_cast<int>(i);
    return -1;
}

std::string readPlyHeader(const std::string& bytes, PlyHeader& header)
{
    const std::string lineEnd = lineEndOf(bytes);
    bool hasFormat = false;
    for (std::size_t place = 0;;)
    {
        const std::size_t end = lineEnd.empty() ? std::string::npos : bytes.find(lineEnd, place);
        if (end == std::string::npos) break;
        std::istringstream words(bytes.substr(place, end - place));
        place = end + lineEnd.size();
        std::string keyword, problem;
        words >> keyword;
        if (++header.m_lines == 1 && keyword != "ply" && keyword != "\xef\xbb\xbfply") break;
        header.m_bodyStart = place;
        if (keyword == "end_header") return hasFormat ? "" : "not a mesh: the PLY header has no format";
        if (keyword == "format")
            problem = readFormat(words, header);
        else if (keyword == "element")
            problem = readElement(words, header);
        else if (keyword == "property")
            problem = readProperty(words, header);
        else if (header.m_lines > 1 && !keyword.empty() && keyword != "comment" && keyword != "obj_info")
            ++header.m_unknownLines;
        hasFormat = hasFormat || keyword == "format";
        if (!problem.empty())
            return "line " + std::to_string(header.m_lines) + ": not a mesh: " + problem + " in the PLY header";
    }
    return header.m_lines > 1 ? "not a mesh: the PLY header does not end" : "not a mesh: no PLY header";
}
}  // namespace drape
