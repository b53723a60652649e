#include "study/step/pair_stage.h"

#include "bullet_plugin/core/device/list_launch.h"

namespace drape
{
void PairStage::create(Device& device, const ProgramLoader& load)
{
    m_test.create(device, load("narrow_phase_pairs"));
}

void PairStage::enqueue(Device& device, const PairSides& sides, Buffer<Candidate>& candidates,
                        Buffer<TraversalCounters>& found, UnsortedContacts& contacts, Buffer<StepCounters>& counters)
{
    const PairValues values = {sides.m_layout,
                               sides.m_obstacles.m_layout,
                               cl_uint(candidates.capacity()),
                               cl_uint(sides.m_obstacleMeshes),
                               sides.m_reachScale,
                               sides.m_mode,
                               cl_uint(contacts.capacity()),
                               contacts.sums()};
    m_test.launch(device, listWidth(device), listGroup(device), values, candidates, found, sides.m_start, sides.m_end,
                  sides.m_cloths, sides.m_obstacles.m_geometry, sides.m_thickness, contacts.m_contacts,
                  contacts.m_ranks, contacts.m_featureCounts, counters);
}
}  // namespace drape
