// How many candidates each cloth has, without listing them: exact, in 64 bits.
//
// For a step that has more candidates than it may list. Subtrees whose leaves all overlap each other count at once, so
// a crowd of coincident triangles, the case that reaches the limit, costs little more than its hierarchies. Otherwise
// it costs as much as a traversal. Host only.
#pragma once

#include <cstdint>
#include <vector>

#include "broad_phase.h"

namespace drape
{
// thickness as in HostTraversal::run. Returns a count per cloth slot.
std::vector<std::uint64_t> countCandidates(const BroadPhaseSide& cloth, const BroadPhaseSide& obstacle,
                                           const std::vector<float>& thickness, std::size_t clothMeshes,
                                           std::size_t obstacleMeshes);
}  // namespace drape
