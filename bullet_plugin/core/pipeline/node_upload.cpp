// Nodes of the coming step: the memory that callers write, and the transfer to a device while others are written.
#include <algorithm>
#include <cassert>

#include "implementation.h"

namespace drape
{
namespace
{
// Nodes per early transfer, before all are written: 1.6 MB each of start and end. Such a transfer takes far longer
// than its enqueueing, which costs 10 us in a GPU's driver.
constexpr std::size_t kNodesTogether = 1 << 17;
// Nodes that one thread writes per turn, and the minimum number of nodes for waking threads.
constexpr std::size_t kNodesAlone = 1 << 11;
constexpr std::size_t kLeastShared = 1 << 14;
}  // namespace

void Pipeline::Implementation::forgetNodes()
{
    if (m_nodesSent > 0) m_deviceBackend->device().wait();
    m_nodesWritten = m_nodesSent = 0;
}

// Nobody writes those.
void Pipeline::Implementation::passVacantNodes(std::size_t last)
{
    const MeshPool& cloths = m_scene.m_cloths;
    while (m_nodesWritten < last)
    {
        const std::size_t slot = cloths.slotOfVertex(std::uint32_t(m_nodesWritten));
        if (!cloths.mesh(slot).m_vacant) return;
        m_nodesWritten = cloths.begin(slot + 1).m_vertex;
    }
}

std::vector<NodeStretch> Pipeline::Implementation::stretchesOf(const std::vector<MeshId>& ids)
{
    std::vector<NodeStretch> stretches;
    for (std::size_t i = 0; i < ids.size(); ++i)
    {
        const PooledMesh& mesh = m_scene.m_cloths.mesh(slotOf(m_scene.m_cloths, ids[i]));
        const std::size_t nodes = mesh.m_positions.size() / 3;
        for (std::size_t first = 0; first < nodes; first += kNodesAlone)
        {
            const std::size_t at = 3 * (mesh.m_firstVertex + first);
            stretches.push_back(NodeStretch{i, first, std::min(kNodesAlone, nodes - first),
                                            m_scene.m_clothNodes.start() + at, m_scene.m_clothNodes.end() + at});
        }
    }
    return stretches;
}

float* Pipeline::clothStart(MeshId id)
{
    m_implementation->joinScene();
    Scene& scene = m_implementation->m_scene;
    return scene.m_clothNodes.start() + 3 * std::size_t(scene.m_cloths.mesh(slotOf(scene.m_cloths, id)).m_firstVertex);
}

float* Pipeline::clothEnd(MeshId id)
{
    m_implementation->joinScene();
    Scene& scene = m_implementation->m_scene;
    return scene.m_clothNodes.end() + 3 * std::size_t(scene.m_cloths.mesh(slotOf(scene.m_cloths, id)).m_firstVertex);
}

void Pipeline::nodesWritten(MeshId id, std::size_t count)
{
    Implementation& self = *m_implementation;
    if (self.m_report.m_onHost) return;
    self.joinScene();
    const MeshPool& cloths = self.m_scene.m_cloths;
    const std::size_t first = cloths.mesh(slotOf(cloths, id)).m_firstVertex;
    assert(first + count <= cloths.vertexCount());
    self.passVacantNodes(first);
    if (first > self.m_nodesWritten) return;
    self.m_nodesWritten = std::max(self.m_nodesWritten, first + count);
    const std::size_t unsent = self.m_nodesWritten - self.m_nodesSent;
    if (unsent >= kNodesTogether && self.m_deviceBackend->sendNodes(self.m_scene, self.m_nodesSent, unsent))
        self.m_nodesSent = self.m_nodesWritten;
}

void Pipeline::writeNodes(const std::vector<MeshId>& ids, const std::function<void(const NodeStretch&)>& write)
{
    Implementation& self = *m_implementation;
    self.joinScene();
    const std::vector<NodeStretch> stretches = self.stretchesOf(ids);
    for (std::size_t first = 0, last; first < stretches.size(); first = last)
    {
        std::size_t nodes = 0;
        for (last = first; last < stretches.size() && nodes < kNodesTogether; ++last)
            nodes += stretches[last].m_count;
        const auto writeOne = [&](std::size_t i) { write(stretches[first + i]); };
        if (nodes >= kLeastShared && self.runsOnGpu())
            self.m_threads->run(last - first, writeOne);
        else
            for (std::size_t i = 0; i < last - first; ++i)
                writeOne(i);
        for (std::size_t i = first; i < last; ++i)
            nodesWritten(ids[stretches[i].m_cloth], stretches[i].m_first + stretches[i].m_count);
    }
}

void Pipeline::copyNodes(const std::vector<MeshId>& ids, const float* start, const float* end)
{
    const MeshPool& cloths = m_implementation->m_scene.m_cloths;
    m_implementation->joinScene();
    std::vector<std::size_t> firsts(1, 0);
    for (const MeshId id : ids)
        firsts.push_back(firsts.back() + cloths.mesh(slotOf(cloths, id)).m_positions.size());
    writeNodes(ids,
               [&](const NodeStretch& stretch)
               {
                   const std::size_t from = firsts[stretch.m_cloth] + 3 * stretch.m_first;
                   std::copy_n(start + from, 3 * stretch.m_count, stretch.m_start);
                   std::copy_n(end + from, 3 * stretch.m_count, stretch.m_end);
               });
}
}  // namespace drape
