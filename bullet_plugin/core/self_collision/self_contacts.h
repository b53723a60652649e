// Contacts of cloths with themselves in a step (kernels/lib/self_contact.h says what they are).
//
// Input: the cloths' nodes at the step's start and end and at rest, and per cloth the thickness. Output: contacts in
// canonical order behind those with obstacles. Guarantee: no pair that gives a contact is missed; host and device list
// the same candidates and find the same contacts, bit for bit. A list that is too small counts its true demand. Cost on
// a device: four launches a step, on a GPU five, and one for each upper level of the tree; without a cloth that asks
// for it, none, and its kernels are not built.
#pragma once

#include <cstdint>
#include <vector>

#include "bullet_plugin/core/bvh/bvh_layout.h"
#include "bullet_plugin/core/compaction/hit_buffers.h"
#include "bullet_plugin/core/device/buffer.h"
#include "bullet_plugin/core/device/program.h"
#include "bullet_plugin/core/mesh/patches.h"
#include "kernels/lib/self_contact.h"

namespace drape
{
// Per cloth slot, m.
struct SelfReach
{
    std::vector<float> m_thickness;  // negative: the cloth is not tested against itself in the step
    std::vector<float> m_radius;     // half of how far contacts reach, rounded up; negative likewise

    bool any() const;
    void leaveOut(std::size_t cloth);
};

// radius: m, by which volumes of features are grown whose contacts reach to `reach`.
float selfGrowth(float reach);

// A step of the cloths on the host.
struct SelfStep
{
    const MeshPool& m_cloths;
    SelfView m_view;
    const SelfReach& m_reach;
};

struct SelfCounts
{
    std::uint64_t m_candidates = 0;
    std::uint64_t m_contacts = 0;
    std::uint64_t m_swept = 0;  // candidates that the continuous test decided
};

// Volumes of the cloths' nodes over the step; those of cloths that are not in it stay as they are.
void selfVolumes(const SelfStep& step, std::vector<Dop>& volumes);

// Finds the contacts of pairs of triangles that are handed to it, in any order, each once.
class SelfFinder
{
public:
    // volumes: by selfVolumes(). All must outlive it.
    SelfFinder(const SelfStep& step, const std::vector<Dop>& volumes, std::uint64_t candidateLimit = UINT64_MAX,
               std::uint64_t contactLimit = UINT64_MAX);

    void visit(const Candidate& pair);
    // Of candidates: beyond them nothing is tested.
    bool withinLimits() const { return m_counts.m_candidates <= m_candidateLimit; }
    const SelfCounts& counts() const { return m_counts; }
    // Appends the contacts in canonical order, none where there are more than a limit.
    void append(std::vector<Contact>& contacts);

private:
    void test(const FeatureTest& test);

    const SelfStep& m_step;
    SelfView m_view;
    const std::vector<Dop>& m_volumes;
    std::uint64_t m_candidateLimit, m_contactLimit;
    std::uint32_t m_firstSlot;
    SelfCounts m_counts;
    std::vector<Contact> m_found;
};

class SelfContactsOnHost
{
public:
    // Appends the contacts in canonical order, unless there are more candidates or contacts than the limits; it stops
    // counting soon after those.
    SelfCounts run(const SelfStep& step, std::uint64_t candidateLimit, std::uint64_t contactLimit,
                   std::vector<Contact>& contacts);
    // Pairs of triangles whose volumes overlap, per cloth slot; counting ends once a cloth has more than the limit.
    std::vector<std::uint64_t> countPairs(const SelfStep& step, std::uint64_t limit);

private:
    void update(const SelfStep& step);

    BvhLayout m_layout;
    std::vector<BvhNode> m_nodes;
    std::vector<Dop> m_volumes;  // of the nodes
    std::uint32_t m_revision = 0;
};

// What the device's stage reads of a step. start: the end's in a discrete step.
struct SelfBuffers
{
    Buffer<Triangle>& m_triangles;
    Buffer<Edge>& m_edges;
    Buffer<float>& m_start;
    Buffer<float>& m_end;
    Buffer<float>& m_obstacleRadius;  // m, of the search for obstacles, per cloth slot
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

    // New cloths. rest: m, x y z per joined node. Waits for the upload.
    void setTopology(Device& device, const MeshPool& cloths, const std::vector<float>& rest);
    // Enqueues what changed of the reaches, which must stay as they are until the device was waited for.
    void setReach(Device& device, const SelfReach& reach);

    // Both return after enqueueing. Lists the tests; counters' numbers of them must be zero before.
    void enqueueCull(Device& device, SelfBuffers step, Buffer<StepCounters>& counters);
    // Their hits join the list.
    void enqueueContacts(Device& device, SelfBuffers step, HitBuffers hits, Buffer<StepCounters>& counters);

    Buffer<FeatureTest>& tests() { return m_tests; }
    void reserveTests(Device& device, std::size_t count);
    // The list of pairs of patches on a GPU. Where it was too short, other counts are too low.
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
    Buffer<cl_uint> m_levels{"self patches"};
    // On a GPU those of nodes alone, by node.
    Buffer<float> m_faceBoxes{"self boxes"}, m_vertexBoxes{"self boxes"}, m_edgeBoxes{"self boxes"};
    Buffer<float> m_wideNodes{"self wide nodes"};
    Buffer<float> m_rest{"cloth positions"}, m_radius{"self patches"}, m_thickness{"self patches"};
    Buffer<FeatureTest> m_tests{"self candidates"};
    Buffer<Candidate> m_pairs{"self candidates"};
    Buffer<cl_uint> m_swept{"self candidates"};
    std::vector<float> m_sentRadius, m_sentThickness;
};
}  // namespace drape
