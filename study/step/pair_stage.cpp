#include "study/step/pair_stage.h"

#include "bullet_plugin/core/device/list_launch.h"

namespace drape
{
void PairStage::create(Device& device, const ProgramLoader& load)
{
    m_test.create(device, load("narrow_phase_pairs"), "narrowPhaseTest");
}

void PairStage::enqueue(Device& device, PairSides sides, Buffer<Candidate>& candidates,
                        Buffer<TraversalCounters>& found, HitBuffers hits, Buffer<StepCounters>& counters)
{
    m_test.launch(device, listWidth(device), listGroup(device), candidates.handle(), cl_uint(candidates.capacity()),
                  found.handle(), sides.m_clothStart.handle(), sides.m_clothEnd.handle(),
                  sides.m_clothTriangles.handle(), sides.m_clothEdges.handle(), cl_uint(sides.m_clothNodes),
                  cl_uint(sides.m_triangleCount), sides.m_obstaclePositions.handle(),
                  sides.m_obstacleTriangles.handle(), sides.m_vertexCones.handle(), sides.m_edgeCones.handle(),
                  sides.m_thickness.handle(), cl_uint(sides.m_obstacleMeshes), sides.m_reachScale,
                  cl_uint(sides.m_mode), hits.m_hits.handle(), cl_uint(hits.m_hits.capacity()),
                  hits.m_hitPlaces.handle(), hits.m_slotCount.handle(), hits.m_slotSums.handle(), counters.handle());
}
}  // namespace drape
