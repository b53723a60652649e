// A way of traversing both hierarchies on a device: what a step asks of it.
//
// Every one fills the list of candidates with the same set, in any order, and counts the demand past the list's
// capacity. Functions return after enqueueing unless they say that they wait.
#pragma once

#include "bullet_plugin/core/device/bound_kernel.h"
#include "study/kernels/traversal_bindings.h"
#include "study/traversal/hierarchy.h"

namespace drape
{
struct BroadPhaseBuffers
{
    Buffer<BvhNode>& m_nodes;
    Buffer<cl_uint>& m_order;
    Buffer<Triangle>& m_triangles;
};

// thickness: m, cloth slots × obstacle slots, negative where the pair is not tested; a cloth without a pair must have
// empty volumes. counters must be zero.
struct TraversalStep
{
    BroadPhaseBuffers m_cloth, m_obstacle;
    Buffer<float>& m_thickness;
    std::size_t m_obstacleMeshes;
    Buffer<Candidate>& m_candidates;
    Buffer<TraversalCounters>& m_counters;
    std::size_t m_limit = kMostPairs;  // the count is exact up to it; a greater one says only that there are more

    ListValues list() const { return {cl_uint(m_obstacleMeshes), cl_uint(m_candidates.capacity()), cl_uint(m_limit)}; }
};

class DeviceTraversal
{
public:
    virtual ~DeviceTraversal() = default;

    // New links in either hierarchy; neither is empty. Waits.
    virtual void setTopology(Device&, const Hierarchy& /*cloth*/, const Hierarchy& /*obstacle*/) = 0;

    // May be repeated for a step.
    virtual void enqueue(Device&, const TraversalStep&) = 0;

    // After a wait: makes room for what the run could not hold, candidates aside. Returns whether it must run again;
    // limitReached when the device cannot hold it.
    virtual bool grow(Device&, const TraversalCounters&, bool& /*limitReached*/) { return false; }
    // After a run that was complete.
    virtual void accept(Device&, const TraversalCounters&) {}
};
}  // namespace drape
