// Counts the pairs that leafPairsOnHost() would visit, without visiting them: exact, in 64 bits.
//
// Intended for queries with possibly more pairs than can be tested. Subtrees whose leaves all overlap each other
// count at once, and so do the triangles around a vertex. A crowd of coincident triangles therefore costs little more
// than its hierarchy. Otherwise the cost is that of a traversal. Host only.
#pragma once

#include <cstdint>

#include "self_collision.h"

namespace drape
{
// kind: DRAPE_WALK_…, with a and b the same tree for a mesh with itself.
std::uint64_t countLeafPairs(const HostTree& a, const HostTree& b, std::uint32_t kind);

// Returns the count if it exceeds the limit, else 0. Costs nothing if so few leaves cannot have more.
std::uint64_t leafPairsBeyond(const HostTree& a, const HostTree& b, std::uint32_t kind, std::uint64_t limit);
}  // namespace drape
