#include "leaf_crowd.h"

namespace drape
{
LeafCrowd crowdOfLeaf(const BvhNode& leaf, std::uint32_t mesh)
{
    LeafCrowd crowd;
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        crowd.m_lowMost[i] = leaf.m_low[i];
        crowd.m_highLeast[i] = leaf.m_high[i];
    }
    crowd.m_leaves = 1;
    crowd.m_mesh = mesh;
    return crowd;
}

void joinCrowd(LeafCrowd& crowd, const LeafCrowd& other)
{
    if (crowd.m_leaves == 0)
    {
        crowd = other;
        return;
    }
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        crowd.m_lowMost[i] = drapeMax(crowd.m_lowMost[i], other.m_lowMost[i]);
        crowd.m_highLeast[i] = drapeMin(crowd.m_highLeast[i], other.m_highLeast[i]);
    }
    crowd.m_leaves += other.m_leaves;
    if (crowd.m_mesh != other.m_mesh) crowd.m_mesh = kMixedMeshes;
}

bool allOverlap(const LeafCrowd& a, const LeafCrowd& b)
{
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        if (a.m_lowMost[i] > b.m_highLeast[i] || b.m_lowMost[i] > a.m_highLeast[i]) return false;
    }
    return true;
}
}  // namespace drape
