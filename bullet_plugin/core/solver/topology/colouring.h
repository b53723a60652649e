// Colours constraints so that two of one colour share no node: they may be solved in any order, or side by side.
//
// Each constraint gets the first colour that is free at all of its nodes. Constraints that find none free share the
// last colour, and must be solved one after the other. Cost: a few nanoseconds per constraint.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bullet_plugin/core/platform/compiler.h"

namespace drape
{
constexpr std::uint32_t kColours = 64, kLastColour = kColours - 1;

class Colouring
{
public:
    // Begins with no colours taken.
    void resize(std::size_t nodeCount) { m_taken.assign(nodeCount, 0); }
    // Takes a colour for a constraint. nodes: `count` indices, which may repeat.
    template <class Index>
    std::uint32_t take(const Index* nodes, std::size_t count)
    {
        std::uint64_t taken = 0;
        for (std::size_t k = 0; k < count; ++k)
            taken |= m_taken[std::size_t(nodes[k])];
        const std::uint32_t colour = ~taken == 0 ? kLastColour : std::uint32_t(trailingZeros(~taken));
        for (std::size_t k = 0; k < count; ++k)
            m_taken[std::size_t(nodes[k])] |= std::uint64_t(1) << colour;
        return colour;
    }
    // Frees all colours of some nodes.
    template <class Index>
    void release(const Index* nodes, std::size_t count)
    {
        for (std::size_t k = 0; k < count; ++k)
            m_taken[std::size_t(nodes[k])] = 0;
    }

private:
    std::vector<std::uint64_t> m_taken;  // by node, a bit for each colour
};
}  // namespace drape
