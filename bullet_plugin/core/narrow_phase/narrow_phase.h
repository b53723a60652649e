// Narrow phase: determines which candidates touch. A device lists unsorted contacts, which ordering sorts; the host
// lists contacts in canonical order at once. Both give the same contacts, bit for bit.
#pragma once

#include <cstdint>
#include <vector>

#include "bullet_plugin/core/broad_phase/patch_cull.h"
#include "bullet_plugin/core/ordering/hit_buffers.h"
#include "bullet_plugin/core/device/buffer.h"
#include "bullet_plugin/core/device/program.h"
#include "kernels/lib/pair_contact.h"

namespace drape
{
// Device buffers of both sides' geometry.
struct NarrowPhaseBuffers
{
    Buffer<float>& m_clothStart;
    Buffer<float>& m_clothEnd;
    Buffer<Triangle>& m_clothTriangles;
    Buffer<Edge>& m_clothEdges;
    Buffer<float>& m_obstaclePositions;
    Buffer<Triangle>& m_obstacleTriangles;
    Buffer<NormalCone>& m_vertexCones;
    Buffer<NormalCone>& m_edgeCones;
    Buffer<float>& m_thickness;
    Buffer<ObstacleMotion>& m_motions;
    std::size_t m_motionCount = 0;
};

class NarrowPhaseStage
{
public:
    struct Expected
    {
        std::size_t m_tests;      // about this many; affects speed alone
        std::size_t m_mostSwept;  // if more tests need the continuous test, their contacts are not listed
    };

    void create(Device& device, const ProgramLoader& load);

    // Returns after enqueueing. Lists the hits of the feature tests that a cull left. mode: DRAPE_DISCRETE …; a
    // discrete step is one launch less, and so is one with few tests.
    void enqueueFeatures(Device& device, NarrowPhaseBuffers sides, std::size_t nodeCount, std::size_t triangleCount,
                         std::uint32_t mode, PatchCullStage& cull, Expected expected, HitBuffers hits,
                         Buffer<StepCounters>& counters);
    // Returns whether the launch did nothing because there were `tests` tests and far fewer were expected.
    bool skipped(std::size_t tests) const { return tests > m_mostTests; }

private:
    std::size_t m_mostTests = SIZE_MAX;  // tests of the last launches
    Kernel m_feature, m_swept, m_few;
    Buffer<cl_uint> m_sweptTests{"step candidates"};
};
}  // namespace drape
