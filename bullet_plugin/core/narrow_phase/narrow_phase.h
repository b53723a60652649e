// Narrow phase: from candidates to contacts. Feature tests, the deepest contact per slot (cloth feature × direction), and
// compaction in slot order, which is the canonical order. Host and device give the same contacts, bit for bit.
#pragma once

#include <vector>

#include "bullet_plugin/core/device/buffer.h"
#include "bullet_plugin/core/device/program.h"
#include "kernels/lib/pair_contact.h"

namespace drape
{
// Options and per-pair data of a step. thickness: m, cloth slots × obstacle slots. Contacts reach to thickness × reachScale.
struct NarrowPhaseSettings
{
    const std::vector<float>& m_thickness;
    std::size_t m_obstacleMeshes;
    float m_reachScale;
    bool m_allContacts;  // no reduction
};

// Keeps the best contact of each slot while contacts come in any order.
class ContactReduction
{
public:
    void resize(std::size_t slotCount);
    void add(const Contact& contact);
    // Moves the winners out in slot order and empties all slots.
    void take(std::vector<Contact>& contacts);

private:
    std::vector<std::uint32_t> m_slotHit;  // place in m_hits, DRAPE_NO_CONTACT when empty
    std::vector<Contact> m_hits;           // one per occupied slot
};

void narrowPhaseOnHost(const std::vector<Candidate>& candidates, const ClothView& cloth, const ObstacleView& obstacle,
                       const NarrowPhaseSettings& settings, ContactReduction& reduction, std::vector<Contact>& contacts);

// Pairs whose triangles intersect at the step's start, in order of cloth and obstacle triangle.
void intersectOnHost(const std::vector<Candidate>& candidates, const ClothView& cloth, const ObstacleView& obstacle,
                     std::vector<Candidate>& pairs);

// The order of contacts when all are kept: slot, then obstacle feature.
void sortContacts(std::vector<Contact>& contacts);
void sortCandidates(std::vector<Candidate>& candidates);

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
};

class NarrowPhaseStage
{
public:
    void create(Device& device, const cl::Program& narrowPhase, const cl::Program& compaction);

    // Room for the slots of a cloth side; empties them.
    void resizeSlots(Device& device, std::size_t slotCount);
    // Empties all slots, after a step that lost hits.
    void clearSlots(Device& device);

    void reserveHits(Device& device, std::size_t count) { m_hits.reserve(device, count); }
    void reserveContacts(Device& device, std::size_t count) { m_contacts.reserve(device, count); }
    void reserveIntersections(Device& device, std::size_t count) { m_intersections.reserve(device, count); }
    Buffer<Contact>& hits() { return m_hits; }
    Buffer<Contact>& contacts() { return m_contacts; }
    Buffer<Candidate>& intersections() { return m_intersections; }

    // Returns after enqueueing. counters' hits and intersections must be zero before.
    void enqueue(Device& device, NarrowPhaseBuffers sides, std::size_t nodeCount, std::size_t triangleCount,
                 const NarrowPhaseSettings& settings, Buffer<Candidate>& candidates, Buffer<StepCounters>& counters);
    void enqueueIntersect(Device& device, NarrowPhaseBuffers sides, Buffer<Candidate>& candidates,
                          Buffer<StepCounters>& counters);

private:
    void enqueueCompaction(Device& device, Buffer<StepCounters>& counters);
    std::size_t listWidth(const Device& device) const;

    Kernel m_test, m_tie, m_win, m_intersect, m_count, m_scan, m_write;
    Buffer<Contact> m_hits, m_contacts;
    Buffer<Candidate> m_intersections;
    Buffer<cl_uint> m_slotRank, m_slotFeature, m_slotHit, m_blockCount;
    std::size_t m_slotCount = 0;
};
}  // namespace drape
