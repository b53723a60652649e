// Ear clipping of one simple polygon in the plane.
//
// A corner is an ear where its triangle turns to the left and holds no other corner that does not. An ear that is
// blocked waits for its blocker alone, and blockers are found in a k-d tree of the corners, so that outlines with many
// thousands of corners are quick.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

namespace drape
{
using Point2 = std::array<double, 2>;

class EarClipping
{
public:
    enum class Outcome
    {
        Simple,
        NotSimple,  // no ear was left, since the outline meets itself: triangles may overlap
        TooLong     // given up after kMostVisits boxes per corner; not all triangles are there
    };

    // Splits the polygon, whose area must not be negative. Appends three corner numbers per triangle.
    Outcome split(const std::vector<Point2>& outline, std::vector<std::int32_t>& triangles);

private:
    using Corner = std::uint32_t;

    // The bounds of all corners in a subtree, and the number of those that can block an ear.
    struct Box
    {
        double m_low[2], m_high[2];
        std::uint32_t m_blockers;
    };

    void start(const std::vector<Point2>& outline);
    void buildTree();
    void sortSubtree(std::size_t node, std::size_t first, std::size_t last);
    void setBlocker(Corner corner, bool blocks);
    void update(Corner corner);
    void push(Corner corner);
    bool popCandidate(Corner& corner);
    Corner pickAny();
    void clip(Corner corner, std::vector<std::int32_t>& triangles);
    bool turnsLeft(Corner corner) const;
    Corner findBlocker(Corner corner);
    bool isOutside(const Box& box, const Point2* ear) const;
    bool blocks(Corner corner, const Point2* ear) const;

    static constexpr Corner kNone = 0xffffffffu;
    static constexpr std::uint64_t kMostVisits = 2000;

    std::vector<Point2> m_points;
    std::vector<Corner> m_previous, m_next;
    std::vector<char> m_isRemoved, m_isQueued, m_isBlocker;
    std::vector<std::vector<Corner>> m_waiting;  // for each corner, the ears that it blocks
    std::deque<Corner> m_queue;
    std::vector<Corner> m_order;        // corners in the order of the tree's leaves
    std::vector<std::size_t> m_leafOf;  // for each corner
    std::vector<Box> m_boxes;           // a complete binary tree: the children of i are 2 i and 2 i + 1
    std::size_t m_leaves = 0;
    std::uint64_t m_visits = 0;
    Corner m_head = 0;  // a corner that is left
};
}  // namespace drape
