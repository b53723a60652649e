#include <cctype>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <sstream>
#include <vector>

#include "scenes/mesh_scan.h"

namespace drape
{
namespace
{
constexpr const char* kByteOrderMark = "\xef\xbb\xbf";

struct FaceIndex
{
    long long m_vertex;  // from 1
    std::size_t m_line;
};

struct ObjState
{
    long long m_vertices = 0;
    std::vector<FaceIndex> m_largest;  // at most one entry: the largest index seen, checked when all vertices are known
};

std::string vertexProblem(std::istringstream& line, ObjState& state)
{
    ++state.m_vertices;
    const std::string vertex = "vertex " + std::to_string(state.m_vertices) + ": ";
    int numbers = 0;
    for (std::string word; line >> word; ++numbers)
    {
        const std::string problem = numbers < 3 ? coordinateProblem(word) : "";
        if (!problem.empty()) return vertex + problem;
        // Assimp counts what begins with a digit or a sign, and drops a vertex of whose count it makes nothing.
        if (!std::isdigit(static_cast<unsigned char>(word[0])) && word[0] != '-' && word[0] != '+')
            return vertex + "'" + word.substr(0, 32) + "' begins with no digit";
        if (word.find_first_of("xX") != std::string::npos)
            return vertex + "'" + word.substr(0, 32) + "' is hexadecimal";
    }
    if (numbers < 3) return vertex + "has fewer than three coordinates";
    if (numbers != 3 && numbers != 4 && numbers != 6)
        return vertex + "has " + std::to_string(numbers) + " numbers, not 3, 4 (with a weight) or 6 (with a colour)";
    return "";
}

std::string faceProblem(std::istringstream& line, ObjState& state, std::size_t lineNumber)
{
    std::string word;
    int corners = 0;
    for (; line >> word; ++corners)
    {
        char* end = nullptr;
        const long long index = std::strtoll(word.c_str(), &end, 10);
        if (end == word.c_str() || (*end != '\0' && *end != '/')) return "face index '" + word + "' is not a number";
        if (index == 0 || index < -state.m_vertices)
            return "face index " + std::to_string(index) + " is out of range (" + std::to_string(state.m_vertices) +
                   " vertices so far)";
        if (index > 0 && (state.m_largest.empty() || index > state.m_largest[0].m_vertex))
            state.m_largest.assign(1, {index, lineNumber});
    }
    return corners < 3 ? "a face has at least three corners" : "";
}

// Reads a line and those it continues on with a backslash; false at the end. `number` counts physical lines.
bool readLogicalLine(std::istringstream& text, std::string& line, std::size_t& number)
{
    std::string part;
    line.clear();
    bool any = false;
    while (std::getline(text, part))
    {
        any = true;
        ++number;
        if (!part.empty() && part.back() == '\r') part.pop_back();
        if (part.empty() || part.back() != '\\')
        {
            line += part;
            break;
        }
        part.back() = ' ';
        line += part;
    }
    return any;
}
}  // namespace

std::string coordinateProblem(double value)
{
    if (std::isnan(value)) return "coordinate is NaN";
    if (std::isinf(value)) return "coordinate is infinite";
    if (std::fabs(value) > std::numeric_limits<float>::max()) return "coordinate does not fit a float";
    return "";
}

std::string coordinateProblem(const std::string& word)
{
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (end == word.c_str() || *end != '\0') return "coordinate '" + word.substr(0, 32) + "' is not a number";
    return coordinateProblem(value);
}

std::string scanObj(const std::string& bytes)
{
    if (bytes.find('\0') != std::string::npos) return "not a mesh: an OBJ file is text, this one is binary";
    std::istringstream text(bytes);
    std::string line;
    std::size_t number = 0;
    ObjState state;
    if (bytes.compare(0, 3, kByteOrderMark) == 0)
        return "line 1: begins with a UTF-8 byte order mark, which hides what the line says; save the file without";
    while (readLogicalLine(text, line, number))
    {
        std::istringstream words(line.substr(0, line.find('#')));
        std::string keyword;
        words >> keyword;
        std::string problem;
        if (keyword == "v") problem = vertexProblem(words, state);
        if (keyword == "f") problem = faceProblem(words, state, number);
        if (!problem.empty()) return "line " + std::to_string(number) + ": " + problem;
    }
    if (!state.m_largest.empty() && state.m_largest[0].m_vertex > state.m_vertices)
        return "line " + std::to_string(state.m_largest[0].m_line) + ": face index " +
               std::to_string(state.m_largest[0].m_vertex) + " is out of range (" + std::to_string(state.m_vertices) +
               " vertices)";
    if (state.m_vertices == 0) return "not a mesh: no vertices";
    if (state.m_largest.empty() && bytes.find("\nf") == std::string::npos) return "no triangles";
    return "";
}

std::string objStructure(const std::string& bytes)
{
    std::istringstream text(bytes);
    std::string line, structure;
    std::size_t number = 0;
    long long vertices = 0;
    std::map<std::string, std::size_t> names;
    while (readLogicalLine(text, line, number))
    {
        std::istringstream words(line.substr(0, line.find('#')));
        std::string keyword, word;
        words >> keyword;
        if (keyword == "v") ++vertices;
        if (keyword == "o" || keyword == "g" || keyword == "usemtl")
        {
            const std::size_t name = names.emplace(words.str(), names.size()).first->second;
            structure += keyword + " " + std::to_string(name) + "\n";
        }
        if (keyword != "f" && keyword != "l" && keyword != "p") continue;
        structure += keyword;
        while (words >> word)
        {
            const long long index = std::strtoll(word.c_str(), nullptr, 10);
            structure += " " + std::to_string(index < 0 ? vertices + 1 + index : index);
        }
        structure += "\n";
    }
    return structure;
}
}  // namespace drape
