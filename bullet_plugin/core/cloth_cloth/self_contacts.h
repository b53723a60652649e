// Contacts of cloths with themselves in a step on a device (self_step.h).
//
// A list that is too small counts its true demand. Cost: four launches a step, on a GPU five, and one for each upper
// level of the tree; none without a cloth that collides with
// itself, and its kernels are not built then.
#pragma once

#include <cstdint>
#include <vector>

#include "bullet_plugin/core/ordering/hit_buffers.h"
#include "bullet_plugin/core/device/buffer.h"
#include "bullet_plugin/core/device/program.h"
#include "bullet_plugin/core/scene/patches.h"
#include "self_step.h"

namespace drape
{
// Step data that the device's stage reads. start: the end's positions in a discrete step.
struct SelfBuffers
{
    Buffer<Triangle>& m_triangles;
    Buffer<Edge>& m_edges;
    Buffer<float>& m_start;
    Buffer<float>& m_end;
    Buffer<float>& m_obstacleRadius;  // m, reach of the search for obstacles, per cloth slot
    std::size_t m_nodeCount;
    std::size_t m_triangleCount;
    std::size_t m_edgeCount;
    std::uint32_t m_mode;
    float m_reachScale;
    std::size_t m_limit;  // tests; the count is exact up to it
};

class SelfContactStage
{
public:
    void create(Device& device, const ProgramLoader& load);
    bool created() const { return m_created; }

    // Sets new cloths. rest: m, x y z per joined node. Waits for the upload.
    void setTopology(Device& device, const MeshPool& cloths, const std::vector<float>& rest);
    // Enqueues changes of the reaches, which must stay unchanged until a wait for the device.
    void setReach(Device& device, const SelfReach& reach);

    // Lists the tests; their counters must be zero before. Both functions return after enqueueing.
    void enqueueCull(Device& device, SelfBuffers step, Buffer<StepCounters>& counters);
    // Lists the contacts of the tests.
    void enqueueContacts(Device& device, SelfBuffers step, HitBuffers hits, Buffer<StepCounters>& counters);

    Buffer<FeatureTest>& tests() { return m_tests; }
    void reserveTests(Device& device, std::size_t count);
    // The list of pairs of patches on a GPU. If it was too short, other counts are too low.
    Buffer<Candidate>& pairs() { return m_pairs; }
    void reservePairs(Device& device, std::size_t count) { m_pairs.reserve(device, count); }

private:
    void enqueuePack(Device& device, SelfBuffers step, Buffer<float>& start, Buffer<StepCounters>& counters);
    void enqueueWalk(Device& device, SelfBuffers step, Buffer<StepCounters>& counters);
    void enqueuePairs(Device& device, SelfBuffers step, Buffer<float>& start, Buffer<StepCounters>& counters);

    Kernel m_pack, m_widen, m_walk, m_cull, m_feature, m_sweptKernel;
    Patches m_layout;
    bool m_created = false;
    Buffer<Patch> m_patches{"self patches"};
    Buffer<cl_uint> m_faceIds{"self patches"}, m_vertexIds{"self patches"}, m_edgeIds{"self patches"};
    Buffer<cl_uint> m_faceNodes{"self patches"}, m_edgeNodes{"self patches"};  // on a CPU
    Buffer<cl_uint> m_levels{"self patches"};
    // Boxes of features; on a GPU those of nodes alone, by node.
    Buffer<float> m_faceBoxes{"self boxes"}, m_vertexBoxes{"self boxes"}, m_edgeBoxes{"self boxes"};
    Buffer<float> m_wideNodes{"self wide nodes"};
    Buffer<float> m_rest{"cloth positions"}, m_radius{"self patches"}, m_thickness{"self patches"};
    Buffer<FeatureTest> m_tests{"self candidates"};
    Buffer<Candidate> m_pairs{"self candidates"};
    Buffer<cl_uint> m_swept{"self candidates"};
    std::vector<float> m_sentRadius, m_sentThickness;
};
}  // namespace drape
