// Pairs of triangles of which it is known whether they meet, by exact arithmetic that shares no code with Drape's
// (oracle/exact_predicates.h). The same seed gives the same set. Metres.
#pragma once

#include <string>
#include <vector>

#include "kernels/shared/query.h"

namespace drape::bench
{
struct TriangleSet
{
    std::string m_name;
    std::vector<TriangleQuery> m_queries;
    std::vector<bool> m_truth;
};

// Triangles of a centimetre: in any position to one another, near the origin and 100 m from it; and as layers of cloth
// lie, nearly parallel and a millimetre apart, of which none meet.
std::vector<TriangleSet> makeTriangleSets(std::size_t pairs);
}  // namespace drape::bench
