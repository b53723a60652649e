// Narrow phase: determines which candidates touch. A device lists unsorted contacts, which compaction sorts; the host
// lists contacts in canonical order at once. Both give the same contacts, bit for bit.
#pragma once

#include <cstdint>
#include <vector>

#include "bullet_plugin/core/broad_phase/patch_cull.h"
#include "bullet_plugin/core/compaction/hit_buffers.h"
#include "bullet_plugin/core/device/buffer.h"
#include "bullet_plugin/core/device/program.h"
#include "kernels/lib/pair_contact.h"

namespace drape
{
// Motions of the obstacles that move in the step, in the order of slots.
struct MotionList
{
    const ObstacleMotion* m_motions = nullptr;
    std::uint32_t m_count = 0;

    const ObstacleMotion* find(std::uint32_t mesh) const { return findMotion(m_motions, m_count, mesh); }
};

// Options and per-pair data of a step. mode: DRAPE_DISCRETE …. thickness: m, cloth slots × obstacle slots. Contacts
// reach to thickness × reachScale.
struct NarrowPhaseSettings
{
    const std::vector<float>& m_thickness;
    std::size_t m_obstacleMeshes;
    float m_reachScale;
    std::uint32_t m_mode = DRAPE_AUTOMATIC;
    MotionList m_motions = {};  // on the host
};

// Counts of the host's narrow phase: contacts, and feature pairs that the continuous test decided.
struct NarrowPhaseCounts
{
    std::uint64_t m_contacts = 0;
    std::uint64_t m_swept = 0;
};

// Leaves the list empty if there are more contacts than the limit.
NarrowPhaseCounts narrowPhaseOnHost(const std::vector<Candidate>& candidates, const ClothView& cloth,
                                    const ObstacleView& obstacle, const NarrowPhaseSettings& settings,
                                    std::vector<Contact>& contacts, std::size_t limit = SIZE_MAX);

// Lists pairs whose triangles intersect at the step's start, in order of cloth and obstacle triangle.
void intersectOnHost(const std::vector<Candidate>& candidates, const ClothView& cloth, const ObstacleView& obstacle,
                     const MotionList& motions, std::vector<Candidate>& pairs);

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

    // features: builds the kernels for feature tests, else those for triangle pairs.
    void create(Device& device, const ProgramLoader& load, bool features);

    void reserveIntersections(Device& device, std::size_t count) { m_intersections.reserve(device, count); }
    Buffer<Candidate>& intersections() { return m_intersections; }

    // Lists the contacts of triangle pairs. All functions return after enqueueing.
    void enqueue(Device& device, NarrowPhaseBuffers sides, std::size_t nodeCount, std::size_t triangleCount,
                 const NarrowPhaseSettings& settings, Buffer<Candidate>& candidates, HitBuffers hits,
                 Buffer<StepCounters>& counters);
    // Lists the contacts of the feature tests that remain after a cull. mode: DRAPE_DISCRETE …; a discrete step takes
    // one launch less, and so does one with few tests.
    void enqueueFeatures(Device& device, NarrowPhaseBuffers sides, std::size_t nodeCount, std::size_t triangleCount,
                         std::uint32_t mode, PatchCullStage& cull, Expected expected, HitBuffers hits,
                         Buffer<StepCounters>& counters);
    // Returns whether the launch did nothing because there were `tests` tests and far fewer were expected.
    bool skipped(std::size_t tests) const { return tests > m_mostTests; }
    // Lists the candidates whose triangles intersect, in any order. Their counter must be zero before.
    void enqueueIntersect(Device& device, NarrowPhaseBuffers sides, Buffer<Candidate>& candidates,
                          Buffer<StepCounters>& counters);

private:
    std::size_t m_mostTests = SIZE_MAX;  // tests of the last launches
    Kernel m_test, m_feature, m_swept, m_few, m_intersect;
    Buffer<Candidate> m_intersections{"step intersections"};
    Buffer<cl_uint> m_sweptTests{"step candidates"};
};
}  // namespace drape
