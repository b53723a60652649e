// Contacts of given pairs of triangles, by the functions of kernels/lib on the calling thread: what tests, benchmarks
// and the study hold a step against.
//
// Input: pairs of a cloth and an obstacle triangle, in any order. Output: contacts in canonical order. Guarantee: the
// contacts of a step, bit for bit, where the pairs have every pair of triangles within reach. Cost: linear in the
// pairs.
#pragma once

#include <cstdint>
#include <vector>

#include "bullet_plugin/core/scene/mesh_pool.h"
#include "kernels/lib/geometry/rigid_motion.h"
#include "kernels/lib/step_data/step_views.h"

namespace drape
{
// Motions of the obstacles that move in the step, in the order of slots.
struct MotionList
{
    const ObstacleMotion* m_motions = nullptr;
    std::uint32_t m_count = 0;

    const ObstacleMotion* find(std::uint32_t mesh) const { return findMotion(m_motions, m_count, mesh); }
};

// Options and per-pair data of a step. mode: DRAPE_DISCRETE …. thickness: m, cloth slots × obstacle slots. Contacts
// reach to thickness × reachScale.
struct PairSettings
{
    const std::vector<float>& m_thickness;
    std::size_t m_obstacleMeshes;
    float m_reachScale;
    std::uint32_t m_mode = DRAPE_AUTOMATIC;
    MotionList m_motions = {};
};

// Contacts, and pairs of features that the continuous test decided.
struct PairCounts
{
    std::uint64_t m_contacts = 0;
    std::uint64_t m_swept = 0;
};

PairCounts contactsOfPairs(const std::vector<Candidate>& candidates, const ClothView& cloth,
                           const ObstacleView& obstacle, const PairSettings& settings, std::vector<Contact>& contacts);

// Returns the pairs whose triangles intersect at the step's start, in order of cloth and obstacle triangle.
std::vector<Candidate> intersectingPairs(const std::vector<Candidate>& candidates, const ClothView& cloth,
                                         const ObstacleView& obstacle, const MotionList& motions);

// Returns the triangle of each leaf over all meshes of the pool, one mesh after the other, each in its own leaf order.
std::vector<std::uint32_t> joinedOrder(const MeshPool& pool);
}  // namespace drape
