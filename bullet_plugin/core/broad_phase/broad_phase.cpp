#include "broad_phase.h"

#include "front_traversal.h"
#include "leaf_traversal.h"
#include "pair_traversal.h"
#include "single_traversal.h"
#include "wide_traversal.h"

namespace drape
{
void BroadPhaseStage::create(Device& device, Traversal traversal, const Programs& program)
{
    if (traversal == Traversal::Auto) traversal = device.isGpu() ? Traversal::WideGroups : Traversal::WideLeaves;
    switch (traversal)
    {
        case Traversal::Pairs:
            m_traversal.reset(new PairTraversal(device, program("broad_phase")));
            break;
        case Traversal::Single:
            m_traversal.reset(new SingleTraversal(device, program("broad_phase_single")));
            break;
        case Traversal::Groups:
        case Traversal::Front:
            m_traversal.reset(new FrontTraversal(device, program("broad_phase_front"), traversal == Traversal::Front));
            break;
        case Traversal::Leaves:
            m_traversal.reset(new LeafTraversal(device, program("broad_phase_leaves")));
            break;
        default:
            m_traversal.reset(
                new WideTraversal(device, program("broad_phase_wide"), traversal == Traversal::WideGroups));
            break;
    }
}

void BroadPhaseStage::setObstacles(Device& device, const Hierarchy& obstacle)
{
    if (!obstacle.empty()) m_traversal->setObstacles(device, obstacle);
}

void BroadPhaseStage::setTopology(Device& device, const Hierarchy& cloth, const Hierarchy& obstacle)
{
    m_empty = cloth.empty() || obstacle.empty();
    if (!m_empty) m_traversal->setTopology(device, cloth, obstacle);
}

void BroadPhaseStage::enqueue(Device& device, const TraversalStep& step)
{
    if (!m_empty) m_traversal->enqueue(device, step);
}
}  // namespace drape
