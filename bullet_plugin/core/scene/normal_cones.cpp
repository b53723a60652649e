#include "normal_cones.h"

#include <algorithm>
#include <cmath>

#include "winding.h"

namespace drape
{
namespace
{
struct Direction
{
    double x = 0, y = 0, z = 0;

    void add(const Direction& other)
    {
        x += other.x;
        y += other.y;
        z += other.z;
    }
    double dot(const Direction& other) const { return x * other.x + y * other.y + z * other.z; }
    Direction times(int sign) const
    {
        Direction turned;
        turned.x = sign * x;
        turned.y = sign * y;
        turned.z = sign * z;
        return turned;
    }
    bool normalize()
    {
        const double length = std::sqrt(dot(*this));
        if (!(length > 1e-30) || !std::isfinite(length)) return false;
        x /= length;
        y /= length;
        z /= length;
        return true;
    }
};

// Zero for a triangle without area.
Direction unitNormal(const Triangle& triangle, const float* positions)
{
    double p[3][3];
    for (int i = 0; i < 3; ++i)
    {
        for (int k = 0; k < 3; ++k)
            p[i][k] = positions[3 * std::size_t(triangle.m_vertices[i]) + k];
    }
    const double u[3] = {p[1][0] - p[0][0], p[1][1] - p[0][1], p[1][2] - p[0][2]};
    const double v[3] = {p[2][0] - p[0][0], p[2][1] - p[0][1], p[2][2] - p[0][2]};
    Direction normal;
    normal.x = u[1] * v[2] - u[2] * v[1];
    normal.y = u[2] * v[0] - u[0] * v[2];
    normal.z = u[0] * v[1] - u[1] * v[0];
    return normal.normalize() ? normal : Direction();
}

// Accumulates normals around features: first their sum, then the least cosine to it.
class ConeBuilder
{
public:
    explicit ConeBuilder(std::size_t count) : m_axes(count), m_cosines(count, 1.0), m_open(count, false) {}

    void addNormal(std::size_t feature, const Direction& normal) { m_axes[feature].add(normal); }
    void open(std::size_t feature) { m_open[feature] = true; }
    void normalizeAxes()
    {
        for (std::size_t i = 0; i < m_axes.size(); ++i)
        {
            if (m_axes[i].normalize()) continue;
            m_axes[i] = Direction();
            m_open[i] = true;
        }
    }
    void widen(std::size_t feature, const Direction& normal)
    {
        m_cosines[feature] = std::min(m_cosines[feature], m_axes[feature].dot(normal));
    }
    NormalCone cone(std::size_t feature) const
    {
        // Two degrees for rounding, and more at sharper features: contacts are found at the predicted end of the step,
        // cloth turns while Bullet solves, and a sharp feature has no neighbours that would take over. Measured on
        // stairs: without the share a corner passed a face that turned by 20 degrees.
        constexpr double kPad = 0.035;
        constexpr double kTurnShare = 0.35;
        const Direction& axis = m_axes[feature];
        const double half = (1 + kTurnShare) * std::acos(std::clamp(m_cosines[feature], -1.0, 1.0)) + kPad;
        NormalCone cone = {{float(axis.x), float(axis.y), float(axis.z)}, -1.0f};
        if (!m_open[feature] && half < 1.5707) cone.m_cosine = float(std::cos(half));
        return cone;
    }

private:
    std::vector<Direction> m_axes;
    std::vector<double> m_cosines;
    std::vector<bool> m_open;
};

// Calls visit(vertex, its normal, edge, its normal) for each corner and the edge behind it: the triangle's normal,
// turned to the side that the first triangle there faces; zero where no side is known.
template <typename Visit>
void visitCorners(const Topology& topology, const WindingSigns& signs, const std::vector<Direction>& normals,
                  Visit visit)
{
    for (std::size_t t = 0; t < topology.m_triangles.size(); ++t)
    {
        for (int i = 0; i < 3; ++i)
        {
            visit(topology.m_triangles[t].m_vertices[i], normals[t].times(signs.atVertex(t, i)),
                  topology.m_triangles[t].m_edges[i], normals[t].times(signs.atEdge(t, i)));
        }
    }
}
}  // namespace

void computeNormalCones(const Topology& topology, const float* positions, std::vector<NormalCone>& vertexCones,
                        std::vector<NormalCone>& edgeCones)
{
    std::vector<Direction> normals;
    normals.reserve(topology.m_triangles.size());
    for (const Triangle& triangle : topology.m_triangles)
        normals.push_back(unitNormal(triangle, positions));

    const WindingSigns signs(topology);
    ConeBuilder vertices(topology.m_vertexCount), edges(topology.m_edges.size());
    visitCorners(topology, signs, normals,
                 [&](std::uint32_t vertex, const Direction& atVertex, std::uint32_t edge, const Direction& atEdge)
                 {
                     vertices.addNormal(vertex, atVertex);
                     edges.addNormal(edge, atEdge);
                     if (atVertex.dot(atVertex) == 0.0) vertices.open(vertex);
                     if (atEdge.dot(atEdge) == 0.0) edges.open(edge);
                 });
    vertices.normalizeAxes();
    edges.normalizeAxes();
    visitCorners(topology, signs, normals,
                 [&](std::uint32_t vertex, const Direction& atVertex, std::uint32_t edge, const Direction& atEdge)
                 {
                     vertices.widen(vertex, atVertex);
                     edges.widen(edge, atEdge);
                 });
    for (std::size_t e = 0; e < topology.m_edges.size(); ++e)
    {
        if (topology.m_edgeUses[e] == 2) continue;
        edges.open(e);
        vertices.open(topology.m_edges[e].m_vertices[0]);
        vertices.open(topology.m_edges[e].m_vertices[1]);
    }
    vertexCones.clear();
    edgeCones.clear();
    for (std::size_t v = 0; v < topology.m_vertexCount; ++v)
        vertexCones.push_back(vertices.cone(v));
    for (std::size_t e = 0; e < topology.m_edges.size(); ++e)
        edgeCones.push_back(edges.cone(e));
}
}  // namespace drape
