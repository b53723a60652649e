// Gauss-Seidel sweeps over the links of one cloth: distance constraints between pairs of nodes.
//
// A sweep visits each link once and moves its nodes as btSoftBody::PSolve_Links does. Links are sorted by groups, a
// binary heap of which two groups share no node unless one contains the other (ClothParts); a sweep goes from the
// leaves to the root. Links of one group are coloured: two of one colour share no node. Guarantee: the same bits with
// any number of threads and any width of vector. Cost: linear in the links, a few nanoseconds each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bullet_plugin/core/solver/topology/group_climb.h"
#include "bullet_plugin/core/solver/topology/revision.h"
#include "bullet_plugin/core/threads/thread_team.h"
#include "kernels/lib/solver/solver_node.h"

namespace drape
{
// The nodes of a link, and its group: 1 for the whole cloth, children 2 g and 2 g + 1 for group g.
struct LinkNodes
{
    std::uint32_t m_nodes[2];
    std::uint32_t m_group;
};

class LinkSweep
{
public:
    // Sorts the links; leafCount: a power of two, the groups are less than twice as many. Strengths are 0 until set.
    // partsRevision: of the parts that the groups are of.
    void build(std::size_t nodeCount, std::size_t leafCount, const std::vector<LinkNodes>& links,
               std::uint64_t partsRevision = 0);
    std::uint64_t partsRevision() const { return m_partsRevision; }

    std::size_t leafCount() const { return m_climb.leafCount(); }
    std::size_t linkCount() const { return m_laneOf.size(); }
    // Sets a link, in the order of build(); call changed() after the last. restSquared: m². strength: kg, the share of
    // a violation that a visit corrects, divided by the sum of the nodes' inverse masses; 0 for a link without effect.
    // Several threads may set links.
    void set(std::size_t link, float restSquared, float strength)
    {
        Block& block = m_blocks[m_laneOf[link] / kWidth];
        const std::size_t lane = m_laneOf[link] % kWidth;
        block.m_restSquared[lane] = restSquared;
        block.m_strength[lane] = strength;
    }
    void changed() { m_isNew = true; }

    // Differs after build() and changed() from that of any other state.
    std::uint64_t revision()
    {
        if (m_isNew) m_revision = newRevision();
        m_isNew = false;
        return m_revision;
    }
    // Calls visit(group, colour, nodes, restSquared, strength) for each link, in the order of build().
    template <class Visit>
    void forLinks(const Visit& visit) const
    {
        for (std::size_t link = 0; link < linkCount(); ++link)
        {
            const Block& block = m_blocks[m_laneOf[link] / kWidth];
            const std::size_t lane = m_laneOf[link] % kWidth;
            const std::uint32_t nodes[2] = {block.m_first[lane], block.m_second[lane]};
            visit(m_batchOf[link].m_group, m_batchOf[link].m_colour, nodes, block.m_restSquared[lane],
                  block.m_strength[lane]);
        }
    }

    // Begins a step: takes each link's vector from its first node to the second at the starts of their paths. threads:
    // null for the caller alone.
    void start(const NodePath* paths, ThreadTeam* threads);
    // Visits every link once. threads: null for the caller alone.
    void sweep(SolverNode* nodes, ThreadTeam* threads);

private:
    static constexpr std::size_t kWidth = 4;  // links side by side

    // Links of one colour. Lanes without a link have strength 0 and the first lane's nodes.
    struct Block
    {
        std::uint32_t m_first[kWidth], m_second[kWidth];
        float m_apart[3][kWidth], m_restSquared[kWidth], m_strength[kWidth];
    };

    struct Batch
    {
        std::uint32_t m_group, m_colour;
    };

    void addBlock(const LinkNodes& link);
    void visitGroup(std::size_t group, SolverNode* nodes) const;

    std::vector<Block> m_blocks;
    std::vector<std::size_t> m_firsts;    // by group, the first of its blocks; then the end
    std::vector<std::uint32_t> m_laneOf;  // by link, its lane over all blocks
    std::vector<Batch> m_batchOf;         // by link
    std::uint64_t m_revision = 0;
    bool m_isNew = true;
    GroupClimb m_climb;
    std::uint64_t m_partsRevision = 0;
};
}  // namespace drape
