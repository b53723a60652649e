// Packs the rows beside rigid bodies for the device's solver (kernels/solver/solve_rigid.cl), and unpacks what the
// bodies received.
//
// Rows of a node whose bodies do not move are a chain of their own. The others are one chain, in the host's order: they
// may share bodies. Cost: n log n in the rows of a cloth.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "bullet_plugin/core/solver/solver_cloth.h"
#include "kernels/shared/rigid.h"
#include "kernels/shared/solve_step.h"
#include "word_offsets.h"

namespace drape
{
class PackedRigid
{
public:
    // Returns whether a device should solve a step of so many nodes in which so many rows have bodies that move. It
    // projects these one after the other: on an H200 each takes 13 us of a step.
    static bool isWorthwhile(std::size_t movingRows, std::size_t nodes)
    {
        return movingRows <= std::max(std::size_t(64), nodes / 128);
    }

    // Packs the rows of cloths that are packed as `records`. nodeOrder: by node over all cloths, its index in the
    // caller's order.
    void pack(const std::vector<SolverCloth>& cloths, const std::vector<SolveCloth>& records,
              const std::vector<std::uint32_t>& nodeOrder);
    bool empty() const { return m_chains.empty(); }
    const RigidLayout& layout() const { return m_layout; }

    // Lay out arrays in the input, in the part of the working memory that begins as 0, and in that which is read back.
    void layOutInput(WordOffsets& offsets);
    void layOutStates(WordOffsets& offsets);
    void layOutResults(WordOffsets& offsets);
    void copyTo(SolveInputWord* words) const;
    // Hands a cloth's rows what they gave. words: what layOutResults() placed, as if from the working memory's start.
    void unpack(std::size_t cloth, RigidRows& rows, const SolveWorkWord* words) const;

private:
    // A row of a cloth: the index of its packed node, or kInTurn, and its index in the cloth.
    struct Row
    {
        std::uint32_t m_packedNode;
        bool m_isContact;
        std::uint32_t m_index;
    };
    using Rows = std::vector<Row>;
    static constexpr std::uint32_t kInTurn = UINT32_MAX;

    Rows sortedRows(const RigidRows& rigid) const;
    void packRun(std::size_t turn, const RigidRows& rigid, const Row* first, const Row* last);
    void packRuns(std::size_t turn, const RigidRows& rigid, bool inTurn);

    std::vector<RigidChain> m_chains;
    std::vector<RigidRun> m_runs;
    std::vector<RigidAnchor> m_anchors;
    std::vector<RigidContact> m_contacts;
    std::vector<RigidBody> m_bodies;
    std::vector<RigidGiven> m_given;     // by turn
    std::vector<std::uint32_t> m_turns;  // cloths with rows in the host's order
    RigidLayout m_layout = {};
    std::vector<std::uint32_t> m_packedIndex;  // by node of the cloth that is being packed
};
}  // namespace drape
