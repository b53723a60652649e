// Loads triangle meshes from OBJ, PLY, STL and glTF files.
//
// Polygons become triangles, and triangles that repeat a vertex are dropped, as are vertices without triangles.
// Positions are read in double precision and rounded to float once. Where a mesh lies so far from the origin that
// floats would keep fewer than an eighth of what they could, a centre is subtracted before: LoadReport says which, and
// how much the rounding changed. Damaged files are refused: false, and `error` holds one line with file, element
// (counted from 1) and reason. Each file is parsed once.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "scenes/mesh.h"

namespace drape
{
enum class Joining
{
    ByIndex,    // vertices are those of the file's indices; joined by position where a file has none, as STL
    ByPosition  // vertices at equal positions are joined: what a solid obstacle needs
};

struct LoadReport
{
    bool m_isJoined = false;           // true if vertices were joined by position, for any file
    std::array<double, 3> m_centre{};  // subtracted from all positions of all files, in their unit; often zero
    double m_rounding = 0;             // the largest change of a coordinate by rounding, in the files' unit
    std::vector<std::string> m_notes;  // parts that were left out or lost, one line each

    bool isCentred() const { return m_centre != std::array<double, 3>{}; }
};

bool loadMesh(const std::string& path, TriangleMesh& mesh, std::string& error);
bool loadMesh(const std::string& path, Joining joining, TriangleMesh& mesh, LoadReport& report, std::string& error);

// Loads two meshes in one frame: the same centre is subtracted from both.
bool loadMeshes(const std::string& firstPath, const std::string& secondPath, Joining joining, TriangleMesh& first,
                TriangleMesh& second, LoadReport& report, std::string& error);

// Loads a moving mesh. Both files have the same number of vertices and the same faces in the same order. `end` gets the
// positions at the end, x y z per vertex of the mesh. Vertices are joined if they are at one position in both files.
bool loadMotion(const std::string& startPath, const std::string& endPath, Joining joining, TriangleMesh& mesh,
                std::vector<float>& end, LoadReport& report, std::string& error);
bool loadMotion(const std::string& startPath, const std::string& endPath, TriangleMesh& mesh, std::vector<float>& end,
                std::string& error);
}  // namespace drape
