// Narrow phase: from candidates to contacts. Feature tests, then compaction into canonical order (see
// kernels/shared/contact.h). Host and device give the same contacts, bit for bit.
#pragma once

#include <cstdint>
#include <vector>

#include "bullet_plugin/core/broad_phase/patch_cull.h"
#include "bullet_plugin/core/device/buffer.h"
#include "bullet_plugin/core/device/program.h"
#include "bullet_plugin/core/self_collision/self_contacts.h"
#include "kernels/lib/contact_reduction.h"
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

// What the narrow phase counted on the host: contacts, and pairs of features that the continuous test decided.
struct NarrowPhaseCounts
{
    std::uint64_t m_contacts = 0;
    std::uint64_t m_swept = 0;
};

// With more contacts than limit the list is left empty.
NarrowPhaseCounts narrowPhaseOnHost(const std::vector<Candidate>& candidates, const ClothView& cloth,
                                    const ObstacleView& obstacle, const NarrowPhaseSettings& settings,
                                    std::vector<Contact>& contacts, std::size_t limit = SIZE_MAX);

// Takes out the contacts that others imply (kernels/lib/contact_reduction.h); slotCount: of the cloth side. The others
// stay in canonical order.
void reduceOnHost(std::vector<Contact>& contacts, const ReductionView& view, std::size_t slotCount);

// Pairs whose triangles intersect at the step's start, in order of cloth and obstacle triangle.
void intersectOnHost(const std::vector<Candidate>& candidates, const ClothView& cloth, const ObstacleView& obstacle,
                     const MotionList& motions, std::vector<Candidate>& pairs);

void sortCandidates(std::vector<Candidate>& candidates);

// Into canonical order.
void sortContacts(std::vector<Contact>& contacts);

// Device buffers that hold both sides' geometry.
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

// What reduction reads besides the hits (kernels/lib/contact_reduction.h).
struct ReductionBuffers
{
    Buffer<MeshFirsts>& m_cloths;
    Buffer<MeshFirsts>& m_obstacles;
    std::size_t m_clothCount;
    std::size_t m_obstacleCount;
    Buffer<float>& m_tube;
};

// Contacts of cloths with themselves that go with a step's others.
struct SelfWork
{
    SelfContactStage& m_stage;
    SelfBuffers m_step;
};

// The step's counters, and those of the next step, which compaction leaves zero. m_ordered: slots with too many hits
// for the last launch are put in order before it; where they are not and there are some, which the counters tell, the
// step must run again. m_tests, m_hits: about as many feature tests and hits are expected; speed alone depends on them.
struct StepTally
{
    Buffer<StepCounters>& m_now;
    Buffer<StepCounters>& m_next;
    bool m_ordered = true;
    std::size_t m_tests = SIZE_MAX, m_hits = SIZE_MAX;
};

class NarrowPhaseStage
{
public:
    // features: for what a cull leaves, else for pairs of triangles; reduces: whether steps may reduce their contacts.
    // The kernels of what is not used are not built.
    void create(Device& device, const ProgramLoader& load, bool features, bool reduces = false);

    // Room for the slots of a cloth side: its nodes, faces and edges.
    void resizeSlots(Device& device, std::size_t slotCount);

    // Room for a list of hits and as many contacts. Steps count the hits on where it is full.
    void reserveHits(Device& device, std::size_t count);
    void reserveIntersections(Device& device, std::size_t count) { m_intersections.reserve(device, count); }
    std::size_t hitCapacity() const { return m_hits.capacity(); }
    // Behind a head of DRAPE_CONTACT_HEAD places, which holds the step's counters.
    Buffer<Contact>& contacts() { return m_contacts; }
    Buffer<Candidate>& intersections() { return m_intersections; }

    // Contacts of pairs of triangles. Returns after enqueueing. The tally's counters of places and intersections must
    // be zero before. reduction: null where no contact is to be left out. self: null where no cloth is tested against
    // itself.
    void enqueue(Device& device, NarrowPhaseBuffers sides, std::size_t nodeCount, std::size_t triangleCount,
                 const NarrowPhaseSettings& settings, Buffer<Candidate>& candidates, StepTally tally,
                 const ReductionBuffers* reduction = nullptr, const SelfWork* self = nullptr);
    // Contacts of the feature tests that a cull left. mode: DRAPE_DISCRETE …; a discrete step is one launch less, and
    // so is one with few tests.
    void enqueueFeatures(Device& device, NarrowPhaseBuffers sides, std::size_t nodeCount, std::size_t triangleCount,
                         std::uint32_t mode, PatchCullStage& cull, StepTally tally,
                         const ReductionBuffers* reduction = nullptr, const SelfWork* self = nullptr);
    // Contacts of cloths with themselves alone.
    void enqueueSelf(Device& device, NarrowPhaseBuffers sides, StepTally tally, const SelfWork& self);
    void enqueueIntersect(Device& device, NarrowPhaseBuffers sides, Buffer<Candidate>& candidates,
                          Buffer<StepCounters>& counters);

private:
    void enqueueCompaction(Device& device, NarrowPhaseBuffers sides, StepTally tally,
                           const ReductionBuffers* reduction);
    void enqueueReduction(Device& device, NarrowPhaseBuffers sides, StepTally tally, const ReductionBuffers& reduction);
    // Where the hits of each slot begin, from their numbers. ranked: see kernels/compaction.cl.
    void enqueuePlaces(Device& device, Buffer<cl_uint>& slotCount, Buffer<cl_uint>& slotFirst, cl_uint ranked,
                       StepTally tally);
    void enqueueFewCompaction(Device& device, NarrowPhaseBuffers sides, StepTally tally,
                              const ReductionBuffers* reduction);
    void enqueueKeep(Device& device, NarrowPhaseBuffers sides, StepTally tally, const ReductionBuffers& reduction);
    void reserveHitSlots(Device& device);
    HitBuffers hits() { return {m_hits, m_hitSlots, m_slotCount}; }
    void enqueueOrder(Device& device, cl_uint ranked, StepTally tally);
    void enqueueSelfHits(Device& device, StepTally tally, const SelfWork& self);

    Kernel m_test, m_feature, m_swept, m_few, m_intersect, m_count, m_place, m_gather, m_order, m_write;
    Kernel m_compactFew, m_keep, m_writeKept, m_writeKeptFew;
    Buffer<Contact> m_hits{"step hits"}, m_contacts{"step contacts"};
    Buffer<cl_uint> m_hitSlots{"step hits"};  // on a GPU, where slots are few
    Buffer<Candidate> m_intersections{"step intersections"};
    Buffer<cl_uint> m_slotCount{"cloth slots"}, m_slotFirst{"cloth slots"}, m_blockCount{"cloth slots"};
    Buffer<cl_uint> m_slotKept{"cloth slots"}, m_keptFirst{"cloth slots"};  // only where contacts may be reduced
    Buffer<cl_uint> m_members{"step hits"}, m_keys{"step hits"}, m_kept{"step hits"}, m_sweptTests{"step candidates"};
    std::size_t m_slots = 0;
    bool m_reduces = false;
};
}  // namespace drape
