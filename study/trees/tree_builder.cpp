#include "study/trees/tree_builder.h"

namespace drape
{
Tree linkTreeOnHost(const TreeMethods& methods, const std::vector<Triangle>& triangles, const float* positions)
{
    const std::uint32_t bits = methods.m_mortonBits;
    if (methods.m_builder == TreeBuilder::TopDown) return buildTopDownOnHost(triangles, positions, methods.m_topDown);
    if (methods.m_builder == TreeBuilder::Ploc)
        return buildPlocOnHost(triangles, positions, bits, methods.m_plocRadius);
    return buildRadixTreeOnHost(triangles, positions, bits, methods.m_builder == TreeBuilder::Balanced);
}

Tree buildTreeOnHost(const TreeMethods& methods, const std::vector<Triangle>& triangles, const float* positions,
                     std::size_t meshCount)
{
    Tree tree = linkTreeOnHost(methods, triangles, positions);
    if (methods.m_builder == TreeBuilder::TopDown) return tree;  // has its volumes
    std::size_t ignored = 0;
    const std::vector<float> noRadius(meshCount, 0.0f);
    refitTreeOnHost(tree, triangles, positions, positions, noRadius, ignored);
    return tree;
}

void TreeBuilderStage::create(Device& device, const ProgramLoader& load, const TreeMethods& methods)
{
    m_methods = methods;
    m_refit.create(device, load);
    switch (m_methods.m_builder)
    {
        case TreeBuilder::TopDown:
            m_topDown.create(device, load);
            break;
        case TreeBuilder::Ploc:
            m_ploc.create(device, load);
            break;
        default:
            m_radix.create(device, load);
    }
}

void TreeBuilderStage::enqueue(Device& device, Buffer<Triangle>& triangles, Buffer<float>& positions, cl_uint count,
                               std::size_t meshCount, DeviceTree& tree)
{
    const WorkShape shape = m_methods.m_workShape;
    const cl_uint bits = m_methods.m_mortonBits;
    tree.reserve(device, count);
    if (count == 0) return;
    switch (m_methods.m_builder)
    {
        case TreeBuilder::TopDown:
            m_topDown.build(device, triangles, positions, count, m_methods.m_topDown, tree);
            break;
        case TreeBuilder::Ploc:
            m_ploc.build(device, triangles, positions, count, bits, m_methods.m_plocRadius, shape, tree);
            break;
        default:
            m_radix.enqueue(device, triangles, positions, count, bits, m_methods.m_builder == TreeBuilder::Balanced,
                            shape, tree);
    }
    m_refit.prepare(device, tree, m_methods);
    if (m_methods.m_builder == TreeBuilder::TopDown) return;  // has its volumes
    m_noRadius.reserve(device, meshCount);
    m_noRadius.fill(device, 0, meshCount);
    m_counters.reserve(device, 1);
    m_counters.fill(device, 0, 1);
    m_refit.enqueue(device, tree, {triangles, positions, positions, m_noRadius, m_counters}, m_methods);
}
}  // namespace drape
