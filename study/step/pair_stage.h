// Contacts of the pairs of triangles that a traversal listed, on a device: those of contactsOfPairs(), bit for bit, as
// unsorted hits that a ordering puts in order. Cost: linear in the pairs.
#pragma once

#include "bullet_plugin/core/ordering/hit_buffers.h"
#include "bullet_plugin/core/device/program.h"
#include "study/kernels/shared/traversal.h"

namespace drape
{
// Device buffers that hold both sides' geometry.
struct PairSides
{
    Buffer<float>& m_clothStart;
    Buffer<float>& m_clothEnd;
    Buffer<Triangle>& m_clothTriangles;
    Buffer<Edge>& m_clothEdges;
    Buffer<float>& m_obstaclePositions;
    Buffer<Triangle>& m_obstacleTriangles;
    Buffer<NormalCone>& m_vertexCones;
    Buffer<NormalCone>& m_edgeCones;
    Buffer<float>& m_thickness;                 // m, cloth slots × obstacle slots
    std::size_t m_clothNodes, m_triangleCount;  // of the cloths
    std::size_t m_obstacleMeshes;
    float m_reachScale;
    std::uint32_t m_mode;  // DRAPE_DISCRETE …
};

class PairStage
{
public:
    void create(Device& device, const ProgramLoader& load);

    // Returns after enqueueing. found: the traversal's counters; counters: the step's.
    void enqueue(Device& device, PairSides sides, Buffer<Candidate>& candidates, Buffer<TraversalCounters>& found,
                 HitBuffers hits, Buffer<StepCounters>& counters);

private:
    Kernel m_test;
};
}  // namespace drape
