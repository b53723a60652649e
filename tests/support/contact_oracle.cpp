#include "tests/support/contact_oracle.h"

#include <algorithm>

namespace drape::test
{
namespace
{
struct Box
{
    Vector3 m_low{1e300, 1e300, 1e300}, m_high{-1e300, -1e300, -1e300};

    void add(const Vector3& p)
    {
        m_low = {std::min(m_low.x, p.x), std::min(m_low.y, p.y), std::min(m_low.z, p.z)};
        m_high = {std::max(m_high.x, p.x), std::max(m_high.y, p.y), std::max(m_high.z, p.z)};
    }
    bool apart(const Box& other, double reach) const
    {
        for (int axis = 0; axis < 3; ++axis)
        {
            if (m_low[axis] - other.m_high[axis] > reach || other.m_low[axis] - m_high[axis] > reach) return true;
        }
        return false;
    }
};

// A vertex, edge or triangle by its vertices, with what the conditions need.
struct Feature
{
    std::vector<std::uint32_t> m_vertices;
    std::vector<Vector3> m_points;
    Box m_box;
};

Feature makeFeature(const std::uint32_t* vertices, std::size_t count, const std::vector<float>& positions)
{
    Feature feature;
    for (std::size_t i = 0; i < count; ++i)
    {
        feature.m_vertices.push_back(vertices[i]);
        feature.m_points.push_back(position(positions, vertices[i]));
        feature.m_box.add(feature.m_points.back());
    }
    return feature;
}

// Vertices that some triangle uses, triangles, edges; indices as in the pool, unused vertices empty.
struct Features
{
    std::vector<Feature> m_vertices, m_triangles, m_edges;
};

Features makeFeatures(const Side& side, const std::vector<float>& positions)
{
    Features features;
    features.m_vertices.resize(side.m_pool.vertexCount());
    for (const Triangle& triangle : side.m_pool.triangles())
    {
        features.m_triangles.push_back(makeFeature(triangle.m_vertices, 3, positions));
        for (std::uint32_t vertex : triangle.m_vertices)
            features.m_vertices[vertex] = makeFeature(&vertex, 1, positions);
    }
    for (const Edge& edge : side.m_pool.edges())
        features.m_edges.push_back(makeFeature(edge.m_vertices, 2, positions));
    return features;
}

double extentOf(const Feature& cloth, const Feature& obstacle)
{
    double largest = 0;
    for (const Feature* feature : {&cloth, &obstacle})
    {
        for (const Vector3& p : feature->m_points)
            largest = std::max(largest, length(p - obstacle.m_points[0]));
    }
    return largest;
}

class Finder
{
public:
    Finder(const Side& cloth, const Side& obstacle, double reach)
        : m_clothSide(cloth),
          m_obstacleSide(obstacle),
          m_reach(reach * (1 - kReachMargin)),
          m_cloth(makeFeatures(cloth, cloth.m_end)),
          m_obstacle(makeFeatures(obstacle, obstacle.m_start)),
          m_cones(surfaceCones(obstacle.m_pool.triangles(), obstacle.m_pool.edges().size(), obstacle.m_start))
    {
    }

    std::vector<RequiredContact> run()
    {
        visit(m_cloth.m_vertices, m_obstacle.m_triangles, &Finder::nodeFace);
        visit(m_cloth.m_triangles, m_obstacle.m_vertices, &Finder::faceVertex);
        visit(m_cloth.m_edges, m_obstacle.m_edges, &Finder::edgeEdge);
        return std::move(m_found);
    }

private:
    using Test = void (Finder::*)(std::uint32_t, std::uint32_t);

    void visit(const std::vector<Feature>& cloth, const std::vector<Feature>& obstacle, Test test)
    {
        for (std::uint32_t i = 0; i < cloth.size(); ++i)
        {
            if (cloth[i].m_points.empty()) continue;
            for (std::uint32_t j = 0; j < obstacle.size(); ++j)
            {
                if (obstacle[j].m_points.empty() || cloth[i].m_box.apart(obstacle[j].m_box, m_reach)) continue;
                (this->*test)(i, j);
            }
        }
    }

