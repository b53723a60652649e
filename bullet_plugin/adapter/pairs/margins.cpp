#include "bullet_plugin/adapter/pairs/margins.h"

#include <cstdio>

#include "bullet_plugin/adapter/mirrors/mesh_reader.h"

namespace drape
{
namespace
{
// Maximum and minimum thickness, in mean edge lengths of the cloth.
constexpr double kMostEdges = 4;
constexpr double kLeastEdges = 0.005;

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
std::string edgeRemark(double thickness, double edge)
{
    char line[256] = "";
    if (thickness > kMostEdges * edge)
        std::snprintf(
            line, sizeof(line),
            "the thickness (%g m) is %.3g times the mean edge of the cloth (%g m); pairs grow with its square",
            thickness, thickness / edge, edge);
    else if (thickness < kLeastEdges * edge)
        std::snprintf(line, sizeof(line), "the thickness (%g m) is a %.0fth of the mean edge of the cloth (%g m)",
                      thickness, edge / thickness, edge);
    return line;
}
}  // namespace

btScalar thicknessOf(const btSoftBody& cloth, const btCollisionShape& obstacle)
{
    return std::max(kMinThickness, marginOf(*cloth.getCollisionShape()) + meshMargin(obstacle));
}

std::string marginRemark(const btSoftBody& cloth, const btCollisionShape& obstacle)
{
    char line[256];
    const double own = double(cloth.getCollisionShape()->getMargin()), other = double(obstacle.getMargin());
    if (own < 0)
    {
        std::snprintf(line, sizeof(line), "the soft body's collision margin is negative (%g m) and counts as 0", own);
        return line;
    }
    if (other < 0)
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
        std::snprintf(line, sizeof(line),
                      "the thickness (%g m, the margins of the soft body and of the mesh) is as large as the %s (%g m)",
                      thickness, name, size);
        return line;
    }
    return edgeRemark(thickness, meanEdgeOf(cloth));
}
}  // namespace drape
