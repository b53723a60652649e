// A scene in the form that the peers and Drape's host narrow phase read: joined topology, cones, and the step's
// positions.
#pragma once

#include <vector>

#include "benchmarks/support/step_scene.h"
#include "bullet_plugin/core/scene/mesh_pool.h"
#include "reference/pair_contacts.h"
#include "reference/self_pairs.h"

namespace drape::bench
{
class PeerScene
{
public:
    explicit PeerScene(const StepScene& scene);

    const std::vector<Triangle>& clothTriangles() const { return m_cloths.triangles(); }
    const std::vector<Triangle>& obstacleTriangles() const { return m_obstacles.triangles(); }
    std::size_t clothNodes() const { return m_cloths.vertexCount(); }
    const std::vector<float>& obstaclePositions() const { return m_positions; }

    // Computes the contacts of the candidates in canonical order, on up to `threads` threads. Each pair has the scene's
    // thickness. `start` and `end` hold x y z per cloth node.
    void narrowPhase(const std::vector<Candidate>& candidates, const float* start, const float* end, int threads,
                     std::vector<Contact>& contacts) const;

    // Computes the contacts of cloths with themselves for pairs of their triangles, each pair once, in the same order.
    void selfContacts(const std::vector<Candidate>& pairs, const float* start, const float* end, int threads,
                      std::vector<Contact>& contacts) const;

private:
    MeshPool m_cloths, m_obstacles;
    std::vector<float> m_positions;  // positions of the obstacle
    std::vector<NormalCone> m_vertexCones, m_edgeCones;
    std::vector<float> m_thickness;
    std::vector<float> m_rest;  // rest positions of the cloths
    SelfReach m_self;
};
}  // namespace drape::bench
