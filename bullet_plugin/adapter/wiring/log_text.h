// Texts that the log and Plugin::diagnose() share.
#pragma once

#include <cstddef>
#include <string>

#include "BulletSoftBody/btSoftBody.h"
#include "drape/contacts.h"

namespace drape
{
std::string nameOf(const btSoftBody& body);

// Pairs of triangles or features of two bodies, or of one with itself, that a step did not guard.
struct ClothPairCounts
{
    std::size_t m_intersecting = 0, m_touching = 0, m_forced = 0;

    void add(PairFlag flag);
};

// Returns one line about two bodies, which may be the same one.
std::string clothPairText(const btSoftBody& body, const btSoftBody& other, const ClothPairCounts& counts);
}  // namespace drape
