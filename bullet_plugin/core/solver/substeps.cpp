#include "substeps.h"

#include <algorithm>
#include <cmath>

namespace drape
{
namespace
{
// Minimum nodes for sharing a pass over them, and the nodes of a range: a pass takes 3 ns a node.
constexpr std::size_t kLeastShared = 8192, kRange = 2048;

// Minimum ratio of correctionTime() to that of the step before. Links correct an error within some ten steps.
constexpr float kLeastRatio = 0.8f;

// Calls work(node) for all nodes.
template <class Work>
void forNodes(std::size_t count, ThreadTeam* threads, const Work& work)
{
    const auto range = [&](std::size_t first, std::size_t last)
    {
        for (std::size_t i = first; i < last; ++i)
            work(i);
    };
    if (!threads || count < kLeastShared) return range(0, count);
    threads->run((count + kRange - 1) / kRange,
                 [&](std::size_t i) { range(i * kRange, std::min(count, (i + 1) * kRange)); });
}
}  // namespace

void Substeps::prepare(float time, int count, float damping, const std::vector<Vec3>& accelerations)
{
    m_time = time;
    m_count = count;
    m_correctionTime = std::max(substepTime(), kLeastRatio * m_correctionTime);
    m_accelerations = &accelerations;
    m_kept = float(std::pow(1 - std::min(1.0, std::max(0.0, double(damping))), 1.0 / count));
}

void Substeps::begin(SolverNodes& nodes, ThreadTeam* threads) const
{
    const float share = pathShare(m_count) * m_time;
    forNodes(nodes.count(), threads,
             [&](std::size_t i)
             {
                 const Vec3 mean = vec3Scale(nodes.way(i), 1 / m_time);
                 nodes.setCurrent(i, vec3(0, 0, 0), vec3AddScaled(mean, (*m_accelerations)[i], -share));
             });
}

void Substeps::advance(SolverNodes& nodes, ThreadTeam* threads)
{
    const float h = substepTime();
    forNodes(nodes.count(), threads,
             [&](std::size_t i)
             {
                 const Vec3 velocity = vec3AddScaled(nodes.velocity(i), (*m_accelerations)[i], h);
                 nodes.setCurrent(i, vec3AddScaled(nodes.displacement(i), velocity, h), velocity);
                 nodes.remember(i);
             });
}

void Substeps::end(SolverNodes& nodes, ThreadTeam* threads) const
{
    const float perSecond = 1 / m_correctionTime;
    forNodes(nodes.count(), threads,
             [&](std::size_t i)
             {
                 const Vec3 correction = vec3Sub(nodes.displacement(i), nodes.remembered(i));
                 nodes.setVelocity(i, vec3Scale(vec3AddScaled(nodes.velocity(i), correction, perSecond), m_kept));
             });
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
