#include <cstdint>
#include <sstream>

#include "scenes/mesh_scan.h"

namespace drape
{
namespace
{
constexpr std::size_t kHeaderBytes = 80, kCountBytes = 4, kTriangleBytes = 50;

bool isBinary(const std::string& bytes, std::size_t& triangles)
{
    if (bytes.size() < kHeaderBytes + kCountBytes) return false;
    std::uint32_t count = 0;
    for (std::size_t i = kCountBytes; i-- > 0;)
        count = count << 8 | static_cast<unsigned char>(bytes[kHeaderBytes + i]);
    triangles = count;
    // Some begin with "solid" all the same; text has no zero bytes, and a file of the length it says is what it says.
    return bytes.size() == kHeaderBytes + kCountBytes + triangles * kTriangleBytes ||
           bytes.find('\0') != std::string::npos;
}

// Of one line of a facet: what it must be, and its three numbers.
std::string vertexProblem(std::istringstream& line)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        std::string word;
        const std::string problem = line >> word ? coordinateProblem(word) : "has fewer than three coordinates";
        if (!problem.empty()) return problem;
    }
    return "";
}

std::string scanText(const std::string& bytes)
{
    std::istringstream text(bytes);
    std::size_t number = 0, facet = 0;
    int vertices = -1;  // of the facet that is open
    bool ended = false;
    for (std::string line; std::getline(text, line);)
    {
        ++number;
        std::istringstream words(line);
        std::string keyword, problem;
        words >> keyword;
        if (keyword == "facet")
        {
            if (vertices >= 0) problem = "begins before the one before has ended";
            ++facet;
            vertices = 0;
        }
        else if (keyword == "vertex")
        {
            ++vertices;
            problem = vertexProblem(words);
        }
        else if (keyword == "endfacet")
        {
            if (vertices != 3) problem = "has " + std::to_string(vertices < 0 ? 0 : vertices) + " vertices, not 3";
            vertices = -1;
        }
        ended = (ended || keyword == "endsolid") && keyword != "facet";
        if (!problem.empty())
            return "line " + std::to_string(number) + ": facet " + std::to_string(facet) + " " + problem;
    }
    if (facet > 0 && !ended)
        return "the file ends too early, after " + std::to_string(facet) + " facets, without endsolid";
    return facet == 0 ? "not a mesh: no facets" : "";
}
}  // namespace

std::string scanStl(const std::string& bytes)
{
    std::size_t triangles = 0;
    if (!isBinary(bytes, triangles)) return scanText(bytes);
    const std::size_t wanted = kHeaderBytes + kCountBytes + triangles * kTriangleBytes;
    if (bytes.size() == wanted) return "";
    return "says " + std::to_string(triangles) + " triangles, which take " + std::to_string(wanted) +
           " bytes where there are " + std::to_string(bytes.size());
}
}  // namespace drape
