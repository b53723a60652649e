// The independent checks of a run against each of its obstacles, in the obstacle's frame (oracle/measure.h,
// oracle/crossings.h).
//
// Cloth that passes through an obstacle because its anchors say so is not checked against it.
// Positions are rounded to float32 in the frame of an obstacle that has another pose than the world.
#pragma once

#include <memory>
#include <vector>

#include "oracle/crossings.h"
#include "oracle/measure.h"
#include "tools/cloth_drop/run_subject.h"

namespace drape
{
class ObstacleChecks
{
public:
    // The subject must outlive the checks.
    explicit ObstacleChecks(const RunSubject& subject);

    // Measures the nodes' new places (x y z each, m) among the obstacles where they are. To be called after every step.
    // Depths, gaps and pairs of all obstacles are taken together.
    StepMeasure measure(const std::vector<float>& positions, const std::vector<ObstacleFrame>& frames);
    // Returns the number of nodes that ever went through a surface.
    std::size_t nodesThrough() const;

private:
    struct Check
    {
        std::vector<std::size_t> m_nodes;  // the nodes that are checked against this obstacle
        PenetrationMeter m_meter;
        Crossings m_crossings;
    };
    std::vector<std::unique_ptr<Check>> m_checks;
};
}  // namespace drape
