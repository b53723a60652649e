// Maximum lengths of a step's lists, from the settings.
#pragma once

#include <algorithm>
#include <cstddef>

#include "drape/settings.h"

namespace drape
{
// Most candidates and contacts that a step can have: their numbers stay countable in 32 bits.
constexpr std::size_t kMostCandidates = std::size_t(1) << 28;

// Returns the room to make for a list that needs so many elements.
inline std::size_t withHeadroom(std::size_t count)
{
    return count + count / 4 + 1024;
}

struct StepLimits
{
    explicit StepLimits(const Settings& settings)
        : m_candidates(std::min(settings.m_candidateLimit, kMostCandidates)),
          m_contacts(std::min(settings.m_contactLimit, kMostCandidates))
    {
    }
    std::size_t m_candidates;
    std::size_t m_contacts;
};
}  // namespace drape
