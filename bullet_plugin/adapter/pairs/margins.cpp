#include "bullet_plugin/adapter/pairs/margins.h"

#include <cstdio>

#include "bullet_plugin/adapter/mirrors/mesh_reader.h"

namespace drape
{
namespace
{
// Minimum thickness, m: both margins may be zero, but the pipeline needs a positive thickness.
constexpr btScalar kMinThickness = btScalar(1e-4);

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
    return std::string();
}
}  // namespace drape
