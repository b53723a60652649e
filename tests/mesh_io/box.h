// A box from −1 to 1 as text and numbers, for files of every format.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "mesh_io/mesh_file.h"

namespace drape::test
{
constexpr int kBoxVertices[8][3] = {{-1, -1, 1}, {-1, -1, -1}, {-1, 1, -1}, {-1, 1, 1},
                                    {1, -1, 1},  {1, -1, -1},  {1, 1, -1},  {1, 1, 1}};
constexpr int kBoxTriangles[12][3] = {{3, 2, 1}, {3, 1, 0}, {1, 5, 4}, {1, 4, 0}, {2, 6, 5}, {2, 5, 1},
                                      {7, 6, 2}, {7, 2, 3}, {4, 7, 3}, {4, 3, 0}, {5, 6, 7}, {5, 7, 4}};

// Returns the corners of the triangles in the order of m_corners.
inline std::vector<std::int32_t> boxCorners()
{
    std::vector<std::int32_t> corners;
    for (const auto& triangle : kBoxTriangles)
        corners.insert(corners.end(), triangle, triangle + 3);
    return corners;
}

// Returns a line for each vertex: prefix, x y z, suffix.
inline std::string boxVertexLines(const std::string& prefix, const std::string& suffix = "\n")
{
    std::string text;
    for (const auto& v : kBoxVertices)
        text += prefix + std::to_string(v[0]) + " " + std::to_string(v[1]) + " " + std::to_string(v[2]) + suffix;
    return text;
}

// Returns a line for each triangle: prefix, its indices from `base` on, suffix. '%' in `corner` stands for an index.
inline std::string boxFaceLines(const std::string& prefix, int base, const std::string& corner = "%",
                                const std::string& suffix = "\n")
{
    std::string text;
    for (const auto& triangle : kBoxTriangles)
    {
        text += prefix;
        for (int index : triangle)
        {
            text += " ";
            for (const char c : corner)
                text += c == '%' ? std::to_string(index + base) : std::string(1, c);
        }
        text += suffix;
    }
    return text;
}

// Returns the bytes of a number, least first or most first.
template <typename T>
std::string bytesOf(T value, bool bigEndian = false)
{
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    return bigEndian ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to)
{
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
    return text;
}

// Expects the box with the vertices and faces of this header, in their order.
inline void expectIsBox(const MeshFile& mesh)
{
    EXPECT_EQ(mesh.m_corners, boxCorners());
    EXPECT_EQ(mesh.vertexCount(), 8u);
    for (std::size_t i = 0; i < mesh.m_positions.size() && i < 24; ++i)
        EXPECT_EQ(mesh.m_positions[i], kBoxVertices[i / 3][i % 3]);
}

// Expects a reason that has all of the words.
inline void expectProblem(const std::string& problem, const std::vector<std::string>& words)
{
    EXPECT_NE(problem, "");
    for (const std::string& word : words)
        EXPECT_NE(problem.find(word), std::string::npos) << problem;
}
}  // namespace drape::test
