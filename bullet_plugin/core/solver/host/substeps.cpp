#include "substeps.h"

#include <algorithm>
#include <cmath>

#include "bullet_plugin/core/threads/ranges.h"

namespace drape
{
namespace
{
// Minimum nodes for sharing a pass over them, and the nodes of a range: a pass takes 3 ns a node.
constexpr std::size_t kLeastShared = 8192, kRange = 2048;

// Minimum ratio of correctionTime() to that of the step before. Links correct an error within some ten steps. After
// changeOver() a larger ratio halves the greatest speed of cloth whose links contract (0.09 against 0.17 m/s).
constexpr float kLeastRatio = 0.8f, kRatioAfterChange = 0.9f;

// Maximum damping with which nodes settle.
constexpr float kMostSettledDamping = 0.5f;

// Calls work(node) for all nodes.
template <class Work>
void forNodes(std::size_t count, ThreadTeam* threads, const Work& work)
{
    const auto range = [&](std::size_t first, std::size_t last)
    {
        for (std::size_t i = first; i < last; ++i)
            work(i);
    };
    forRanges(count, kLeastShared, kRange, threads, range);
}
}  // namespace

void Substeps::prepare(float time, int count, float damping, const std::vector<Vec3>& accelerations,
                       const std::vector<Vec3>& supports, float spread)
{
    m_time = time;
    m_spread = spread;
    m_count = count;
    if (m_changesOver) m_leastRatio = kRatioAfterChange;
    m_correctionTime = m_changesOver ? std::max(time, m_correctionTime) : m_leastRatio * m_correctionTime;
    m_changesOver = false;
    if (m_correctionTime <= substepTime())
    {
        m_correctionTime = substepTime();
        m_leastRatio = kLeastRatio;
    }
    m_accelerations = &accelerations;
    m_supports = &supports;
    m_settles = damping <= kMostSettledDamping;
    m_undamped = float(std::pow(1 - std::min(1.0, std::max(0.0, double(damping))), 1.0 / count));
}

void Substeps::begin(SolverNodes& nodes, ThreadTeam* threads)
{
    m_links.start(nodes.paths(), threads);
    forNodes(nodes.count(), threads,
             [&](std::size_t i)
             {
                 nodeBegin(nodes.nodes() + i, nodes.states() + i, nodes.pathVector(i),
                           vec3AddScaled(supports()[i], accelerations()[i], m_spread), perStep(), pathTime());
             });
}

void Substeps::advance(SolverNodes& nodes, ThreadTeam* threads)
{
    forNodes(nodes.count(), threads,
             [&](std::size_t i) {
                 nodeAdvance(nodes.nodes() + i, nodes.states() + i, vec3Scale(accelerations()[i], m_spread),
                             substepTime());
             });
}

void Substeps::end(SolverNodes& nodes, ThreadTeam* threads) const
{
    forNodes(nodes.count(), threads,
             [&](std::size_t i) { nodeEnd(nodes.nodes() + i, nodes.states() + i, 1 / m_correctionTime, m_undamped); });
}

void Substeps::run(SolverNodes& nodes, ThreadTeam* threads)
{
    begin(nodes, threads);
    for (int i = 0; i < m_count; ++i)
    {
        advance(nodes, threads);
        for (int k = 0; k < kLinkSweeps; ++k)
            sweepLinks(nodes, threads);
        end(nodes, threads);
    }
}
}  // namespace drape
