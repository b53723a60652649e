#include "tree_watch.h"

#include <chrono>
#include <utility>

#include "bullet_plugin/core/broad_phase/host_traversal.h"
#include "bullet_plugin/core/bvh/tree_cost.h"
#include "bullet_plugin/core/threads/blocked_signals.h"

namespace drape
{
namespace
{
// Steps from one measurement to the next: cloth changes its shape over tens of steps.
constexpr std::uint32_t kInterval = 8;
}  // namespace

bool goesOverPatches(const Settings& settings)
{
    return !settings.m_reportIntersections && settings.m_methods.m_traversal == Traversal::Auto;
}

bool watchesClothTree(const Settings& settings, bool onHost)
{
    Traversal traversal = settings.m_methods.m_traversal;
    // On a device none that Auto stands for walks it: device_backend.h and broad_phase.cpp.
    if (onHost && !goesOverPatches(settings)) traversal = HostTraversal::resolve(traversal);
    const bool walksIt = traversal == Traversal::Pairs || traversal == Traversal::Single ||
                         traversal == Traversal::Groups || traversal == Traversal::Front;
    return walksIt && settings.m_methods.m_rebuildDecay > 0.0f;
}

void TreeWatch::begin()
{
    m_superseded = m_rebuilt.valid();
    m_costAtBuild = 0;
    m_step = 0;
}

bool TreeWatch::isDue()
{
    return m_step++ % kInterval == 0;
}

bool TreeWatch::isDecayed(double cost, float rebuildDecay)
{
    if (m_costAtBuild == 0) m_costAtBuild = cost;
    return !m_rebuilt.valid() && drape::isDecayed(cost, m_costAtBuild, rebuildDecay);
}

void TreeWatch::rebuild(const TreeMethods& methods, std::vector<Triangle> triangles,
                        std::vector<std::uint32_t> firstTriangles, std::vector<float> positions)
{
    // Where there is no thread to be had, the step that takes the tree builds it.
    const BlockedSignals blocked;
    m_rebuilt = std::async(std::launch::async | std::launch::deferred,
                           [methods, triangles = std::move(triangles), firsts = std::move(firstTriangles),
                            positions = std::move(positions)]
                           { return buildMeshTrees(methods, triangles, firsts, positions.data()); });
}

void TreeWatch::wait()
{
    if (m_rebuilt.valid()) m_rebuilt.wait();
}

bool TreeWatch::take(RebuiltTrees& rebuilt)
{
    if (!m_rebuilt.valid() || m_rebuilt.wait_for(std::chrono::seconds(0)) == std::future_status::timeout) return false;
    const bool superseded = m_superseded;
    if (superseded)
        m_rebuilt = std::future<RebuiltTrees>();
    else
        rebuilt = m_rebuilt.get();
    begin();
    return !superseded;
}
}  // namespace drape
