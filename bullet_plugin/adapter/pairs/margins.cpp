#include "bullet_plugin/adapter/pairs/margins.h"

#include <cstdio>

#include "bullet_plugin/adapter/mirrors/mesh_reader.h"

namespace drape
{
namespace
{
// Maximum and minimum thickness, in mean edge lengths of the cloth. docs/tuning.md advises one at most; Bullet's
// default margin of 0.25 m gives 3.6 to a patch of 2 m with 33 x 33 nodes. The project's own scenes have less than one.
constexpr double kMostEdges = 2;
constexpr double kLeastEdges = 0.005;

// Maximum thickness, in mean edge lengths of the mesh. The project's finest mesh, a dragon, has 4.7.
constexpr double kMostMeshEdges = 8;

constexpr char kMargins[] = "the margins of the soft body and of the obstacle";

// Returns the mean length of the body's face edges, or of its links if it has no faces.
double meanEdgeOf(const btSoftBody& cloth)
{
    double sum = 0;
    for (int i = 0; cloth.m_faces.size() == 0 && i < cloth.m_links.size(); ++i)
        sum += double((cloth.m_links[i].m_n[0]->m_x - cloth.m_links[i].m_n[1]->m_x).length());
    if (cloth.m_faces.size() == 0) return sum / std::max(1, cloth.m_links.size());
    for (int f = 0; f < cloth.m_faces.size(); ++f)
        for (int k = 0; k < 3; ++k)
            sum += double((cloth.m_faces[f].m_n[k]->m_x - cloth.m_faces[f].m_n[(k + 1) % 3]->m_x).length());
    return sum / std::max(1, 3 * cloth.m_faces.size());
}

btScalar largestOf(const btVector3& extent)
{
    return std::max(extent.x(), std::max(extent.y(), extent.z()));
}

btScalar sizeOf(const btSoftBody& cloth)
{
    btVector3 low(SIMD_INFINITY, SIMD_INFINITY, SIMD_INFINITY), high = -low;
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
    {
        low.setMin(cloth.m_nodes[i].m_x);
        high.setMax(cloth.m_nodes[i].m_x);
    }
    return largestOf(high - low);
}

// Bullet's box includes the margin.
btScalar sizeOf(const btCollisionShape& shape)
{
    btVector3 low, high;
    shape.getAabb(btTransform::getIdentity(), low, high);
    return largestOf(high - low) - 2 * (shape.isConvex() ? meshMargin(shape) : shape.getMargin());
}

std::string tooThick(double thickness, double edge, const char* whose)
{
    char line[256];
    std::snprintf(
        line, sizeof(line),
        "the thickness (%g m, %s) is %.3g times the mean edge of the %s (%.3g m); steps are slow, since pairs "
        "grow with its square",
        thickness, kMargins, thickness / edge, whose, edge);
    return line;
}

// meshEdge: 0 for obstacles that are no meshes.
std::string edgeRemark(double thickness, double edge, double meshEdge)
{
    if (!std::isfinite(edge)) return std::string();
    if (thickness > kMostEdges * edge) return tooThick(thickness, edge, "cloth");
    if (meshEdge > 0 && thickness > kMostMeshEdges * meshEdge) return tooThick(thickness, meshEdge, "mesh");
    if (!(thickness < kLeastEdges * edge)) return std::string();
    char line[256];
    std::snprintf(line, sizeof(line), "the thickness (%g m) is a %.0fth of the mean edge of the cloth (%.3g m)",
                  thickness, edge / thickness, edge);
    return line;
}
}  // namespace

btScalar thicknessOf(const btSoftBody& cloth, const btCollisionShape& obstacle)
{
    return std::max(kMinThickness, marginOf(*cloth.getCollisionShape()) + meshMargin(obstacle));
}

std::string selfThicknessRemark(const btSoftBody& cloth, btScalar thickness)
{
    const double edge = meanEdgeOf(cloth);
    if (!(edge > 0 && double(thickness) > kMostEdges * edge)) return std::string();
    char line[256];
    std::snprintf(
        line, sizeof(line),
        "the thickness of its collision with cloth (%g m) is %.3g times its mean edge (%.3g m); steps are slow, "
        "since pairs grow with its square",
        double(thickness), double(thickness) / edge, edge);
    return line;
}

std::string marginRemark(const btSoftBody& cloth, const btCollisionShape& obstacle)
{
    char line[256];
    const double own = double(cloth.getCollisionShape()->getMargin()), other = double(obstacle.getMargin());
    if (!(own >= 0))
    {
        std::snprintf(line, sizeof(line), "the soft body's collision margin is negative (%g m) and counts as 0", own);
        return line;
    }
    if (!(other >= 0))
    {
        std::snprintf(
            line, sizeof(line),
            "the mesh shape's margin is negative (%g m) and counts as 0; Bullet shrinks the shape's bounds by "
            "it, so that cloth may be noticed too late or not at all",
            other);
        return line;
    }
    const double thickness = double(thicknessOf(cloth, obstacle));
    for (const auto& [name, size] :
         {std::make_pair("mesh", double(sizeOf(obstacle))), std::make_pair("soft body", double(sizeOf(cloth)))})
    {
        if (!(thickness >= size)) continue;
        std::snprintf(line, sizeof(line), "the thickness (%g m, %s) is as large as the %s (%.3g m)", thickness,
                      kMargins, name, size);
        return line;
    }
    return edgeRemark(thickness, meanEdgeOf(cloth), sampledEdge(obstacle));
}
}  // namespace drape
