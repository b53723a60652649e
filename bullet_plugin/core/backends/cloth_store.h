// A scene's cloths on a device: topology, the nodes of a step, and the step's pairs. Cost: cloths that are added are
// uploaded; a step uploads its nodes, and what changed of its pairs.
#pragma once

#include <vector>

#include "bullet_plugin/core/lists/step_pairs.h"
#include "bullet_plugin/core/scene/device_views.h"
#include "bullet_plugin/core/scene/scene.h"

namespace drape
{
class ClothStore
{
public:
    // Uploads the next scene, and the next step's pairs, whatever was sent before.
    void forget();

    // Returns whether the device has the scene's topology.
    bool knows(const Scene& scene) const { return m_revision == scene.m_cloths.revision(); }
    // Uploads the topology of new cloths. Returns after enqueueing; the scene must stay unchanged until a wait for the
    // device.
    void update(Device& device, const Scene& scene);
    // Uploads nodes of the step, from node `first` on.
    void writeNodes(Device& device, const Scene& scene, std::size_t first, std::size_t count);
    // Uploads what changed of the step's pairs.
    void writePairs(Device& device, const StepPairs& pairs);

    // Nodes of the step, laid out like ClothNodes.
    Buffer<float>& nodes() { return m_nodes; }
    ClothBuffers cloths() const { return {m_nodes, m_topology, m_layout}; }
    PairBuffers pairs(const Scene& scene, const StepPairs& pairs) const
    {
        return {m_radius, m_thickness, m_motions, pairs.m_motions.size(), scene.m_obstacles.meshCount()};
    }

private:
    std::uint32_t m_revision = 0;
    Arena<ClothWord> m_topology;
    ArenaArray<Triangle> m_triangles{m_topology, "cloth triangles"};
    ArenaArray<Edge> m_edges{m_topology, "cloth edges"};
    ArenaArray<cl_uint> m_order{m_topology, "cloth order"};
    ClothLayout m_layout = {};
    std::vector<cl_uint> m_clustered;  // order of the triangles
    Buffer<float> m_nodes{"cloth positions"};
    Buffer<float> m_radius{"cloth meshes"}, m_thickness{"pairs of meshes"};
    Buffer<ObstacleMotion> m_motions{"obstacle places"};
    std::vector<float> m_sentRadius, m_sentThickness;
    std::vector<ObstacleMotion> m_sentMotions;
};
}  // namespace drape
