// Texts that the log and Plugin::diagnose() share.
#pragma once

#include <cstddef>
#include <string>

#include "drape/contacts.h"

namespace drape
{
// Pairs of triangles or features of two bodies, or of one with itself, that a step did not guard.
struct ClothPairCounts
{
    std::size_t m_intersecting = 0, m_touching = 0, m_forced = 0;

    void add(PairFlag flag);
    // Returns the part of a line that follows the two names.
    std::string text() const;
};
}  // namespace drape
