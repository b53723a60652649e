#include "node_upload.h"

#include <algorithm>
#include <cassert>

#include "bullet_plugin/core/backends/device_backend.h"

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

std::vector<NodeStretch> stretchesOf(Scene& scene, const std::vector<MeshId>& ids)
{
    std::vector<NodeStretch> stretches;
    for (std::size_t i = 0; i < ids.size(); ++i)
    {
        const PooledMesh& mesh = scene.m_cloths.existing(ids[i]);
        const std::size_t nodes = mesh.m_positions.size() / 3;
        for (std::size_t first = 0; first < nodes; first += kNodesAlone)
        {
            const std::size_t at = 3 * (mesh.m_firstVertex + first);
            stretches.push_back(NodeStretch{i, first, std::min(kNodesAlone, nodes - first),
                                            scene.m_clothNodes.start() + at, scene.m_clothNodes.end() + at});
        }
    }
    return stretches;
}
}  // namespace

void NodeUpload::forget()
{
    if (m_device) m_device->wait();
    passToStep();
}

void NodeUpload::passToStep()
{
    m_device = nullptr;
    m_written = m_sent = 0;
}

void NodeUpload::skipVacantNodes(const MeshPool& cloths, std::size_t last)
{
    while (m_written < last)
    {
        const std::size_t slot = cloths.slotOfVertex(std::uint32_t(m_written));
        if (!cloths.mesh(slot).m_vacant) return;
        m_written = cloths.begin(slot + 1).m_vertex;
    }
}

void NodeUpload::declare(const Scene& scene, MeshId cloth, std::size_t count, DeviceBackend* device)
{
    if (!device) return;
    const MeshPool& cloths = scene.m_cloths;
    const std::size_t first = cloths.existing(cloth).m_firstVertex;
    assert(first + count <= cloths.vertexCount());
    skipVacantNodes(cloths, first);
    if (first > m_written) return;
    m_written = std::max(m_written, first + count);
    const std::size_t unsent = m_written - m_sent;
    if (unsent < kNodesTogether || !device->sendNodes(scene, m_sent, unsent)) return;
    m_device = &device->device();
    m_sent = m_written;
}

void NodeUpload::write(Scene& scene, const std::vector<MeshId>& cloths, const Write& write, DeviceBackend* device,
                       ThreadTeam& threads)
{
    const bool onGpu = device && device->device().isGpu();
    const std::vector<NodeStretch> stretches = stretchesOf(scene, cloths);
    for (std::size_t first = 0, last; first < stretches.size(); first = last)
    {
        std::size_t nodes = 0;
        for (last = first; last < stretches.size() && nodes < kNodesTogether; ++last)
            nodes += stretches[last].m_count;
        runShared(threads, onGpu && nodes >= kLeastShared, last - first,
                  [&](std::size_t i) { write(stretches[first + i]); });
        for (std::size_t i = first; i < last; ++i)
            declare(scene, cloths[stretches[i].m_cloth], stretches[i].m_first + stretches[i].m_count, device);
    }
}
}  // namespace drape
