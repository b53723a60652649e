#include "patches.h"

namespace drape
{
namespace
{
void padBlock(std::vector<std::uint32_t>& owners, std::uint32_t width)
{
    while (owners.size() % width != 0)
        owners.push_back(DRAPE_NO_FEATURE);
}

// Triangles [first, last) of the leaf order.
void appendPatch(Patches& patches, const MeshPool& pool, std::size_t first, std::size_t last, std::uint32_t width)
{
    Patch patch = {};
    patch.m_mesh = pool.triangles()[pool.order()[first]].m_mesh;
    patch.m_vertexBlock = std::uint32_t(patches.m_vertexOwners.size()) / width;
    patch.m_edgeBlock = std::uint32_t(patches.m_edgeOwners.size()) / width;
    for (std::size_t leaf = first; leaf < last; ++leaf)
    {
        const std::uint32_t index = pool.order()[leaf];
        const std::uint32_t owned = pool.triangles()[index].m_owned;
        patches.m_faceOwners.push_back(index);
        const std::size_t vertex = patches.m_vertexOwners.size() - std::size_t(patch.m_vertexBlock) * width;
        const std::size_t edge = patches.m_edgeOwners.size() - std::size_t(patch.m_edgeBlock) * width;
        patches.m_faceFeatures.push_back(owned | std::uint32_t(vertex) << 8 | std::uint32_t(edge) << 16);
        for (std::uint32_t place = 0; place < 3; ++place)
        {
            const std::uint32_t feature = index | (place << DRAPE_PLACE_SHIFT);
            if (owned & DRAPE_OWNS_VERTEX(place)) patches.m_vertexOwners.push_back(feature);
            if (owned & DRAPE_OWNS_EDGE(place)) patches.m_edgeOwners.push_back(feature);
        }
    }
    padBlock(patches.m_faceOwners, width);
    patches.m_faceFeatures.resize(patches.m_faceOwners.size(), 0);
    padBlock(patches.m_vertexOwners, width);
    padBlock(patches.m_edgeOwners, width);
    patch.m_vertexBlocks = std::uint32_t(patches.m_vertexOwners.size()) / width - patch.m_vertexBlock;
    patch.m_edgeBlocks = std::uint32_t(patches.m_edgeOwners.size()) / width - patch.m_edgeBlock;
    patches.m_patches.push_back(patch);
}

}  // namespace

Patches makePatches(const MeshPool& obstacles, std::uint32_t width)
{
    Patches patches;
    const std::vector<std::uint32_t>& order = obstacles.order();
    for (std::size_t first = 0; first < order.size();)
    {
        std::size_t last = first + 1;
        const std::uint32_t mesh = obstacles.triangles()[order[first]].m_mesh;
        while (last < order.size() && last - first < width && obstacles.triangles()[order[last]].m_mesh == mesh)
            ++last;
        appendPatch(patches, obstacles, first, last, width);
        first = last;
    }
    std::uint32_t nodes = 0;
    for (std::size_t count = patches.m_patches.size(); count > 0;)
    {
        count = (count + width - 1) / width;
        patches.m_levels.push_back(nodes);
        nodes += std::uint32_t(count);
        if (count == 1) break;
    }
    patches.m_levels.push_back(nodes);
    return patches;
}
}  // namespace drape
