// A box tree over triangles in double precision, for the independent check: closest points, overlapping pairs,
// crossings.
//
// Built once per topology by median splits, refitted when vertices move. Queries return the exact set or the true
// minimum up to double rounding. Memory: about 130 bytes a triangle. Keeps a reference to nothing; positions are copied
// (m).
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "scenes/vector3.h"

namespace drape
{
enum class Feature : std::uint8_t
{
    OnFace,
    OnEdge,   // m_featureIndex: corner it starts from, 0 to 2
    OnVertex  // m_featureIndex: corner, 0 to 2
};

struct ClosestPoint
{
    double m_squaredDistance = 0;
    Vector3 m_point;
    std::int32_t m_triangle = -1;  // -1: nothing within the search radius
    Feature m_feature = Feature::OnFace;
    int m_featureIndex = 0;
};

class TriangleTree
{
public:
    TriangleTree(const float* positions, std::size_t vertexCount, const std::int32_t* triangles,
                 std::size_t triangleCount);

    // Takes new positions of the same vertices.
    void refit(const float* positions);

    // Returns the closest point of the surface within the squared radius (inclusive).
    ClosestPoint closest(const Vector3& point, double squaredRadius) const;

    // Calls visit(triangle) for each triangle whose box meets the box [low, high].
    void visitBox(const Vector3& low, const Vector3& high, const std::function<void(std::int32_t)>& visit) const;

    // Calls visit(own triangle, other's triangle) for each pair of triangles whose boxes meet.
    void visitPairs(const TriangleTree& other, const std::function<void(std::int32_t, std::int32_t)>& visit) const;

    void corners(std::int32_t triangle, Vector3 out[3]) const;
    const Vector3& vertex(std::int32_t index) const { return m_vertices[static_cast<std::size_t>(index)]; }
    const std::int32_t* indices(std::int32_t triangle) const
    {
        return &m_triangles[3 * static_cast<std::size_t>(triangle)];
    }
    std::size_t vertexCount() const { return m_vertices.size(); }
    std::size_t triangleCount() const { return m_triangles.size() / 3; }

    // The tree itself, for sums over far groups: nodes in depth-first order, root first, children after their parent.
    struct Node
    {
        Vector3 m_low, m_high;
        std::uint32_t m_right = 0;  // right child; the left one follows the node. 0: a leaf
        std::uint32_t m_first = 0;  // leaf: range in order()
        std::uint32_t m_count = 0;
    };
    const std::vector<Node>& nodes() const { return m_nodes; }
    const std::vector<std::int32_t>& order() const { return m_order; }

private:
    std::uint32_t build(std::uint32_t first, std::uint32_t count, const std::vector<Vector3>& centres);
    void fitLeaf(Node& node) const;
    void copyPositions(const float* positions);

    std::vector<Vector3> m_vertices;
    std::vector<std::int32_t> m_triangles;
    std::vector<std::int32_t> m_order;
    std::vector<Node> m_nodes;
};
}  // namespace drape
