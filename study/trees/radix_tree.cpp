#include "study/trees/radix_tree.h"

#include "study/kernels/lib/radix_tree.h"

namespace drape
{
namespace
{
constexpr std::size_t kGroup = 64;

std::uint32_t splittingBits(std::uint32_t count, std::uint32_t codeBits, bool balanced)
{
    const std::uint32_t unused = codeBits == 30 ? 2 : 1;  // leading bits of the first word
    return balanced ? 0 : decidingBits(count, codeBits, unused);
}
}  // namespace

Tree buildRadixTreeOnHost(const std::vector<Triangle>& triangles, const float* positions, std::uint32_t codeBits,
                          bool balanced)
{
    Tree tree;
    const std::uint32_t count = std::uint32_t(triangles.size());
    MortonOrder sorted = sortByMorton(triangles, positions, codeBits);
    resizeTree(tree, count);
    tree.m_order = std::move(sorted.m_order);
    if (count == 1) treeSetLeaf(tree.m_nodes.data(), 0, 0);
    if (count <= 1) return tree;
    const SortedCodes codes = {sorted.m_high.data(), sorted.m_low.empty() ? sorted.m_high.data() : sorted.m_low.data(),
                               splittingBits(count, codeBits, balanced), count};
    for (std::uint32_t split = 0; split + 1 < count; ++split)
        radixSetPair(&codes, tree.m_nodes.data(), tree.m_splits.data(), split);
    return tree;
}

void RadixTreeStage::create(Device& device, const ProgramLoader& load)
{
    m_order.create(device, load);
    m_links.create(device, load("radix_tree"), "radixTreeLinks");
}

void RadixTreeStage::enqueue(Device& device, Buffer<Triangle>& triangles, Buffer<float>& positions, cl_uint count,
                             cl_uint codeBits, bool balanced, WorkShape shape, DeviceTree& tree)
{
    tree.reserve(device, count);
    if (count == 0) return;
    m_order.enqueue(device, triangles, positions, count, codeBits, shape, tree.m_order, m_high, m_low);
    m_links.launch(device, count, kGroup, m_high.handle(), codeBits == 30 ? m_high.handle() : m_low.handle(),
                   cl_uint(splittingBits(count, codeBits, balanced)), count, tree.m_nodes.handle(),
                   tree.m_splits.handle());
}
}  // namespace drape
