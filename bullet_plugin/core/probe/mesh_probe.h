// A triangle mesh at rest that answers queries: which of its triangles another triangle meets, where its surface is
// nearest and, if it is closed, which points are inside.
//
// Input: a mesh's topology, the leaf order of its triangles and its positions; all are copied. Guarantee: meetings
// and insides are decided in exact arithmetic on the float positions. The exception is a point from which every
// ray runs into an edge: it counts as outside.
//
// Every edge of a closed mesh has an even number of triangles. Vertices at one position, up to a millionth of the
// mesh's size, count as one. The parity of crossings is then the same along every ray that misses such a seam,
// whatever the triangles' winding. Cost: O(n) to build; O(log n) per query beside few triangles. Host only. Lengths
// in metres.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "bullet_plugin/core/scene/topology.h"
#include "drape/mesh_description.h"
#include "kernels/shared/types.h"

namespace drape
{
class MeshProbe
{
public:
    MeshProbe(const Topology& topology, const std::vector<std::uint32_t>& order, const std::vector<float>& positions);
    // The description's indices are in range.
    explicit MeshProbe(const MeshDescription& mesh);

    // Sets other positions of the same number of vertices.
    void move(const std::vector<float>& positions);
    // Return the largest displacement of a vertex to other positions, m, and the largest extent of the box.
    float mostMotion(const std::vector<float>& positions) const;
    float size() const;

    // Lists the triangles that have a point in common with the given one, in ascending order; none if a corner is not
    // finite or beyond 2^30 m.
    void listMeeting(const Vec3 corners[3], std::vector<std::uint32_t>& triangles) const
    {
        listMeeting(corners, triangles, [](std::uint32_t) { return true; });
    }
    // Lists only triangles for which takes(triangle) is true.
    void listMeeting(const Vec3 corners[3], std::vector<std::uint32_t>& triangles,
                     const std::function<bool(std::uint32_t)>& takes) const;
    // Returns corner i of a triangle, m.
    Vec3 corner(std::uint32_t triangle, int i) const;
    // Computes the mean of the points at which the given triangle's edges pass through the listed triangles, and their
    // edges through it. Returns false if there are none: all lie in one plane.
    bool middleOfMeeting(const Vec3 corners[3], const std::vector<std::uint32_t>& triangles, Vec3& middle) const;

    // Returns the sum of the listed triangles' unit normals, each on the point's side.
    Vec3 sumOfNormals(const std::vector<std::uint32_t>& triangles, Vec3 point) const;

    // Returns the axis, or its opposite, along which points leave the mesh's box soonest; unit.
    Vec3 directionOutOfBox(const std::vector<Vec3>& points) const;

    // Returns whether the mesh is closed. The first call determines it, O(n log n).
    bool isClosed();
    // Returns the volume that a closed mesh encloses, m³; negative if its triangles face inwards.
    double volume() const;
    // The mesh is closed.
    bool isInside(Vec3 point) const;
    // Returns the surface's nearest point. The mesh must have triangles.
    Vec3 nearest(Vec3 point) const;
    // A point of the surface: the weights of a triangle's corners, and its distance, m.
    struct Place
    {
        std::uint32_t m_triangle;
        Vec3 m_weights;
        float m_distance;
    };
    // Finds the nearest point within the distance; returns false if there is none.
    bool nearestWithin(Vec3 point, float distance, Place& place) const;
    // Moves a point along with its surface point to the vertices' other positions, turned as the triangle turns.
    Vec3 carriedWith(const Place& place, Vec3 point, const std::vector<float>& positions) const;

private:
    enum class Closed
    {
        Unknown,
        Yes,
        No
    };
    struct Box
    {
        Vec3 m_low, m_high;
    };
    // A node of the tree over the triangles, with an exact box and the links of BvhNode.
    struct Node
    {
        float m_low[3], m_high[3];  // m; low above high if no vertex is valid
        std::uint32_t m_first, m_count;
    };

    void build(const std::vector<std::uint32_t>& order);
    void refit();
    static double squaredDistance(const Node& node, Vec3 point);
    template <class Visit>
    void forTrianglesIn(const Box& box, const Visit& visit) const;
    bool countCrossings(Vec3 point, Vec3 target, unsigned& crossings) const;

    std::vector<Triangle> m_triangles;
    std::vector<float> m_positions;
    std::vector<std::uint32_t> m_order;
    std::uint32_t m_root = 0;
    std::vector<Node> m_nodes;  // children before parents
    Closed m_closed = Closed::Unknown;
};
}  // namespace drape
