// A mesh with the contents of a file: vertices in double precision and polygons of vertex indices. The readers fill it.
//
// Nothing is merged, reordered, centred or rounded. Indices are valid once readMeshFile() has returned the mesh.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace drape
{
// The most vertices of a file: indices are signed 32-bit numbers.
constexpr std::size_t kMostVertices = std::numeric_limits<std::int32_t>::max();

struct MeshFile
{
    std::vector<double> m_positions;      // x y z per vertex, in the file's unit
    std::vector<std::int32_t> m_corners;  // zero-based vertex indices, face after face
    std::vector<std::size_t> m_faceEnds;  // for each face, one past its last corner in m_corners
    bool m_hasIndices = true;             // false: each face has vertices of its own, as in STL
    std::vector<std::string> m_notes;     // parts that were left out or cannot be represented, one line each

    std::size_t vertexCount() const { return m_positions.size() / 3; }
    std::size_t faceCount() const { return m_faceEnds.size(); }
    std::size_t faceStart(std::size_t face) const { return face == 0 ? 0 : m_faceEnds[face - 1]; }

    void addVertex(double x, double y, double z) { m_positions.insert(m_positions.end(), {x, y, z}); }
    void addTriangle(std::int32_t a, std::int32_t b, std::int32_t c)
    {
        m_corners.insert(m_corners.end(), {a, b, c});
        m_faceEnds.push_back(m_corners.size());
    }
    // Ends the face whose corners have been appended to m_corners. Returns false and removes them if there are fewer
    // than three: such a face has no surface.
    bool endFace()
    {
        const std::size_t start = faceStart(faceCount());
        const bool good = m_corners.size() - start >= 3;
        if (good)
            m_faceEnds.push_back(m_corners.size());
        else
            m_corners.resize(start);
        return good;
    }
};

// Returns "3 faces" or "1 face".
inline std::string counted(std::size_t count, const std::string& noun)
{
    return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

// Adds a note about the faces that endFace() removed, if any.
inline void noteShortFaces(std::size_t count, MeshFile& mesh)
{
    if (count > 0) mesh.m_notes.push_back(counted(count, "face") + " with fewer than three corners left out");
}
}  // namespace drape
