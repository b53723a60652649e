#include "packed_topology.h"

#include <algorithm>
#include <tuple>

#include "bullet_plugin/core/platform/compiler.h"
#include "bullet_plugin/core/scene/mesh_pool.h"
#include "bullet_plugin/core/solver/host/substeps.h"
#include "kernels/lib/ordering/feature_index.h"
#include "word_offsets.h"

namespace drape
{
namespace
{
// Maximum nodes of a cloth for the small group.
constexpr std::size_t kMostSmallNodes = 512;

// Returns the height of a group above the leaves.
std::size_t heightOf(std::size_t group, std::size_t leafCount)
{
    return std::size_t(leadingZeros(std::uint64_t(group)) - leadingZeros(std::uint64_t(leafCount)));
}
}  // namespace

bool PackedTopology::Key::operator==(const Key& other) const
{
    return std::tie(m_links, m_faces, m_order, m_parts, m_isByPasses) ==
               std::tie(other.m_links, other.m_faces, other.m_order, other.m_parts, other.m_isByPasses) &&
           std::equal(m_firsts, m_firsts + 5, other.m_firsts);
}

PackedTopology::Key PackedTopology::keyOf(const SolverCloth& cloth, const MeshPool* meshes)
{
    const ClothContacts& contacts = *cloth.m_contacts;
    Key key = {cloth.m_substeps->links().revision(),
               contacts.m_limit.faces()->revision(),
               0,
               contacts.m_parts->revision(),
               {},
               isByPasses(cloth)};
    if (!meshes || !contacts.m_order) return key;
    key.m_order = contacts.m_order->revision();
    const MeshOffsets first = meshes->begin(meshes->existingSlot(contacts.m_mesh));
    const std::uint32_t firsts[5] = {first.m_vertex, first.m_triangle, first.m_edge,
                                     std::uint32_t(meshes->vertexCount()), std::uint32_t(meshes->triangles().size())};
    std::copy(firsts, firsts + 5, key.m_firsts);
    return key;
}

void PackedTopology::pack(const std::vector<SolverCloth>& cloths, const MeshPool* meshes)
{
    std::vector<Key> keys;
    for (const SolverCloth& cloth : cloths)
        keys.push_back(keyOf(cloth, meshes));
    if (keys == m_keys) return;
    m_keys.clear();
    m_cloths.clear();
    m_links.clear();
    m_linkBatches.clear();
    m_groups.clear();
    for (std::vector<std::uint32_t>* list :
         {&m_levelGroups, &m_faceLists, &m_facesOfNode, &m_faces, &m_nodeOrder, &m_bucketCloths})
        list->clear();
    const std::size_t features =
        meshes ? meshes->vertexCount() + meshes->triangles().size() + meshes->edges().size() : std::size_t(0);
    m_features.assign(features, SolveFeature{DRAPE_NO_BUCKET, {DRAPE_NO_NODE, DRAPE_NO_NODE, DRAPE_NO_NODE}});
    for (const SolverCloth& cloth : cloths)
        packCloth(cloth, meshes);
    listGroups(cloths);
    layOut();
    m_keys = std::move(keys);
    m_revision = newRevision();
}

void PackedTopology::packCloth(const SolverCloth& cloth, const MeshPool* meshes)
{
    const ClothContacts& contacts = *cloth.m_contacts;
    const ClothParts& parts = *contacts.m_parts;
    const std::size_t firstGroup = m_groups.size(), firstNode = m_nodeOrder.size();
    m_cloths.push_back({std::uint32_t(firstNode), std::uint32_t(m_faceLists.size()), std::uint32_t(firstGroup)});
    std::vector<std::uint32_t> packedIndex(parts.nodeCount());
    for (std::size_t i = 0; i < parts.nodeCount(); ++i)
    {
        packedIndex[std::size_t(parts.order()[i])] = std::uint32_t(i);
        m_nodeOrder.push_back(std::uint32_t(firstNode + std::size_t(parts.order()[i])));
    }
    m_groups.resize(firstGroup + parts.groupCount() - 1);
    for (std::size_t group = 1; group < parts.groupCount(); ++group)
    {
        SolveGroup& packed = m_groups[firstGroup + group - 1];
        packed = {};
        packed.m_cloth = std::uint32_t(m_cloths.size() - 1);
        if (group < parts.firstLeaf()) continue;
        const std::size_t leaf = group - parts.firstLeaf();
        packed.m_nodes = {std::uint32_t(parts.firstNode(leaf)),
                          std::uint32_t(parts.firstNode(leaf + 1) - parts.firstNode(leaf))};
    }
    packLinks(cloth.m_substeps->links(), packedIndex, firstGroup);
    packFaces(*contacts.m_limit.faces(), parts, packedIndex);
    if (meshes && contacts.m_order) packFeatures(contacts, *meshes, packedIndex, firstGroup);
}

void PackedTopology::packLinks(const LinkSweep& links, const std::vector<std::uint32_t>& packedIndex,
                               std::size_t firstGroup)
{
    const std::size_t groups = m_groups.size() - firstGroup;
    const auto keyOf = [](std::uint32_t group, std::uint32_t colour)
    { return std::size_t(group - 1) * kColours + colour; };
    std::vector<std::uint32_t> firsts(groups * kColours + 1, 0);
    links.forLinks([&](std::uint32_t group, std::uint32_t colour, const std::uint32_t*, float, float)
                   { ++firsts[keyOf(group, colour) + 1]; });
    firsts[0] = std::uint32_t(m_links.size());
    for (std::size_t key = 1; key < firsts.size(); ++key)
        firsts[key] += firsts[key - 1];
    for (std::size_t group = 0; group < groups; ++group)
    {
        SolveRange& batches = m_groups[firstGroup + group].m_linkBatches;
        batches.m_first = std::uint32_t(m_linkBatches.size());
        for (std::size_t key = group * kColours; key < (group + 1) * kColours; ++key)
            if (firsts[key] < firsts[key + 1])
                m_linkBatches.push_back({firsts[key], firsts[key + 1], key % kColours == kLastColour});
        batches.m_count = std::uint32_t(m_linkBatches.size()) - batches.m_first;
    }
    m_links.resize(firsts.back());
    links.forLinks(
        [&](std::uint32_t group, std::uint32_t colour, const std::uint32_t* nodes, float restSquared, float strength) {
            m_links[firsts[keyOf(group, colour)]++] = {
                {packedIndex[nodes[0]], packedIndex[nodes[1]]}, restSquared, strength};
        });
}

void PackedTopology::packFaces(const ClothFaces& faces, const ClothParts& parts,
                               const std::vector<std::uint32_t>& packedIndex)
{
    const std::uint32_t firstFace = std::uint32_t(m_faces.size() / 3);
    for (std::size_t i = 0; i < parts.nodeCount(); ++i)
    {
        m_faceLists.push_back(std::uint32_t(m_facesOfNode.size()));
        const std::size_t node = std::size_t(parts.order()[i]);
        if (node >= faces.nodeCount()) continue;
        for (std::size_t k = faces.firsts()[node]; k < faces.firsts()[node + 1]; ++k)
            m_facesOfNode.push_back(firstFace + faces.facesOfNodes()[k]);
    }
    m_faceLists.push_back(std::uint32_t(m_facesOfNode.size()));
    for (const std::int32_t node : faces.triangles())
        m_faces.push_back(node >= 0 && std::size_t(node) < packedIndex.size() ? packedIndex[std::size_t(node)] : 0);
}

void PackedTopology::packFeatures(const ClothContacts& contacts, const MeshPool& meshes,
                                  const std::vector<std::uint32_t>& packedIndex, std::size_t firstGroup)
{
    const FeatureOrder& order = *contacts.m_order;
    for (const OrderedFeature& feature : order.features())
    {
        SolveGroup& group = m_groups[firstGroup + feature.m_group - 1];
        std::uint32_t& buckets = feature.m_kind == kNodeFeature   ? group.m_nodeBuckets
                                 : feature.m_kind == kFaceFeature ? group.m_faceBuckets
                                                                  : group.m_edgeBuckets;
        buckets = std::max(buckets, feature.m_colour + 1);
    }
    for (std::size_t i = firstGroup; i < m_groups.size(); ++i)
    {
        SolveGroup& group = m_groups[i];
        group.m_firstBucket = std::uint32_t(m_bucketCloths.size());
        m_bucketCloths.resize(m_bucketCloths.size() + group.m_nodeBuckets + group.m_faceBuckets + group.m_edgeBuckets,
                              group.m_cloth);
    }
    const MeshOffsets first = meshes.begin(meshes.existingSlot(contacts.m_mesh));
    for (std::size_t i = 0; i < order.features().size(); ++i)
    {
        const OrderedFeature& feature = order.features()[i];
        const SolveGroup& group = m_groups[firstGroup + feature.m_group - 1];
        SolveFeature packed = {group.m_firstBucket + feature.m_colour, {DRAPE_NO_NODE, DRAPE_NO_NODE, DRAPE_NO_NODE}};
        if (feature.m_kind != kNodeFeature) packed.m_bucket += group.m_nodeBuckets;
        if (feature.m_kind == kEdgeFeature) packed.m_bucket += group.m_faceBuckets;
        for (int k = 0; k < 3 && feature.m_nodes[k] >= 0; ++k)
            packed.m_nodes[k] = packedIndex[std::size_t(feature.m_nodes[k])];
        std::size_t index = first.m_vertex + i;
        std::uint32_t kind = DRAPE_NODE_FACE;
        if (i >= order.firstEdge())
        {
            index = first.m_edge + (i - order.firstEdge());
            kind = DRAPE_EDGE_EDGE;
        }
        else if (i >= order.firstTriangle())
        {
            index = first.m_triangle + (i - order.firstTriangle());
            kind = DRAPE_FACE_VERTEX;
        }
        m_features[featureIndexOf(kind, std::uint32_t(index), std::uint32_t(meshes.vertexCount()),
                                  std::uint32_t(meshes.triangles().size()))] = packed;
    }
}

// Lists the groups of cloths that a work-group solves as a whole, and those of others by height.
void PackedTopology::listGroups(const std::vector<SolverCloth>& cloths)
{
    std::vector<std::uint32_t> small, whole;
    std::vector<std::vector<std::uint32_t>> byHeight;
    for (std::size_t i = 0; i < cloths.size(); ++i)
    {
        const ClothParts& parts = *cloths[i].m_contacts->m_parts;
        const std::uint32_t first = m_cloths[i].m_firstGroup;
        if (!isByPasses(cloths[i]))
        {
            (parts.nodeCount() <= kMostSmallNodes ? small : whole).push_back(first);
            continue;
        }
        for (std::size_t group = 1; group < parts.groupCount(); ++group)
        {
            const std::size_t height = heightOf(group, parts.leafCount());
            if (byHeight.size() <= height) byHeight.resize(height + 1);
            byHeight[height].push_back(first + std::uint32_t(group - 1));
        }
    }
    const auto list = [this](const std::vector<std::uint32_t>& groups)
    {
        const SolveRange range = {std::uint32_t(m_levelGroups.size()), std::uint32_t(groups.size())};
        m_levelGroups.insert(m_levelGroups.end(), groups.begin(), groups.end());
        return range;
    };
    m_small = list(small);
    m_whole = list(whole);
    m_levels.clear();
    for (const std::vector<std::uint32_t>& groups : byHeight)
    {
        const auto hasLinks = [this](std::uint32_t group) { return m_groups[group].m_linkBatches.m_count > 0; };
        const auto hasBuckets = [this](std::uint32_t group)
        {
            const SolveGroup& packed = m_groups[group];
            return packed.m_nodeBuckets + packed.m_faceBuckets + packed.m_edgeBuckets > 0;
        };
        m_levels.push_back({list(groups), std::any_of(groups.begin(), groups.end(), hasLinks),
                            std::any_of(groups.begin(), groups.end(), hasBuckets)});
    }
}

void PackedTopology::layOut()
{
    WordOffsets offsets;
    SolveLayout& layout = m_layout;
    layout = {};
    layout.m_nodeCount = std::uint32_t(m_nodeOrder.size());
    layout.m_bucketCount = std::uint32_t(m_bucketCloths.size());
    layout.m_links = offsets.add<SolveLink>(m_links.size());
    layout.m_linkBatches = offsets.add<SolveBatch>(m_linkBatches.size());
    layout.m_groups = offsets.add<SolveGroup>(m_groups.size());
    layout.m_levelGroups = offsets.add<std::uint32_t>(m_levelGroups.size());
    layout.m_faceLists = offsets.add<std::uint32_t>(m_faceLists.size());
    layout.m_facesOfNode = offsets.add<std::uint32_t>(m_facesOfNode.size());
    layout.m_faces = offsets.add<std::uint32_t>(m_faces.size());
    layout.m_nodeOrder = offsets.add<std::uint32_t>(m_nodeOrder.size());
    layout.m_features = offsets.add<SolveFeature>(m_features.size());
    layout.m_bucketCloths = offsets.add<std::uint32_t>(m_bucketCloths.size());
    m_words.assign(offsets.words(), SolveTopologyWord());
    const auto copy = [this](std::uint32_t offset, const auto& list)
    { copyToWords(m_words.data(), offset, list.data(), list.size()); };
    copy(layout.m_links, m_links);
    copy(layout.m_linkBatches, m_linkBatches);
    copy(layout.m_groups, m_groups);
    copy(layout.m_levelGroups, m_levelGroups);
    copy(layout.m_faceLists, m_faceLists);
    copy(layout.m_facesOfNode, m_facesOfNode);
    copy(layout.m_faces, m_faces);
    copy(layout.m_nodeOrder, m_nodeOrder);
    copy(layout.m_features, m_features);
    copy(layout.m_bucketCloths, m_bucketCloths);
}
}  // namespace drape
