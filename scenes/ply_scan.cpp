#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <sstream>
#include <vector>

#include "scenes/mesh_scan.h"

namespace drape
{
namespace
{
enum class Encoding
{
    Text,
    Little,
    Big
};

struct Property
{
    std::string m_name;
    std::string m_countType;  // empty: not a list
    std::string m_type;
};

struct Element
{
    std::string m_name;
    std::uint64_t m_count = 0;
    std::vector<Property> m_properties;
};

struct Header
{
    Encoding m_encoding = Encoding::Text;
    std::vector<Element> m_elements;
};

// Bytes of a PLY scalar type; 0 for an unknown one.
std::size_t typeSize(const std::string& type)
{
    static const std::map<std::string, std::size_t> sizes = {
        {"char", 1},  {"uchar", 1},   {"int8", 1},   {"uint8", 1},  {"short", 2}, {"ushort", 2},
        {"int16", 2}, {"uint16", 2},  {"int", 4},    {"uint", 4},   {"int32", 4}, {"uint32", 4},
        {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};
    const auto found = sizes.find(type);
    return found == sizes.end() ? 0 : found->second;
}

template <typename T>
double fromBytes(const unsigned char* bytes)
{
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<double>(value);
}

double decode(const std::string& type, const unsigned char* bytes)
{
    if (type == "char" || type == "int8") return fromBytes<std::int8_t>(bytes);
    if (type == "uchar" || type == "uint8") return fromBytes<std::uint8_t>(bytes);
    if (type == "short" || type == "int16") return fromBytes<std::int16_t>(bytes);
    if (type == "ushort" || type == "uint16") return fromBytes<std::uint16_t>(bytes);
    if (type == "int" || type == "int32") return fromBytes<std::int32_t>(bytes);
    if (type == "uint" || type == "uint32") return fromBytes<std::uint32_t>(bytes);
    if (type == "double" || type == "float64") return fromBytes<double>(bytes);
    return fromBytes<float>(bytes);
}

// The file's body as a row of numbers, text or binary. Binary files are read on little-endian machines.
class Numbers
{
public:
    Numbers(Encoding encoding, const std::string& bytes, std::size_t start)
        : m_encoding(encoding), m_bytes(bytes), m_at(start)
    {
    }

    // Text has an element a line, which other readers take for granted. To be called before each element …
    void startElement()
    {
        if (m_encoding != Encoding::Text) return;
        m_lineEnd = std::min(m_bytes.find('\n', m_bytes.find_first_not_of(kBlanks, m_at)), m_bytes.size());
    }
    // … and after it: "", or that there is more on its line.
    std::string endElement() const
    {
        if (m_encoding != Encoding::Text) return "";
        const std::size_t more = m_bytes.find_first_not_of(kBlanks, m_at);
        return more < m_lineEnd ? "the line has more numbers than the header says" : "";
    }

    // Behind the last element.
    bool isAtEnd() const { return m_bytes.find_first_not_of(kBlanks, m_at) == std::string::npos; }

    // "" and the next number, or why there is none.
    std::string next(const std::string& type, double& value)
    {
        return m_encoding == Encoding::Text ? nextWord(value) : nextBinary(type, value);
    }

private:
    std::string nextWord(double& value)
    {
        const std::size_t first = m_bytes.find_first_not_of(kBlanks, m_at);
        if (first == std::string::npos) return "the file ends too early";
        if (first >= m_lineEnd) return "the line ends too early";
        m_at = std::min(m_bytes.find_first_of(kBlanks, first), m_bytes.size());
        const std::string word = m_bytes.substr(first, m_at - first);
        char* end = nullptr;
        value = std::strtod(word.c_str(), &end);
        return *end == '\0' ? "" : "'" + word.substr(0, 32) + "' is not a number";
    }

    std::string nextBinary(const std::string& type, double& value)
    {
        unsigned char ordered[8];
        const std::size_t size = typeSize(type);
        if (size > m_bytes.size() - m_at) return "the file ends too early";
        for (std::size_t i = 0; i < size; ++i)
            ordered[i] = static_cast<unsigned char>(m_bytes[m_at + (m_encoding == Encoding::Big ? size - 1 - i : i)]);
        m_at += size;
        value = decode(type, ordered);
        return "";
    }

    static constexpr const char* kBlanks = " \t\r\n";

    Encoding m_encoding;
    const std::string& m_bytes;
    std::size_t m_at;
    std::size_t m_lineEnd = 0;  // text: of the element's line
};

std::string readProperty(std::istringstream& words, Header& header)
{
    Property property;
    std::string more;
    words >> property.m_type;
    if (property.m_type == "list") words >> property.m_countType >> property.m_type;
    words >> property.m_name;
    if (header.m_elements.empty() || typeSize(property.m_type) == 0 || property.m_name.empty() || words >> more ||
        (!property.m_countType.empty() && typeSize(property.m_countType) == 0))
        return "not a mesh: bad property '" + property.m_name + "' in the PLY header";
    header.m_elements.back().m_properties.push_back(property);
    return "";
}

std::string readElement(std::istringstream& words, Header& header)
{
    Element element;
    std::string more;
    if (!(words >> element.m_name >> element.m_count) || words >> more)
        return "not a mesh: bad element in the PLY header";
    header.m_elements.push_back(element);
    return "";
}

std::string readFormat(std::istringstream& words, Header& header)
{
    std::string encoding;
    words >> encoding;
    if (encoding != "ascii" && encoding != "binary_little_endian" && encoding != "binary_big_endian")
        return "not a mesh: bad format in the PLY header";
    header.m_encoding = encoding == "ascii"                  ? Encoding::Text
                        : encoding == "binary_little_endian" ? Encoding::Little
                                                             : Encoding::Big;
    return "";
}

// A line that this reader passed over would be one that Assimp may take for something else: all are known, or refused.
std::string readHeader(const std::string& bytes, Header& header, std::size_t& bodyStart)
{
    std::size_t at = 0;
    for (bool first = true;; first = false)
    {
        const std::size_t end = bytes.find('\n', at);
        if (end == std::string::npos) return "not a mesh: no PLY header";
        std::istringstream words(bytes.substr(at, end - at));
        at = end + 1;
        std::string keyword, problem;
        words >> keyword;
        if (first && keyword != "ply") return "not a mesh: no PLY header";
        if (keyword == "end_header") break;
        if (keyword == "format")
            problem = readFormat(words, header);
        else if (keyword == "element")
            problem = readElement(words, header);
        else if (keyword == "property")
            problem = readProperty(words, header);
        else if (!first && keyword != "comment" && keyword != "obj_info")
            problem = "not a mesh: a line of the PLY header is none of format, comment, element, property";
        if (!problem.empty()) return problem;
    }
    bodyStart = at;
    return "";
}

// Of a value that may be any double.
std::string wholeNumber(double value)
{
    char text[32];
    std::snprintf(text, sizeof(text), "%.17g", value);
    return text;
}

bool isCorners(const Property& property)
{
    return !property.m_countType.empty() && (property.m_name == "vertex_indices" || property.m_name == "vertex_index");
}

std::string checkProperty(Numbers& numbers, const Element& element, const Property& property, double vertices)
{
    double count = 1;
    const bool list = !property.m_countType.empty();
    if (list)
    {
        const std::string problem = numbers.next(property.m_countType, count);
        if (!problem.empty()) return problem;
        if (!(count >= 0 && count == std::floor(count))) return "the length of a list is not a whole number";
    }
    const bool coordinate = element.m_name == "vertex" && !list && property.m_name.size() == 1 &&
                            std::strchr("xyz", property.m_name[0]) != nullptr;
    const bool index = element.m_name == "face" && isCorners(property);
    if (index && count < 3) return "a face has at least three corners";
    for (double i = 0; i < count; ++i)
    {
        double value = 0;
        std::string problem = numbers.next(property.m_type, value);
        if (problem.empty() && coordinate) problem = coordinateProblem(value);
        if (problem.empty() && index && !(value == std::floor(value)))
            problem = "an index is not a whole number";  // also for NaN
        if (problem.empty() && index && !(value >= 0 && value < vertices))
            problem = "index " + wholeNumber(value) + " is out of range (" + wholeNumber(vertices) + " vertices)";
        if (!problem.empty()) return problem;
    }
    return "";
}

std::string checkElement(Numbers& numbers, const Element& element, double vertices)
{
    numbers.startElement();
    for (const Property& property : element.m_properties)
    {
        const std::string problem = checkProperty(numbers, element, property, vertices);
        if (!problem.empty()) return problem;
    }
    return numbers.endElement();
}
}  // namespace

std::string scanPly(const std::string& bytes)
{
    Header header;
    std::size_t bodyStart = 0;
    const std::string headerProblem = readHeader(bytes, header, bodyStart);
    if (!headerProblem.empty()) return headerProblem;
    double vertices = 0, faces = 0;
    for (const Element& element : header.m_elements)
    {
        if (element.m_name == "vertex") vertices = static_cast<double>(element.m_count);
        if (element.m_name == "face") faces = static_cast<double>(element.m_count);
    }
    const auto isStrips = [](const Element& element) { return element.m_name == "tristrips" && element.m_count > 0; };
    if (std::any_of(header.m_elements.begin(), header.m_elements.end(), isStrips))
        return "has triangle strips (tristrips), of which nothing is read; only faces";
    if (vertices == 0) return "not a mesh: no vertices";
    if (faces == 0) return "no triangles";
    if (header.m_encoding == Encoding::Text && bytes.find('\0') != std::string::npos)
        return "not a mesh: an ASCII PLY file is text, this one has zero bytes";
    Numbers numbers(header.m_encoding, bytes, bodyStart);
    for (const Element& element : header.m_elements)
    {
        const bool corners = std::any_of(element.m_properties.begin(), element.m_properties.end(), isCorners);
        if (element.m_name == "face" && !corners) return "not a mesh: faces have no vertex_indices in the PLY header";
        if (element.m_properties.empty() && element.m_count > 0)
            return "not a mesh: element '" + element.m_name + "' has no properties in the PLY header";
        for (std::uint64_t i = 0; i < element.m_count; ++i)
        {
            const std::string problem = checkElement(numbers, element, vertices);
            if (!problem.empty()) return element.m_name + " " + std::to_string(i + 1) + ": " + problem;
        }
    }
    return numbers.isAtEnd() ? "" : "has more behind the elements that the PLY header counts";
}

std::string plyWithLineEnd(const std::string& bytes)
{
    Header header;
    std::size_t bodyStart = 0;
    readHeader(bytes, header, bodyStart);
    if (header.m_encoding == Encoding::Text || bytes[bodyStart] != '\n' || bytes[bodyStart - 2] == '\r') return "";
    return bytes.substr(0, bodyStart - 1) + '\r' + bytes.substr(bodyStart - 1);
}
}  // namespace drape
