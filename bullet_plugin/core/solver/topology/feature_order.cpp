#include "feature_order.h"

#include "bullet_plugin/core/platform/compiler.h"
#include "kernels/lib/geometry/segment.h"
#include "kernels/lib/ordering/feature_index.h"
#include "revision.h"

namespace drape
{
namespace
{
OrderedFeature featureOf(const ClothParts& parts, const std::uint32_t* nodes, int count)
{
    OrderedFeature feature = {0, kNodeFeature, 0, {-1, -1, -1}};
    for (int k = 0; k < count; ++k)
        feature.m_nodes[k] = int(nodes[k]);
    if (count > 1) feature.m_kind = count == 3 ? kFaceFeature : kEdgeFeature;
    feature.m_group = std::uint32_t(parts.groupOf(feature.m_nodes));
    return feature;
}
}  // namespace

// Colours the features of a kind: edges from the first one on, faces from the last one. Other orders keep cloth on its
// side, too, but at the end of some steps cloth thrown at posts and needles is nearer to them. Groups of one height
// share no node, so they are coloured together.
void FeatureOrder::colour(std::uint32_t kind, std::size_t nodeCount)
{
    std::vector<Colouring> byHeight;
    for (std::size_t i = 0; i < m_features.size(); ++i)
    {
        OrderedFeature& feature = m_features[kind == kEdgeFeature ? i : m_features.size() - 1 - i];
        if (feature.m_kind != kind) continue;
        const std::size_t height = std::size_t(31 - leadingZeros(feature.m_group));
        while (byHeight.size() <= height)
        {
            byHeight.emplace_back();
            byHeight.back().resize(nodeCount);
        }
        const std::size_t count = kind == kFaceFeature ? 3 : 2;
        feature.m_colour = byHeight[height].take(feature.m_nodes, count);
        m_anyUncoloured = m_anyUncoloured || feature.m_colour == kLastColour;
    }
}

void FeatureOrder::build(const ClothParts& parts, const Topology& topology)
{
    m_partsRevision = 0;
    const std::uint32_t nodes = std::uint32_t(topology.m_vertexCount);
    const std::uint32_t triangles = std::uint32_t(topology.m_triangles.size());
    m_firstTriangle = featureIndexOf(DRAPE_FACE_VERTEX, 0, nodes, triangles);
    m_firstEdge = featureIndexOf(DRAPE_EDGE_EDGE, 0, nodes, triangles);
    m_features.clear();
    for (std::uint32_t node = 0; node < topology.m_vertexCount; ++node)
        m_features.push_back(featureOf(parts, &node, 1));
    for (const Triangle& triangle : topology.m_triangles)
        m_features.push_back(featureOf(parts, triangle.m_vertices, isSegment(&triangle) ? 2 : 3));
    for (const Edge& edge : topology.m_edges)
        m_features.push_back(featureOf(parts, edge.m_vertices, 2));
    m_anyUncoloured = false;
    colour(kFaceFeature, topology.m_vertexCount);
    colour(kEdgeFeature, topology.m_vertexCount);
    m_revision = newRevision();
    m_partsRevision = parts.revision();
}
}  // namespace drape
