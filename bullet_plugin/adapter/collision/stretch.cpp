#include "bullet_plugin/adapter/collision/stretch.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "BulletSoftBody/btSoftBody.h"

namespace drape
{
namespace
{
// Rest lengths of links that do not bend.
std::vector<btScalar> lengthsAtRest(const btSoftBody& body)
{
    std::vector<btScalar> lengths;
    for (int i = 0; i < body.m_links.size(); ++i)
        if (!body.m_links[i].m_bbending) lengths.push_back(body.m_links[i].m_rl);
    return lengths;
}

// Returns the largest ratio of a link's length to its rest length. A quarter of the unit replaces a shorter rest
// length.
template <class Place>
btScalar longestLink(const btSoftBody& body, btScalar unit, const Place& place)
{
    btScalar longest = 0;
    for (int i = 0; i < body.m_links.size(); ++i)
    {
        const btSoftBody::Link& link = body.m_links[i];
        const auto indexOf = [&](const btSoftBody::Node* node) { return std::size_t(node - &body.m_nodes[0]); };
        const std::size_t a = indexOf(link.m_n[0]), b = indexOf(link.m_n[1]);
        const std::size_t count = std::size_t(body.m_nodes.size());
        if (link.m_bbending || a >= count || b >= count) continue;
        const btScalar times = (place(a) - place(b)).length() / std::max(link.m_rl, unit / 4);
        if (!(times <= longest)) longest = times > longest ? times : SIMD_INFINITY;
    }
    return longest;
}

// place: returns a node's position by its index. NaN counts as infinitely far.
template <class Place>
btScalar longestEdge(const ClothFaces& faces, const Place& place)
{
    btScalar longest2 = 0;
    const std::vector<std::int32_t>& nodes = faces.triangles();
    const auto isNode = [&](std::int32_t node) { return node >= 0 && std::size_t(node) < faces.nodeCount(); };
    for (std::size_t first = 0; first + 2 < nodes.size(); first += 3)
    {
        for (std::size_t k = 0; k < 3; ++k)
        {
            const std::int32_t a = nodes[first + k], b = nodes[first + (k + 1) % 3];
            if (!isNode(a) || !isNode(b)) continue;
            const btScalar length2 = (place(std::size_t(a)) - place(std::size_t(b))).length2();
            if (!(length2 <= longest2)) longest2 = length2 > longest2 ? length2 : SIMD_INFINITY;
        }
    }
    return btSqrt(longest2);
}

// Takes the movable nodes whose motion is finite.
btVector3 medianMotion(const btSoftBody& body, const SolverNodes& nodes)
{
    std::vector<btVector3> motions;
    for (std::size_t i = 0; i < nodes.count(); ++i)
    {
        const btVector3 motion = body.m_nodes[static_cast<int>(i)].m_x - vectorOf(nodes.start(i));
        if (nodes.inverseMass(i) > 0 && motion.length2() < SIMD_INFINITY) motions.push_back(motion);
    }
    return medianOf(std::move(motions));
}
}  // namespace

btVector3 medianOf(std::vector<btVector3> vectors)
{
    btVector3 median(0, 0, 0);
    for (int axis = 0; axis < 3 && !vectors.empty(); ++axis)
    {
        const auto middle = vectors.begin() + std::ptrdiff_t(vectors.size() / 2);
        std::nth_element(vectors.begin(), middle, vectors.end(),
                         [axis](const btVector3& a, const btVector3& b) { return a[axis] < b[axis]; });
        median[axis] = (*middle)[axis];
    }
    return median;
}

btScalar unitOf(const btSoftBody& body, const ClothFaces& faces, const SolverNodes& nodes)
{
    std::vector<btScalar> rest = lengthsAtRest(body);
    if (rest.empty()) return longestEdge(faces, [&](std::size_t node) { return vectorOf(nodes.start(node)); });
    const auto middle = rest.begin() + std::ptrdiff_t(rest.size() / 2);
    std::nth_element(rest.begin(), middle, rest.end());
    return *middle;
}

Stretch stretchOf(const btSoftBody& body, const ClothFaces& faces, const SolverNodes& nodes)
{
    const btScalar unit = unitOf(body, faces, nodes);
    const auto start = [&](std::size_t node) { return vectorOf(nodes.start(node)); };
    const auto end = [&](std::size_t node) { return body.m_nodes[static_cast<int>(node)].m_x; };
    if (!(unit > 0)) return {1, 1};
    if (!lengthsAtRest(body).empty()) return {longestLink(body, unit, start), longestLink(body, unit, end)};
    return {longestEdge(faces, start) / unit, longestEdge(faces, end) / unit};
}

void holdTogether(btSoftBody& body, const ClothFaces& faces, const SolverNodes& nodes)
{
    const btScalar most = unitOf(body, faces, nodes) / 2;
    const btVector3 common = medianMotion(body, nodes);
    const btScalar velocityScale = body.m_sst.isdt * (1 - body.m_cfg.kDP);
    for (std::size_t i = 0; i < nodes.count(); ++i)
    {
        btSoftBody::Node& node = body.m_nodes[static_cast<int>(i)];
        const btVector3 own = node.m_x - vectorOf(nodes.start(i)) - common;
        const btScalar length = own.length();
        if (!(nodes.inverseMass(i) > 0) || !(length > most) || !(length < SIMD_INFINITY)) continue;
        const btVector3 shift = own * (most / length - 1);
        node.m_x += shift;
        node.m_v += shift * velocityScale;
    }
}
}  // namespace drape
