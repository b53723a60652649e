// Contacts of the pairs of triangles that a traversal listed, on a device: those of contactsOfPairs(), bit for bit,
// unsorted. Cost: linear in the pairs.
#pragma once

#include "bullet_plugin/core/device/bound_kernel.h"
#include "bullet_plugin/core/lists/unsorted_contacts.h"
#include "bullet_plugin/core/scene/device_views.h"
#include "study/kernels/narrow_phase_pairs_bindings.h"

namespace drape
{
// The geometry of both sides, and the step's settings.
struct PairSides
{
    BufferView<float> m_start, m_end;  // positions of the cloths
    BufferView<ClothWord> m_cloths;
    ClothLayout m_layout;
    ObstacleBuffers m_obstacles;
    BufferView<float> m_thickness;  // m, cloth slots × obstacle slots
    std::size_t m_obstacleMeshes;
    float m_reachScale;
    std::uint32_t m_mode;  // DRAPE_DISCRETE …
};

class PairStage
{
public:
    void create(Device& device, const ProgramLoader& load);

    // Returns after enqueueing. found: the traversal's counters; counters: the step's.
    void enqueue(Device& device, const PairSides& sides, Buffer<Candidate>& candidates,
                 Buffer<TraversalCounters>& found, UnsortedContacts& contacts, Buffer<StepCounters>& counters);

private:
    BoundKernel<kernels::narrowPhaseTest> m_test;
};
}  // namespace drape
