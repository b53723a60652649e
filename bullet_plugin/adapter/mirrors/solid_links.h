// Finds the links of a soft body that collide: those that are not part of a surface.
//
// A link is solid unless it is one of Bullet's bending links (btSoftBody::generateBendingConstraints), or both of its
// nodes lie on one surface: a connected set of faces and tetrahedra, which collides for them. All links of a rope are
// solid, the threads of a fringe, and links that join two pieces of cloth in one body, but no link across a cloth.
// Links that name another body's nodes are not solid. Input: the live body; faces as node indices. Cost: read() is
// almost linear in the body, changed() linear in the links that it checks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_plugin/core/solver/topology/node_groups.h"

namespace drape
{
constexpr int kForeign = -1;

// Returns the index of a node of the body; kForeign for a foreign node.
int nodeIndex(const btSoftBody& body, const btSoftBody::Node* node);

// Returns whether a body without faces and tetrahedra has a solid link.
bool hasSolidLink(const btSoftBody& body);

class SolidLinks
{
public:
    // faces: three nodes each; faces with a foreign node are no part of a surface.
    void read(const btSoftBody& body, const std::vector<std::int32_t>& faces);
    // Returns two nodes per link, in the body's order. None joins a node to itself.
    const std::vector<std::int32_t>& nodes() const { return m_nodes; }
    // Returns whether a link that would be solid names a node outside the body.
    bool hasForeign() const { return m_hasForeign; }
    // Returns whether the set of solid links differs from the one that was read. Checks all links if their number or
    // address changed or `all` is true. Otherwise each call checks some more, and the answer comes after the last of
    // them. The body's node count and faces must be unchanged.
    bool changed(const btSoftBody& body, bool all);

private:
    struct Ends
    {
        int m_a, m_b;
    };

    void joinSurfaces(const btSoftBody& body, const std::vector<std::int32_t>& faces);
    bool isSolid(Ends ends) const;
    std::uint64_t sumOf(const btSoftBody& body, int begin, int end) const;
    void remember(const btSoftBody& body);

    std::vector<std::int32_t> m_nodes;
    NodeGroups m_surfaces;     // the nodes of connected faces and tetrahedra
    std::uint64_t m_sum = 0;   // sumOf() over all links
    std::uint64_t m_seen = 0;  // sum over the links up to m_cursor
    int m_cursor = 0;
    int m_linkCount = 0, m_tetraCount = 0;
    const void* m_linkArray = nullptr;  // compared, never followed
    bool m_hasForeign = false;
};
}  // namespace drape
