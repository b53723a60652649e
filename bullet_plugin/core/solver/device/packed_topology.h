// Packs what a device keeps of cloths from step to step, in the order of sweeps: links, faces, and where the contacts
// of each feature belong (kernels/shared/solve_step.h).
//
// Nodes are sorted by the leaves of their cloth's parts. Packing costs time in proportion to the cloths, and is needed
// when one of them or its position among the pipeline's meshes changed.
#pragma once

#include <cstdint>
#include <vector>

#include "bullet_plugin/core/solver/host/link_sweep.h"
#include "bullet_plugin/core/solver/solver_cloth.h"
#include "bullet_plugin/core/solver/topology/revision.h"
#include "kernels/shared/solve_step.h"

namespace drape
{
class MeshPool;

class PackedTopology
{
public:
    // The groups of one height of large cloths, in the list of groups.
    struct Level
    {
        SolveRange m_groups;
        bool m_hasLinks, m_hasBuckets;
    };

    // Returns whether a cloth is solved in passes, as a large cloth is: it has several leaves, or rigid rows.
    static bool isByPasses(const SolverCloth& cloth)
    {
        return cloth.m_contacts->m_parts->leafCount() > 1 || cloth.m_rigid != nullptr;
    }

    // Packs the cloths unless they are what was packed last. meshes: the pipeline's cloths; null without contacts.
    void pack(const std::vector<SolverCloth>& cloths, const MeshPool* meshes);
    // Differs from that of all other packed data.
    std::uint64_t revision() const { return m_revision; }

    // Sets the layout's numbers and its offsets in the topology.
    void describe(SolveLayout& layout) const { layout = m_layout; }
    const std::vector<SolveTopologyWord>& words() const { return m_words; }
    // First node of a cloth, and where its nodes' lists of faces are.
    std::uint32_t firstNode(std::size_t cloth) const { return m_cloths[cloth].m_firstNode; }
    std::uint32_t faceLists(std::size_t cloth) const { return m_cloths[cloth].m_faceLists; }
    std::size_t nodeCount() const { return m_nodeOrder.size(); }
    std::size_t linkCount() const { return m_links.size(); }
    std::size_t bucketCount() const { return m_bucketCloths.size(); }
    // By node, its index in the caller's order.
    const std::vector<std::uint32_t>& nodeOrder() const { return m_nodeOrder; }

    // The groups of cloths with one leaf, small ones first, and those of large cloths from the leaves on.
    SolveRange small() const { return m_small; }
    SolveRange whole() const { return m_whole; }
    const std::vector<Level>& levels() const { return m_levels; }

private:
    // Revisions of a cloth's links, faces, order and parts, and its positions among the pipeline's meshes.
    struct Key
    {
        std::uint64_t m_links, m_faces, m_order, m_parts;
        std::uint32_t m_firsts[5];
        bool m_isByPasses;
        bool operator==(const Key& other) const;
    };
    struct Cloth
    {
        std::uint32_t m_firstNode, m_faceLists, m_firstGroup;
    };

    static Key keyOf(const SolverCloth& cloth, const MeshPool* meshes);
    void packCloth(const SolverCloth& cloth, const MeshPool* meshes);
    void packLinks(const LinkSweep& links, const std::vector<std::uint32_t>& packedIndex, std::size_t firstGroup);
    void packFaces(const ClothFaces& faces, const ClothParts& parts, const std::vector<std::uint32_t>& packedIndex);
    void packFeatures(const ClothContacts& contacts, const MeshPool& meshes,
                      const std::vector<std::uint32_t>& packedIndex, std::size_t firstGroup);
    void listGroups(const std::vector<SolverCloth>& cloths);
    void layOut();

    std::vector<Key> m_keys;
    std::uint64_t m_revision = 0;
    std::vector<Cloth> m_cloths;
    std::vector<SolveLink> m_links;
    std::vector<SolveBatch> m_linkBatches;
    std::vector<SolveGroup> m_groups;
    std::vector<std::uint32_t> m_levelGroups, m_faceLists, m_facesOfNode, m_faces, m_nodeOrder, m_bucketCloths;
    std::vector<SolveFeature> m_features;
    std::vector<SolveTopologyWord> m_words;
    SolveLayout m_layout = {};
    SolveRange m_small = {}, m_whole = {};
    std::vector<Level> m_levels;
};
}  // namespace drape
