// Lists a cloth's faces and the faces of each node. A link that collides counts as a face that repeats its second
// node. Cost: O(n) per topology.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "revision.h"

namespace drape
{
class ClothFaces
{
public:
    ClothFaces() = default;
    // triangles: three nodes each. A triangle with a node outside [0, nodeCount) is no face of any node.
    ClothFaces(std::vector<std::int32_t> triangles, std::size_t nodeCount)
        : m_revision(newRevision()), m_triangles(std::move(triangles)), m_firsts(nodeCount + 2, 0)
    {
        forValid([this](std::size_t node, std::size_t) { ++m_firsts[node + 2]; });
        for (std::size_t i = 2; i < m_firsts.size(); ++i)
            m_firsts[i] += m_firsts[i - 1];
        m_facesOfNode.resize(m_firsts.back());
        // A node's entry of m_firsts is the position for its next face while faces are added. Afterwards it is where
        // the next node's faces begin.
        forValid([this](std::size_t node, std::size_t face)
                 { m_facesOfNode[m_firsts[node + 1]++] = static_cast<std::uint32_t>(face); });
    }

    std::size_t nodeCount() const { return m_firsts.empty() ? 0 : m_firsts.size() - 2; }
    // Differs from that of all other lists, except for copies.
    std::uint64_t revision() const { return m_revision; }
    // By node, the position of its first face in facesOfNodes(); then the last one's end.
    const std::size_t* firsts() const { return m_firsts.data(); }
    const std::vector<std::uint32_t>& facesOfNodes() const { return m_facesOfNode; }
    // Three nodes each.
    const std::vector<std::int32_t>& triangles() const { return m_triangles; }

    // Calls visit(nodes) for each face of the node, with the face's three nodes; twice for a face that repeats the
    // node.
    template <class Visit>
    void forFacesOf(std::size_t node, const Visit& visit) const
    {
        for (std::size_t i = m_firsts[node]; i < m_firsts[node + 1]; ++i)
            visit(&m_triangles[3 * std::size_t(m_facesOfNode[i])]);
    }

private:
    // Calls visit(node, face) for the nodes of each face whose three nodes are valid.
    template <class Visit>
    void forValid(const Visit& visit) const
    {
        const auto isNode = [this](std::int32_t node) { return node >= 0 && std::size_t(node) < nodeCount(); };
        for (std::size_t i = 0; i + 2 < m_triangles.size(); i += 3)
        {
            const std::int32_t* const face = &m_triangles[i];
            for (int k = 0; k < 3 && std::all_of(face, face + 3, isNode); ++k)
                visit(std::size_t(face[k]), i / 3);
        }
    }

    std::uint64_t m_revision = 0;
    std::vector<std::int32_t> m_triangles;
    std::vector<std::size_t> m_firsts;  // by node, index in m_facesOfNode; then the last one's end, twice
    std::vector<std::uint32_t> m_facesOfNode;
};
}  // namespace drape
