#include "link_sweep.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <tuple>

#include "bullet_plugin/core/platform/compiler.h"
#include "bullet_plugin/core/solver/topology/colouring.h"
#include "bullet_plugin/core/threads/ranges.h"
#include "kernels/lib/solver/link_row.h"

namespace drape
{
namespace
{
// Minimum links for sharing a sweep among threads: it takes 10 µs alone.
constexpr std::size_t kLeastShared = 4096;

// Blocks that a thread starts per turn: 10 µs.
constexpr std::size_t kBlocksPerJob = 1024;

using Lanes = DRAPE_VECTOR_OF(float, 4);

void transpose(Lanes rows[4])
{
    const Lanes a = shuffled<0, 4, 1, 5>(rows[0], rows[1]);
    const Lanes b = shuffled<0, 4, 1, 5>(rows[2], rows[3]);
    const Lanes c = shuffled<2, 6, 3, 7>(rows[0], rows[1]);
    const Lanes d = shuffled<2, 6, 3, 7>(rows[2], rows[3]);
    rows[0] = shuffled<0, 1, 4, 5>(a, b);
    rows[1] = shuffled<2, 3, 6, 7>(a, b);
    rows[2] = shuffled<0, 1, 4, 5>(c, d);
    rows[3] = shuffled<2, 3, 6, 7>(c, d);
}

Lanes load(const void* address)
{
    Lanes lanes;
    std::memcpy(&lanes, address, sizeof(lanes));
    return lanes;
}

// Loads four nodes as columns: x, y, z and inverse mass.
void loadNodes(const SolverNode* nodes, const std::uint32_t indices[4], Lanes columns[4])
{
    static_assert(sizeof(SolverNode) == sizeof(Lanes));
    for (int k = 0; k < 4; ++k)
        columns[k] = load(nodes + indices[k]);
    transpose(columns);
}

// Colours the links of `order`, which lists group after group.
std::vector<std::uint32_t> coloursOf(const std::vector<LinkNodes>& links, const std::vector<std::uint32_t>& order,
                                     std::size_t nodeCount)
{
    std::vector<std::uint32_t> colours(links.size());
    Colouring colouring;
    colouring.resize(nodeCount);
    for (std::size_t first = 0, i = 0; i < order.size(); ++i)
    {
        if (links[order[i]].m_group != links[order[first]].m_group)
            for (; first < i; ++first)
                colouring.release(links[order[first]].m_nodes, 2);
        colours[order[i]] = colouring.take(links[order[i]].m_nodes, 2);
    }
    return colours;
}
}  // namespace

void LinkSweep::addBlock(const LinkNodes& link)
{
    Block block = {};
    std::fill(block.m_first, block.m_first + kWidth, link.m_nodes[0]);
    std::fill(block.m_second, block.m_second + kWidth, link.m_nodes[1]);
    m_blocks.push_back(block);
}

void LinkSweep::build(std::size_t nodeCount, std::size_t leafCount, const std::vector<LinkNodes>& links,
                      std::uint64_t partsRevision)
{
    m_climb.resize(leafCount);
    m_partsRevision = partsRevision;
    std::vector<std::uint32_t> order(links.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return links[a].m_group < links[b].m_group; });
    const std::vector<std::uint32_t> colours = coloursOf(links, order, nodeCount);
    m_isNew = true;
    m_batchOf.resize(links.size());
    for (std::size_t link = 0; link < links.size(); ++link)
        m_batchOf[link] = {links[link].m_group, colours[link]};
    const auto keyOf = [&](std::uint32_t link) { return std::make_tuple(links[link].m_group, colours[link]); };
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return keyOf(a) < keyOf(b); });
    m_blocks.clear();
    m_firsts.assign(2 * leafCount + 1, 0);
    m_laneOf.resize(links.size());
    std::size_t lane = kWidth;
    for (std::size_t i = 0; i < order.size(); ++i)
    {
        const std::uint32_t link = order[i];
        const bool continues = i > 0 && keyOf(link) == keyOf(order[i - 1]) && colours[link] != kLastColour;
        if (!continues || lane == kWidth)
        {
            addBlock(links[link]);
            lane = 0;
        }
        m_blocks.back().m_first[lane] = links[link].m_nodes[0];
        m_blocks.back().m_second[lane] = links[link].m_nodes[1];
        m_laneOf[link] = std::uint32_t((m_blocks.size() - 1) * kWidth + lane++);
        m_firsts[links[link].m_group + 1] = m_blocks.size();
    }
    for (std::size_t group = 1; group < m_firsts.size(); ++group)
        m_firsts[group] = std::max(m_firsts[group], m_firsts[group - 1]);
}

void LinkSweep::start(const NodePath* paths, ThreadTeam* threads)
{
    const auto startRange = [&](std::size_t first, std::size_t last)
    {
        for (std::size_t i = first; i < last; ++i)
        {
            Block& block = m_blocks[i];
            for (std::size_t lane = 0; lane < kWidth; ++lane)
            {
                const Vec3 apart = vec3Sub(paths[block.m_second[lane]].m_start, paths[block.m_first[lane]].m_start);
                block.m_apart[0][lane] = apart.x;
                block.m_apart[1][lane] = apart.y;
                block.m_apart[2][lane] = apart.z;
            }
        }
    };
    forRanges(m_blocks.size(), kLeastShared / kWidth, kBlocksPerJob, threads, startRange);
}

void LinkSweep::visitGroup(std::size_t group, SolverNode* nodes) const
{
    for (std::size_t i = m_firsts[group]; i < m_firsts[group + 1]; ++i)
    {
        const Block& block = m_blocks[i];
        Lanes a[4], b[4];
        loadNodes(nodes, block.m_first, a);
        loadNodes(nodes, block.m_second, b);
        Lanes apart[3];
        for (int axis = 0; axis < 3; ++axis)
            apart[axis] = load(block.m_apart[axis]) + (b[axis] - a[axis]);
        const Lanes length2 = apart[0] * apart[0] + apart[1] * apart[1] + apart[2] * apart[2];
        const Lanes rest2 = load(block.m_restSquared), sum = rest2 + length2;
        // Links do what visitLink() of kernels/lib/solver/link_row.h does.
        const auto acts = (sum > DRAPE_LINK_LENGTH2) & (sum < DRAPE_LINK_MOST_LENGTH2);
        const Lanes none = {0, 0, 0, 0};
        const Lanes share = load(block.m_strength) * (rest2 - length2) / (acts ? sum : Lanes{1, 1, 1, 1});
        const Lanes push = acts ? share : none;
        const Lanes pushA = push * a[3], pushB = push * b[3];
        for (int axis = 0; axis < 3; ++axis)
        {
            const Lanes span = acts ? apart[axis] : none;
            a[axis] -= span * pushA;
            b[axis] += span * pushB;
        }
        transpose(a);
        transpose(b);
        // The first lane goes last: lanes without a link have its nodes.
        for (int k = int(kWidth) - 1; k >= 0; --k)
        {
            std::memcpy(nodes + block.m_first[k], &a[k], sizeof(Lanes));
            std::memcpy(nodes + block.m_second[k], &b[k], sizeof(Lanes));
        }
    }
}

void LinkSweep::sweep(SolverNode* nodes, ThreadTeam* threads)
{
    m_climb.run(linkCount() >= kLeastShared ? threads : nullptr, [&](std::size_t group) { visitGroup(group, nodes); });
}
}  // namespace drape
