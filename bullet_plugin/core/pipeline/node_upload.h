// Lets callers write the nodes of the coming step, and begins their transfer to a device while others are written.
//
// Cost: one transfer for some 100,000 nodes; smaller scenes are transferred with the step. On a GPU the caller's
// threads share the writing.
#pragma once

#include "bullet_plugin/core/scene/scene.h"
#include "pipeline.h"

namespace drape
{
class DeviceBackend;

class NodeUpload
{
public:
    using Write = std::function<void(const NodeStretch&)>;

    // Declares that the first `count` nodes of a cloth are written. device: the back end of the step if that is a
    // device; else null. The scene must be joined.
    void declare(const Scene& scene, MeshId cloth, std::size_t count, DeviceBackend* device);
    // Calls write() for ranges of the cloths' nodes, and declares the nodes.
    void write(Scene& scene, const std::vector<MeshId>& cloths, const Write& write, DeviceBackend* device,
               ThreadTeam& threads);

    // Returns how many of the cloths' first nodes are on their way to the device.
    std::size_t sent() const { return m_sent; }
    // Forgets the declared nodes: those of the coming step are others. Waits for their transfers.
    void forget();
    // Forgets them without a wait: the submitted step waits for its transfers.
    void passToStep();

private:
    // Counts nodes of removed cloths as written, up to node `last`.
    void skipVacantNodes(const MeshPool& cloths, std::size_t last);

    Device* m_device = nullptr;             // the device that transfers nodes; null for none
    std::size_t m_written = 0, m_sent = 0;  // counts of the cloths' first nodes, for the coming step
};
}  // namespace drape
