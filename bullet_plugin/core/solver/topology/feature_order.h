// The order in which sweeps visit a cloth's features: nodes, faces and edges.
//
// A feature belongs to the smallest group of the cloth's parts that contains its nodes (cloth_parts.h). Within a group,
// features of one kind are coloured: two of one colour share no node (colouring.h). The order depends on topology and
// parts alone, so host and device sort the contacts of a step without colouring them. Cost: O(n) per topology.
#pragma once

#include <cstdint>
#include <vector>

#include "bullet_plugin/core/scene/topology.h"
#include "cloth_parts.h"
#include "colouring.h"

namespace drape
{
// Kinds of features in the order of sweeps. A face that stands for an edge (segment.h) counts as an edge.
constexpr std::uint32_t kNodeFeature = 0, kFaceFeature = 1, kEdgeFeature = 2;

// A feature as sweeps see it.
struct OrderedFeature
{
    std::uint32_t m_group, m_kind, m_colour;
    int m_nodes[3];  // indices in the cloth; -1 where unused
};

class FeatureOrder
{
public:
    // parts: of the topology's vertices.
    void build(const ClothParts& parts, const Topology& topology);

    // All features, by featureIndexOf().
    const std::vector<OrderedFeature>& features() const { return m_features; }
    std::size_t firstTriangle() const { return m_firstTriangle; }
    std::size_t firstEdge() const { return m_firstEdge; }
    // Returns whether some features found no colour. They share the last one.
    bool anyUncoloured() const { return m_anyUncoloured; }
    // Returns the revision of the parts that the order is of; 0 if build() did not end.
    std::uint64_t partsRevision() const { return m_partsRevision; }
    // Differs after build() from that of any other order.
    std::uint64_t revision() const { return m_revision; }

private:
    void colour(std::uint32_t kind, std::size_t nodeCount);

    std::vector<OrderedFeature> m_features;
    std::size_t m_firstTriangle = 0, m_firstEdge = 0;
    std::uint64_t m_revision = 0, m_partsRevision = 0;
    bool m_anyUncoloured = false;
};
}  // namespace drape
