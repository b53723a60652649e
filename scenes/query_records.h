// Files of queries with their true answers. Little-endian, tightly packed, no header.
//
// Motions have 104 bytes each. 24 floats hold four points at the step's start and the four at its end. Two int32
// follow: the kind (0 vertex-face: point, triangle; 1 edge-edge: edge, edge), and 1 if they touch during the step.
// Triangle pairs have 76 bytes each: 18 floats (two triangles), int32 1 if they share a point. A file with an error is
// refused. The reader returns false, and `error` names file, record (counted from 1) and reason in one line.
#pragma once

#include <string>
#include <vector>

#include "kernels/shared/query.h"

namespace drape
{
struct MotionRecords
{
    std::vector<CcdQuery> m_queries;
    std::vector<bool> m_truth;
};

struct TriangleRecords
{
    std::vector<TriangleQuery> m_queries;
    std::vector<bool> m_truth;
};

bool readRecords(const std::string& path, MotionRecords& records, std::string& error);
bool readRecords(const std::string& path, TriangleRecords& records, std::string& error);
}  // namespace drape
