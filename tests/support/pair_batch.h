// Single triangle pairs through a whole pipeline: what the triangle test says of each, and their contacts.
//
// Each pair is a cloth of one triangle and an obstacle of one triangle, at their places without any shift, tested with
// each other only. Lengths in metres.
#pragma once

#include <array>
#include <vector>

#include "tests/support/pipeline_driver.h"

namespace drape::test
{
using Corners = std::array<float, 9>;  // x y z of three corners

struct TrianglePair
{
    Corners m_cloth, m_obstacle;
};

struct BatchResult
{
    std::size_t m_intersecting = 0;                // pairs that the triangle test does not separate
    std::vector<std::vector<Contact>> m_contacts;  // per pair
    std::vector<Contact> m_all;
};

// Runs all pairs at the thickness (m). Records a failure and returns nothing if there is no pipeline.
BatchResult runBatch(const Settings& settings, const std::vector<TrianglePair>& pairs, float thickness);

// Returns the pair in all 36 orders of its corners.
std::vector<TrianglePair> allOrders(const TrianglePair& pair);

// Fails the test unless every number of each contact is finite and each normal has length one.
void expectFinite(const std::vector<Contact>& contacts);
}  // namespace drape::test
