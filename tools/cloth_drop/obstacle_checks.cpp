#include "tools/cloth_drop/obstacle_checks.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace drape
{
namespace
{
std::size_t invalidNodes(const std::vector<float>& positions)
{
    std::size_t count = 0;
    for (std::size_t i = 0; i < positions.size(); i += 3)
        count += !(std::isfinite(positions[i]) && std::isfinite(positions[i + 1]) && std::isfinite(positions[i + 2]));
    return count;
}

std::vector<std::size_t> nodesAgainst(const RunSubject& subject, std::size_t obstacle)
{
    std::vector<std::size_t> nodes;
    for (std::size_t node = 0; node < subject.m_cloths.vertexCount(); ++node)
    {
        const auto passes = [&](const PassingCloth& cloth)
        { return cloth.m_obstacle == obstacle && node >= cloth.m_firstNode && node < cloth.m_lastNode; };
        if (std::none_of(subject.m_passing.begin(), subject.m_passing.end(), passes)) nodes.push_back(node);
    }
    return nodes;
}

std::vector<float> positionsOf(const std::vector<std::size_t>& nodes, const std::vector<float>& all)
{
    std::vector<float> positions;
    positions.reserve(3 * nodes.size());
    for (const std::size_t node : nodes)
        positions.insert(positions.end(), &all[3 * node], &all[3 * node] + 3);
    return positions;
}

// Returns the triangles whose corners are all among the nodes, which are in ascending order, as indices into them.
std::vector<std::int32_t> trianglesOf(const std::vector<std::size_t>& nodes, const std::vector<std::int32_t>& all)
{
    std::vector<std::int32_t> triangles;
    for (std::size_t i = 0; i < all.size(); ++i)
    {
        const auto at = std::lower_bound(nodes.begin(), nodes.end(), std::size_t(all[i]));
        // A cloth has all of its nodes, or none.
        if (at != nodes.end() && *at == std::size_t(all[i])) triangles.push_back(std::int32_t(at - nodes.begin()));
    }
    return triangles;
}

void add(const StepMeasure& other, StepMeasure& all)
{
    all.m_penetrationMax = std::max(all.m_penetrationMax, other.m_penetrationMax);
    all.m_gapMin = std::min(all.m_gapMin, other.m_gapMin);
    all.m_nodeDepths.insert(all.m_nodeDepths.end(), other.m_nodeDepths.begin(), other.m_nodeDepths.end());
    all.m_intersectingPairs += other.m_intersectingPairs;
}
}  // namespace

ObstacleChecks::ObstacleChecks(const RunSubject& subject)
{
    for (std::size_t i = 0; i < subject.m_obstacles.size(); ++i)
    {
        std::vector<std::size_t> nodes = nodesAgainst(subject, i);
        const TriangleMesh cloths = {subject.m_starts[i].into(positionsOf(nodes, subject.m_cloths.m_positions)),
                                     trianglesOf(nodes, subject.m_cloths.m_triangles)};
        const TriangleMesh& obstacle = subject.m_obstacles[i];
        m_checks.push_back(std::make_unique<Check>(
            Check{std::move(nodes), PenetrationMeter(obstacle, cloths), Crossings(obstacle, cloths.m_positions)}));
    }
}

StepMeasure ObstacleChecks::measure(const std::vector<float>& positions, const std::vector<ObstacleFrame>& frames)
{
    StepMeasure all;
    for (std::size_t i = 0; i < m_checks.size(); ++i)
    {
        const std::vector<float> own = frames[i].into(positionsOf(m_checks[i]->m_nodes, positions));
        StepMeasure measure = m_checks[i]->m_meter.measure(own.data());
        m_checks[i]->m_crossings.follow(own);
        if (i == 0)
            all = std::move(measure);
        else
            add(measure, all);
    }
    all.m_invalidNodes = invalidNodes(positions);
    return all;
}

std::size_t ObstacleChecks::nodesThrough() const
{
    std::vector<bool> through;
    for (const std::unique_ptr<Check>& check : m_checks)
    {
        const std::vector<bool>& crossed = check->m_crossings.crossed();
        for (std::size_t i = 0; i < crossed.size(); ++i)
        {
            const std::size_t node = check->m_nodes[i];
            if (node >= through.size()) through.resize(node + 1);
            if (crossed[i]) through[node] = true;
        }
    }
    return std::size_t(std::count(through.begin(), through.end(), true));
}
}  // namespace drape
