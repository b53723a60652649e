#include "tools/cloth_drop/obstacle_checks.h"

#include <algorithm>
#include <cmath>

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
        const TriangleMesh cloths = {subject.m_starts[i].into(subject.m_cloths.m_positions),
                                     subject.m_cloths.m_triangles};
        const TriangleMesh& obstacle = subject.m_obstacles[i];
        m_checks.push_back(std::make_unique<Check>(
            Check{PenetrationMeter(obstacle, cloths), Crossings(obstacle, cloths.m_positions)}));
    }
}

StepMeasure ObstacleChecks::measure(const std::vector<float>& positions, const std::vector<ObstacleFrame>& frames)
{
    StepMeasure all;
    if (m_checks.empty()) all.m_invalidNodes = invalidNodes(positions);
    for (std::size_t i = 0; i < m_checks.size(); ++i)
    {
        const std::vector<float> own = frames[i].into(positions);
        StepMeasure measure = m_checks[i]->m_meter.measure(own.data());
        m_checks[i]->m_crossings.follow(own);
        if (i == 0)
            all = std::move(measure);
        else
            add(measure, all);
    }
    return all;
}

std::size_t ObstacleChecks::nodesThrough() const
{
    std::vector<bool> through;
    for (const std::unique_ptr<Check>& check : m_checks)
    {
        const std::vector<bool>& crossed = check->m_crossings.crossed();
        through.resize(crossed.size());
        for (std::size_t node = 0; node < crossed.size(); ++node)
            if (crossed[node]) through[node] = true;
    }
    return std::size_t(std::count(through.begin(), through.end(), true));
}
}  // namespace drape
