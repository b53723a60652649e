#include "oracle/signed_surface.h"

#include <algorithm>
#include <unordered_map>

namespace drape
{
namespace
{
constexpr double kPi = 3.14159265358979323846;
// A group counts as a dipole beyond this many of its radii: winding errors stay below 0.05, the decision is at 0.5.
constexpr double kFar = 3.0;

double angleBetween(const Vector3& a, const Vector3& b)
{
    return std::atan2(length(cross(a, b)), dot(a, b));
}

std::uint64_t edgeKey(std::int32_t a, std::int32_t b)
{
    return (static_cast<std::uint64_t>(std::min(a, b)) << 32) | static_cast<std::uint32_t>(std::max(a, b));
}
}  // namespace

SignedSurface::SignedSurface(const TriangleMesh& mesh)
    : m_tree(mesh.m_positions.data(), mesh.vertexCount(), mesh.m_triangles.data(), mesh.triangleCount()),
      m_faceNormals(mesh.triangleCount()),
      m_vertexNormals(mesh.vertexCount()),
      m_edges(mesh.triangleCount()),
      m_boundaryVertex(mesh.vertexCount(), false),
      m_tangledVertex(mesh.vertexCount(), false)
{
    sumNormals();
    makeGroups();
}

void SignedSurface::sumNormals()
{
    std::unordered_map<std::uint64_t, EdgeSum> edges;
    double volume = 0;
    for (std::size_t t = 0; t < m_faceNormals.size(); ++t)
    {
        Vector3 c[3];
        m_tree.corners(static_cast<std::int32_t>(t), c);
        const std::int32_t* index = m_tree.indices(static_cast<std::int32_t>(t));
        const Vector3 normal = normalized(cross(c[1] - c[0], c[2] - c[0]));
        m_faceNormals[t] = normal;
        volume += dot(c[0], cross(c[1], c[2]));
        for (int i = 0; i < 3; ++i)
        {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            m_vertexNormals[static_cast<std::size_t>(index[i])] += angleBetween(c[j] - c[i], c[k] - c[i]) * normal;
            EdgeSum& edge = edges[edgeKey(index[i], index[j])];
            edge.m_normal += normal;
            edge.m_balance += index[i] < index[j] ? 1 : -1;
            ++edge.m_faces;
        }
    }
    for (std::size_t t = 0; t < m_edges.size(); ++t)
    {
        const std::int32_t* index = m_tree.indices(static_cast<std::int32_t>(t));
        for (int i = 0; i < 3; ++i)
        {
            m_edges[t][i] = edges[edgeKey(index[i], index[(i + 1) % 3])];
            const bool tangled = m_edges[t][i].m_faces > 2, boundary = m_edges[t][i].m_balance != 0;
            m_closed = m_closed && !boundary;
            for (const std::int32_t end : {index[i], index[(i + 1) % 3]})
            {
                if (tangled) m_tangledVertex[static_cast<std::size_t>(end)] = true;
                if (boundary) m_boundaryVertex[static_cast<std::size_t>(end)] = true;
            }
        }
    }
    if (m_closed && volume < 0) m_orientation = -1;
}

void SignedSurface::makeGroups()
{
    const std::vector<TriangleTree::Node>& nodes = m_tree.nodes();
    m_groups.resize(nodes.size());
    std::vector<double> areas(nodes.size(), 0);
    for (std::size_t i = nodes.size(); i-- > 0;)
    {
        Group& group = m_groups[i];
        Vector3 weighted;
        const auto add = [&](const Vector3& area, double size, const Vector3& centre)
        {
            group.m_area += area;
            areas[i] += size;
            weighted += size * centre;
        };
        if (nodes[i].m_right != 0)
            for (const std::size_t child : {i + 1, static_cast<std::size_t>(nodes[i].m_right)})
                add(m_groups[child].m_area, areas[child], m_groups[child].m_centre);
        else
            for (std::uint32_t k = nodes[i].m_first; k < nodes[i].m_first + nodes[i].m_count; ++k)
            {
                Vector3 c[3];
                m_tree.corners(m_tree.order()[k], c);
                const Vector3 area = 0.5 * cross(c[1] - c[0], c[2] - c[0]);
                add(area, length(area), (1.0 / 3) * (c[0] + c[1] + c[2]));
            }
        group.m_centre = areas[i] > 0 ? (1 / areas[i]) * weighted : 0.5 * (nodes[i].m_low + nodes[i].m_high);
        const Vector3 reach = {std::max(nodes[i].m_high.x - group.m_centre.x, group.m_centre.x - nodes[i].m_low.x),
                               std::max(nodes[i].m_high.y - group.m_centre.y, group.m_centre.y - nodes[i].m_low.y),
                               std::max(nodes[i].m_high.z - group.m_centre.z, group.m_centre.z - nodes[i].m_low.z)};
        group.m_radius = length(reach);
    }
}

double SignedSurface::solidAngle(const Vector3& point, std::int32_t triangle) const
{
    // Van Oosterom and Strackee 1983.
    Vector3 c[3];
    m_tree.corners(triangle, c);
    const Vector3 a = c[0] - point, b = c[1] - point, d = c[2] - point;
    const double la = length(a), lb = length(b), ld = length(d);
    return 2 * std::atan2(dot(a, cross(b, d)), la * lb * ld + dot(a, b) * ld + dot(b, d) * la + dot(d, a) * lb);
}

double SignedSurface::windingNumber(const Vector3& point) const
{
    const std::vector<TriangleTree::Node>& nodes = m_tree.nodes();
    double sum = 0;
    std::vector<std::uint32_t> stack(1, 0);
    while (!stack.empty())
    {
        const std::uint32_t i = stack.back();
        stack.pop_back();
        const Vector3 to = m_groups[i].m_centre - point;
        const double distance = length(to);
        if (distance > kFar * m_groups[i].m_radius)
            sum += dot(m_groups[i].m_area, to) / (distance * distance * distance);
        else if (nodes[i].m_right != 0)
            stack.insert(stack.end(), {nodes[i].m_right, i + 1});
        else
            for (std::uint32_t k = nodes[i].m_first; k < nodes[i].m_first + nodes[i].m_count; ++k)
                sum += solidAngle(point, m_tree.order()[k]);
    }
    return m_orientation * sum / (4 * kPi);
}

int SignedSurface::sideOf(const Vector3& point, const ClosestPoint& closest) const
{
    const auto triangle = static_cast<std::size_t>(closest.m_triangle);
    const Vector3 away = point - closest.m_point;
    Vector3 normal = m_faceNormals[triangle];
    if (closest.m_feature == Feature::OnEdge)
    {
        const EdgeSum& edge = m_edges[triangle][static_cast<std::size_t>(closest.m_featureIndex)];
        if (edge.m_balance != 0) return 0;
        normal = edge.m_normal;
    }
    if (closest.m_feature == Feature::OnVertex)
    {
        const auto vertex = static_cast<std::size_t>(m_tree.indices(closest.m_triangle)[closest.m_featureIndex]);
        if (m_boundaryVertex[vertex]) return 0;
        normal = m_vertexNormals[vertex];
    }
    return m_orientation * dot(normal, away) < 0 ? -1 : 1;
}

bool SignedSurface::simple(const ClosestPoint& closest) const
{
    const auto triangle = static_cast<std::size_t>(closest.m_triangle);
    const auto feature = static_cast<std::size_t>(closest.m_featureIndex);
    if (closest.m_feature == Feature::OnEdge) return m_edges[triangle][feature].m_faces == 2;
    if (closest.m_feature == Feature::OnFace) return true;
    return !m_tangledVertex[static_cast<std::size_t>(m_tree.indices(closest.m_triangle)[feature])];
}

bool SignedSurface::inside(const Vector3& point, const ClosestPoint& closest) const
{
    return (!simple(closest) || sideOf(point, closest) < 0) && windingNumber(point) > 0.5;
}
}  // namespace drape
