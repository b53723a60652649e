#include "bullet_plugin/core/stopwatch.h"
#include "reference/pair_contacts.h"
#include "study/step/tree_step.h"

namespace drape
{
namespace
{
TreeSide sideOf(const Tree& tree, const MeshPool& pool)
{
    return {{tree.m_nodes, 0, tree.m_order}, pool.triangles()};
}
}  // namespace

HostTreeStep::HostTreeStep(TreeScene& scene, Traversal traversal) : m_scene(scene), m_traversal(traversal)
{
    m_traversal.setTopology(sideOf(scene.m_clothTree, scene.m_cloths).m_tree,
                            sideOf(scene.m_obstacleTree, scene.m_obstacles).m_tree);
}

bool HostTreeStep::run(const float* start, const float* end, TreeStepResult& result)
{
    result = TreeStepResult();
    Stopwatch watch;
    std::size_t ignored = 0;
    refitTreeOnHost(m_scene.m_clothTree, m_scene.m_cloths.triangles(), start, end, m_scene.m_radius, ignored);
    result.m_refitMs = watch.lapMs();
    m_traversal.run(sideOf(m_scene.m_clothTree, m_scene.m_cloths), sideOf(m_scene.m_obstacleTree, m_scene.m_obstacles),
                    m_scene.m_thickness, 1, m_candidates);
    result.m_candidates = m_candidates.size();
    result.m_volumeTests = m_traversal.volumeTests();
    result.m_broadMs = watch.lapMs();
    const PairSettings settings = {m_scene.m_thickness, 1, m_scene.m_reachScale};
    contactsOfPairs(m_candidates, m_scene.cloth(start, end, DRAPE_AUTOMATIC), m_scene.obstacle(), settings,
                    result.m_contacts);
    result.m_narrowMs = watch.lapMs();
    return true;
}
}  // namespace drape
