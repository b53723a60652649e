#include "benchmarks/support/peer_scene.h"

#include <algorithm>
#include <tuple>

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>

#include "bullet_plugin/core/ordering/canonical_order.h"
#include "bullet_plugin/core/scene/normal_cones.h"
#include "drape/settings.h"

namespace drape::bench
{
namespace
{
// Shares a thread takes: some more than one each, so that uneven ones even out.
constexpr std::size_t kSharesPerThread = 8;

void addMesh(MeshPool& pool, const TriangleMesh& mesh, MeshId id)
{
    PooledMesh pooled;
    pooled.m_id = id;
    pooled.m_topology = buildTopology(mesh.m_triangles.data(), mesh.triangleCount(), mesh.vertexCount());
    pool.add(std::move(pooled));
}
}  // namespace

PeerScene::PeerScene(const StepScene& scene) : m_positions(scene.m_obstacle.m_positions)
{
    for (const TriangleMesh& cloth : scene.m_cloths)
        addMesh(m_cloths, cloth, static_cast<MeshId>(m_cloths.meshCount()));
    addMesh(m_obstacles, scene.m_obstacle, 0);
    m_cloths.update();
    m_obstacles.update();
    computeNormalCones(m_obstacles.mesh(0).m_topology, m_positions.data(), m_vertexCones, m_edgeCones);
    m_thickness.assign(m_cloths.meshCount(), scene.m_thickness);
    for (const TriangleMesh& cloth : scene.m_cloths)
        m_rest.insert(m_rest.end(), cloth.m_positions.begin(), cloth.m_positions.end());
    const float reach = scene.m_selfThickness * (1.0f + Settings().m_activation);
    m_self.m_thickness.assign(m_cloths.meshCount(), scene.m_selfThickness);
    m_self.m_radius.assign(m_cloths.meshCount(), selfGrowth(reach));
}

void PeerScene::selfContacts(const std::vector<Candidate>& pairs, const float* start, const float* end, int threads,
                             std::vector<Contact>& contacts) const
{
    const ClothView cloth =
        clothView(start, end, m_cloths.triangles().data(), m_cloths.edges().data(),
                  static_cast<std::uint32_t>(m_cloths.vertexCount()),
                  static_cast<std::uint32_t>(m_cloths.triangles().size()), DRAPE_AUTOMATIC, nullptr);
    const SelfStep step = {m_cloths, selfView(cloth, m_rest.data(), 1.0f + Settings().m_activation), m_self,
                           m_self.m_radius};
    std::vector<Dop> volumes;
    selfVolumes(step, volumes);
    const std::size_t shares = threads == 1 ? 1 : kSharesPerThread * static_cast<std::size_t>(threads);
    std::vector<std::vector<Contact>> parts(shares);
    tbb::task_arena arena(threads);
    arena.execute(
        [&]
        {
            tbb::parallel_for(std::size_t(0), shares,
                              [&](std::size_t share)
                              {
                                  SelfFinder finder(step, volumes);
                                  for (std::size_t i = pairs.size() * share / shares;
                                       i < pairs.size() * (share + 1) / shares; ++i)
                                      finder.visit(pairs[i]);
                                  finder.append(parts[share]);
                              });
        });
    contacts.clear();
    for (const std::vector<Contact>& part : parts)
        contacts.insert(contacts.end(), part.begin(), part.end());
    sortContacts(contacts);
}

void PeerScene::narrowPhase(const std::vector<Candidate>& candidates, const float* start, const float* end, int threads,
                            std::vector<Contact>& contacts) const
{
    const ClothView cloth =
        clothView(start, end, m_cloths.triangles().data(), m_cloths.edges().data(),
                  static_cast<std::uint32_t>(m_cloths.vertexCount()),
                  static_cast<std::uint32_t>(m_cloths.triangles().size()), DRAPE_AUTOMATIC, nullptr);
    const ObstacleView obstacle = {m_positions.data(), m_obstacles.triangles().data(), m_vertexCones.data(),
                                   m_edgeCones.data()};
    const PairSettings settings = {m_thickness, 1, 1.0f + Settings().m_activation};
    if (threads == 1)
    {
        contactsOfPairs(candidates, cloth, obstacle, settings, contacts);
        return;
    }
    const std::size_t shares = kSharesPerThread * static_cast<std::size_t>(threads);
    std::vector<std::vector<Contact>> parts(shares);
    tbb::task_arena arena(threads);
    arena.execute(
        [&]
        {
            tbb::parallel_for(std::size_t(0), shares,
                              [&](std::size_t share)
                              {
                                  const std::size_t first = candidates.size() * share / shares;
                                  const std::size_t last = candidates.size() * (share + 1) / shares;
                                  const std::vector<Candidate> part(candidates.begin() + std::ptrdiff_t(first),
                                                                    candidates.begin() + std::ptrdiff_t(last));
                                  contactsOfPairs(part, cloth, obstacle, settings, parts[share]);
                              });
            contacts.clear();
            for (const std::vector<Contact>& part : parts)
                contacts.insert(contacts.end(), part.begin(), part.end());
            tbb::parallel_sort(contacts.begin(), contacts.end(),
                               [](const Contact& a, const Contact& b) {
                                   return std::tie(a.m_featureIndex, a.m_obstacleFeature) <
                                          std::tie(b.m_featureIndex, b.m_obstacleFeature);
                               });
        });
}
}  // namespace drape::bench