    void nodeFace(std::uint32_t i, std::uint32_t j);
    void faceVertex(std::uint32_t i, std::uint32_t j);
    void edgeEdge(std::uint32_t i, std::uint32_t j);
    bool obstacleConeAdmits(std::uint32_t triangle, const double weights[3], const Vector3& direction) const;
    bool leansAwayBeyond(std::uint32_t edge, const Vector3& point, const Vector3& toObstacle) const;

    const Side& m_clothSide;
    const Side& m_obstacleSide;
    double m_reach;
    Features m_cloth, m_obstacle;
    SurfaceCones m_cones;
    std::vector<RequiredContact> m_found;
};

// Zeros are corners that a closest point does not use; the others must keep the margin.
bool keepsWeightMargin(const double weights[3])
{
    return std::all_of(weights, weights + 3, [](double w) { return w == 0 || w > kWeightMargin; });
}

// A thin triangle's weights are ill-conditioned.
bool isFat(const Feature& triangle)
{
    const Vector3 u = triangle.m_points[1] - triangle.m_points[0], v = triangle.m_points[2] - triangle.m_points[0];
    const double longest = std::max({length(u), length(v), length(u - v)});
    return length(cross(u, v)) > kSineMargin * longest * longest;
}

bool Finder::obstacleConeAdmits(std::uint32_t triangle, const double weights[3], const Vector3& direction) const
{
    const Triangle& t = m_obstacleSide.m_pool.triangles()[triangle];
    for (int i = 0; i < 3; ++i)
    {
        if (weights[i] == 1) return m_cones.m_vertices[t.m_vertices[i]].admits(direction);
    }
    for (int i = 0; i < 3; ++i)
    {
        // Edge (i + 1) % 3 lies opposite of corner i.
        if (weights[i] == 0) return m_cones.m_edges[t.m_edges[(i + 1) % 3]].admits(direction);
    }
    return true;
}

void Finder::nodeFace(std::uint32_t i, std::uint32_t j)
{
    const Feature &node = m_cloth.m_vertices[i], &face = m_obstacle.m_triangles[j];
    const NearestOnTriangle nearest = nearestOnTriangle(node.m_points[0], face.m_points.data());
    const double size = extentOf(node, face);
    if (nearest.m_distance > m_reach || nearest.m_distance < kTouchMargin * size || !isFat(face)) return;
    const int zeros = int(std::count(nearest.m_weights, nearest.m_weights + 3, 0.0));
    const Vector3 normal = (1 / nearest.m_distance) * (node.m_points[0] - nearest.m_point);
    if (!keepsWeightMargin(nearest.m_weights)) return;
    if (zeros > 0 && !obstacleConeAdmits(j, nearest.m_weights, normal)) return;
    m_found.push_back({DRAPE_NODE_FACE, i, j, nearest.m_distance, size, normal});
}

bool Finder::leansAwayBeyond(std::uint32_t edge, const Vector3& point, const Vector3& toObstacle) const
{
    for (std::uint32_t opposite : m_clothSide.m_pool.edges()[edge].m_opposite)
    {
        if (dot(toObstacle, position(m_clothSide.m_end, opposite) - point) > 0) return false;
    }
    return true;
}

void Finder::faceVertex(std::uint32_t i, std::uint32_t j)
{
    const Feature &face = m_cloth.m_triangles[i], &vertex = m_obstacle.m_vertices[j];
    const NearestOnTriangle nearest = nearestOnTriangle(vertex.m_points[0], face.m_points.data());
    const double size = extentOf(face, vertex);
    if (nearest.m_distance > m_reach || nearest.m_distance < kTouchMargin * size || !isFat(face)) return;
    const int zeros = int(std::count(nearest.m_weights, nearest.m_weights + 3, 0.0));
    if (zeros == 2 || !keepsWeightMargin(nearest.m_weights)) return;
    const Vector3 normal = (1 / nearest.m_distance) * (nearest.m_point - vertex.m_points[0]);
    if (!m_cones.m_vertices[j].admits(normal)) return;
    if (zeros == 1)
    {
        const int unused = int(std::find(nearest.m_weights, nearest.m_weights + 3, 0.0) - nearest.m_weights);
        const std::uint32_t edge = m_clothSide.m_pool.triangles()[i].m_edges[(unused + 1) % 3];
        if (!leansAwayBeyond(edge, nearest.m_point, -1 * normal)) return;
    }
    m_found.push_back({DRAPE_FACE_VERTEX, i, j, nearest.m_distance, size, normal});
}

void Finder::edgeEdge(std::uint32_t i, std::uint32_t j)
{
    const Feature &cloth = m_cloth.m_edges[i], &obstacle = m_obstacle.m_edges[j];
    const NearestOnSegments nearest =
        nearestOnSegments(cloth.m_points[0], cloth.m_points[1], obstacle.m_points[0], obstacle.m_points[1]);
    const double size = extentOf(cloth, obstacle);
    if (nearest.m_distance > m_reach || nearest.m_distance < kTouchMargin * size) return;
    for (double parameter : {nearest.m_first, nearest.m_second})
    {
        if (parameter < kWeightMargin || parameter > 1 - kWeightMargin) return;
    }
    const Vector3 u = cloth.m_points[1] - cloth.m_points[0], v = obstacle.m_points[1] - obstacle.m_points[0];
    if (length(cross(u, v)) < kSineMargin * length(u) * length(v)) return;
    const Vector3 normal = (1 / nearest.m_distance) * (nearest.m_firstPoint - nearest.m_secondPoint);
    if (!m_cones.m_edges[j].admits(normal)) return;
    m_found.push_back({DRAPE_EDGE_EDGE, i, j, nearest.m_distance, size, normal});
}

// The features that a contact names.
struct FeaturePair
{
    Feature m_cloth, m_obstacle;
};

FeaturePair featuresOf(const Contact& contact, const Side& cloth, const Side& obstacle)
{
    const std::uint32_t i = contact.m_clothFeature, j = contact.m_obstacleFeature;
    if (contact.m_kind == DRAPE_NODE_FACE)
    {
        return {makeFeature(&i, 1, cloth.m_end),
                makeFeature(obstacle.m_pool.triangles()[j].m_vertices, 3, obstacle.m_start)};
    }
    if (contact.m_kind == DRAPE_FACE_VERTEX)
    {
        return {makeFeature(cloth.m_pool.triangles()[i].m_vertices, 3, cloth.m_end),
                makeFeature(&j, 1, obstacle.m_start)};
    }
    return {makeFeature(cloth.m_pool.edges()[i].m_vertices, 2, cloth.m_end),
            makeFeature(obstacle.m_pool.edges()[j].m_vertices, 2, obstacle.m_start)};
}

}  // namespace

std::vector<RequiredContact> requiredContacts(const Side& cloth, const Side& obstacle, double reach)
{
    return Finder(cloth, obstacle, reach).run();
}

Vector3 contactOffset(const Contact& contact, const Side& cloth, const Side& obstacle)
{
    const FeaturePair pair = featuresOf(contact, cloth, obstacle);
    const std::vector<Vector3>&p = pair.m_cloth.m_points, &q = pair.m_obstacle.m_points;
    if (contact.m_kind == DRAPE_NODE_FACE) return p[0] - nearestOnTriangle(p[0], q.data()).m_point;
    if (contact.m_kind == DRAPE_FACE_VERTEX) return nearestOnTriangle(q[0], p.data()).m_point - q[0];
    const NearestOnSegments nearest = nearestOnSegments(p[0], p[1], q[0], q[1]);
    return nearest.m_firstPoint - nearest.m_secondPoint;
}

double contactDistance(const Contact& contact, const Side& cloth, const Side& obstacle)
{
    return length(contactOffset(contact, cloth, obstacle));
}

double contactExtent(const Contact& contact, const Side& cloth, const Side& obstacle)
{
    const FeaturePair pair = featuresOf(contact, cloth, obstacle);
    return extentOf(pair.m_cloth, pair.m_obstacle);
}

bool sameFeatures(const RequiredContact& required, const Contact& contact)
{
    return required.m_kind == contact.m_kind && required.m_clothFeature == contact.m_clothFeature &&
           required.m_obstacleFeature == contact.m_obstacleFeature;
}
}  // namespace drape::test
