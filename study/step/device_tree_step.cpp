#include <algorithm>
#include <cstring>

#include "study/kernel_programs.h"
#include "study/step/tree_step.h"
#include "study/traversal/front_traversal.h"
#include "study/traversal/grid_traversal.h"
#include "study/traversal/single_traversal.h"

namespace drape
{
namespace
{
// First guesses; they grow to what scenes need.
constexpr std::size_t kFirstCandidates = 1 << 16;
constexpr std::size_t kFirstContacts = 1 << 13;

std::size_t withHeadroom(std::size_t count)
{
    return count + count / 4 + 1024;
}
}  // namespace

std::unique_ptr<DeviceTraversal> makeTraversal(Device& device, Traversal traversal, const ProgramLoader& load)
{
    if (traversal == Traversal::Single) return std::make_unique<SingleTraversal>(device, load("broad_phase_single"));
    if (traversal == Traversal::Grid) return std::make_unique<GridTraversal>(device, load);
    return std::make_unique<FrontTraversal>(device, load("broad_phase_front"), traversal == Traversal::Front);
}

void DeviceTreeStep::Side::upload(Device& device, const Tree& tree, const std::vector<Triangle>& triangles,
                                  const std::vector<float>& radius)
{
    m_tree.upload(device, tree);
    m_triangles.assign(device, triangles);
    m_radius.assign(device, radius);
    device.wait();
}

DeviceTreeStep::DeviceTreeStep(Device& device, const TreeScene& scene, const Methods& methods,
                               const std::string& cacheFolder)
    : m_device(device), m_scene(scene), m_methods(methods)
{
    const ProgramLoader load =
        studyPrograms(device, cacheFolder, methods.m_countTests ? "#define DRAPE_COUNT_VISITS\n" : "");
    m_refit.create(device, load);
    m_traversal = makeTraversal(device, methods.m_traversal, load);
    m_pairs.create(device, load);
    m_ordering.create(device, load);
    m_candidates.reserve(device, kFirstCandidates);
    reserveContacts(kFirstContacts);
    m_found.reserve(device, 1);
    m_ignored.reserve(device, 1);
    for (Buffer<StepCounters>& counters : m_counters)
    {
        counters.reserve(device, 1);
        counters.fill(device, 0, 1);
    }
    if (!device.failed()) upload();
}

void DeviceTreeStep::upload()
{
    m_cloth.upload(m_device, m_scene.m_clothTree, m_scene.m_cloths.triangles(), m_scene.m_radius);
    m_obstacle.upload(m_device, m_scene.m_obstacleTree, m_scene.m_obstacles.triangles(), {0.0f});
    m_start.reserve(m_device, 3 * m_scene.m_cloths.vertexCount());
    m_end.reserve(m_device, 3 * m_scene.m_cloths.vertexCount());
    m_thickness.assign(m_device, m_scene.m_thickness);
    uploadGeometry();
    m_unsorted.resizeFeatures(m_device, m_scene.featureCount());
    m_ordering.resizeFeatures(m_device, m_scene.featureCount());
    m_refit.prepare(m_device, m_cloth.m_tree, m_methods.m_tree);
    const Tree &cloth = m_scene.m_clothTree, &obstacle = m_scene.m_obstacleTree;
    m_traversal->setTopology(m_device, {cloth.m_nodes, 0, cloth.m_order}, {obstacle.m_nodes, 0, obstacle.m_order});
    m_device.wait();
}

void DeviceTreeStep::uploadGeometry()
{
    const MeshPool &cloths = m_scene.m_cloths, &obstacles = m_scene.m_obstacles;
    m_clothTriangles.demand(cloths.triangles().size());
    m_edges.demand(cloths.edges().size());
    m_clothArena.make(m_device);
    m_clothTriangles.append(m_device, cloths.triangles());
    m_edges.append(m_device, cloths.edges());
    m_positions.demand(m_scene.m_obstaclePositions.size());
    m_vertexCones.demand(m_scene.m_vertexCones.size());
    m_edgeCones.demand(m_scene.m_edgeCones.size());
    m_obstacleTriangles.demand(obstacles.triangles().size());
    m_obstacleArena.make(m_device);
    m_positions.append(m_device, m_scene.m_obstaclePositions);
    m_vertexCones.append(m_device, m_scene.m_vertexCones);
    m_edgeCones.append(m_device, m_scene.m_edgeCones);
    m_obstacleTriangles.append(m_device, obstacles.triangles());
}

PairSides DeviceTreeStep::pairSides() const
{
    const MeshPool& cloths = m_scene.m_cloths;
    const ClothLayout layout = {m_clothTriangles.word(),
                                m_edges.word(),
                                0,
                                0,
                                cl_uint(cloths.vertexCount()),
                                cl_uint(cloths.triangles().size()),
                                cl_uint(cloths.edges().size())};
    const ObstacleBuffers obstacles = {
        m_obstacleArena, {m_positions.word(), m_vertexCones.word(), m_edgeCones.word(), m_obstacleTriangles.word()}};
    return {m_start, m_end, m_clothArena, layout, obstacles, m_thickness, 1, m_scene.m_reachScale, DRAPE_AUTOMATIC};
}

void DeviceTreeStep::reserveContacts(std::size_t count)
{
    m_unsorted.reserve(m_device, count);
    m_ordering.reserve(m_device, count);
}

void DeviceTreeStep::enqueue()
{
    m_turn = 1 - m_turn;
    Buffer<StepCounters>& counters = m_counters[m_turn];
    m_found.fill(m_device, 0, 1);
    m_refit.enqueue(m_device, m_cloth.m_tree, {m_cloth.m_triangles, m_start, m_end, m_cloth.m_radius, m_ignored},
                    m_methods.m_tree);
    m_traversal->enqueue(m_device,
                         {m_cloth.traversed(), m_obstacle.traversed(), m_thickness, 1, m_candidates, m_found});
    m_pairs.enqueue(m_device, pairSides(), m_candidates, m_found, m_unsorted, counters);
    m_ordering.enqueue(m_device, m_unsorted, {counters, m_counters[1 - m_turn]});
    read(m_asked);
    m_found.read(m_device, &m_foundRead, 1);
}

void DeviceTreeStep::read(std::size_t contacts)
{
    m_read.resize(std::max(m_read.size(), DRAPE_CONTACT_HEAD + contacts));
    m_ordering.contacts().read(m_device, m_read.data(), DRAPE_CONTACT_HEAD + contacts);
}

bool DeviceTreeStep::grow(const StepCounters& counters, bool& limitReached)
{
    bool again = m_traversal->grow(m_device, m_foundRead, limitReached);
    if (m_foundRead.m_candidates > m_candidates.capacity())
    {
        again = true;
        m_candidates.reserve(m_device, withHeadroom(m_foundRead.m_candidates));
    }
    if (counters.m_contactsFound > m_unsorted.capacity())
    {
        again = true;
        reserveContacts(withHeadroom(counters.m_contactsFound));
    }
    return again;
}

bool DeviceTreeStep::run(const float* start, const float* end, TreeStepResult& result)
{
    result = TreeStepResult();
    m_start.write(m_device, start, 3 * m_scene.m_cloths.vertexCount());
    m_end.write(m_device, end, 3 * m_scene.m_cloths.vertexCount());
    StepCounters counters = {};
    bool limitReached = false;
    for (bool again = true; again && !m_device.failed(); result.m_retries += again)
    {
        enqueue();
        m_device.wait();
        std::memcpy(&counters, m_read.data(), sizeof(counters));
        again = grow(counters, limitReached);
        if (limitReached) return false;
    }
    if (m_device.failed()) return false;
    m_traversal->accept(m_device, m_foundRead);
    if (counters.m_contactsStored > m_asked)
    {
        read(counters.m_contactsStored);
        m_device.wait();
    }
    const auto first = m_read.begin() + DRAPE_CONTACT_HEAD;
    result.m_contacts.assign(first, first + std::ptrdiff_t(counters.m_contactsStored));
    m_asked =
        std::min<std::size_t>(counters.m_contactsStored + counters.m_contactsStored / 16 + 256, m_unsorted.capacity());
    result.m_candidates = m_foundRead.m_candidates;
    result.m_volumeTests = m_foundRead.m_visits;
    return !m_device.failed();
}
}  // namespace drape
