// Keeps nodes of cloths on a device between steps, and predicts their paths there (kernels/solver/kept_nodes.cl).
//
// Job: hold the nodes, with the masses, of each kept cloth; before a detection write their paths for it, and then for
// the solver; after the solver take its result, and bound the next step. A result counts once it is accepted, so that a
// step can be solved again from its start. Guarantee: the bits of a cloth whose nodes the host has. Errors: in the
// device.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "bullet_plugin/core/device/bound_kernel.h"
#include "bullet_plugin/core/lists/kept_step.h"
#include "kernels/solver/solver_bindings.h"

namespace drape
{
class KeptNodes
{
public:
    void create(Device& device, const ProgramLoader& load);

    // Makes room for a cloth of so many nodes.
    KeptId add(std::size_t count);
    void remove(KeptId id);
    // Replaces the nodes, and the boxes around their coming step. Returns after enqueueing; waits if there was no wait
    // since the cloth's last call.
    void write(KeptId id, const std::vector<KeptNode>& nodes, const KeptBoxes& boxes);
    // Enqueues the transfer of the nodes to the host; they are at nodesRead() after a wait for the device. Allocates no
    // memory.
    void beginRead(KeptId id);
    const KeptNode* nodesRead(KeptId id) const { return m_read->data() + m_slots[id].m_first; }

    // Writes the paths of the cloths for the detection. Returns after enqueueing.
    void predict(const std::vector<KeptCloth>& cloths, Buffer<float>& detected);
    // Returns the record of a cloth in a step; indices in the detection and the solver are left out.
    KeptCloth clothOf(const KeptStep& step) const;
    // Writes the paths for the solver.
    void takePaths(const std::vector<KeptCloth>& cloths, const SolveLayout& layout, Buffer<SolveTopologyWord>& topology,
                   Buffer<SolveWorkWord>& work);
    // Takes the solver's result and reads the bounds. The arrays stay the caller's until a wait for the device.
    void keep(const SolveLayout& layout, Buffer<SolveTopologyWord>& topology, Buffer<SolveWorkWord>& work);
    // Returns whether the last result of keep() can be accepted for a cloth, after the wait: no node left its path too
    // far, and all numbers are finite. index: in the list of takePaths().
    bool isGood(std::size_t index) const;
    // Accepts that result.
    void accept(KeptId id, std::size_t index);
    // Returns the boxes of write(), or those after the last step of the cloth that was accepted since.
    const KeptBoxes& boxes(KeptId id) const { return m_slots[id].m_boxes; }

private:
    struct Slot
    {
        std::size_t m_first = 0, m_room = 0;  // among the cloths' nodes
        std::size_t m_count = 0;              // nodes of the cloth that uses it
        std::uint32_t m_turn = 0;             // which of two copies is valid
        KeptBoxes m_boxes;
        bool m_isUsed = false;
        std::size_t m_waitsAtWrite = SIZE_MAX;  // waits for the device before the last write()
    };

    // Each cloth has two copies of its nodes, one behind the other.
    cl_uint firstNodeOf(const Slot& slot, std::uint32_t turn) const
    {
        return cl_uint(2 * slot.m_first + turn * slot.m_room);
    }
    std::size_t width(const std::vector<KeptCloth>& cloths);
    void growRead(std::size_t count);

    Device* m_device = nullptr;
    BoundKernel<kernels::predictKept> m_predict;
    BoundKernel<kernels::takeKeptPaths> m_takePaths;
    BoundKernel<kernels::keepNodes> m_keep;
    std::vector<Slot> m_slots;
    Buffer<KeptNode> m_nodes{"kept nodes"};
    Buffer<KeptCloth> m_detected{"kept nodes"},
        m_solved{"kept nodes"};  // records of the step, as each stage reads them
    Buffer<KeptBounds> m_bounds{"kept nodes"};
    std::vector<KeptCloth> m_detectedSent, m_solvedSent;
    std::vector<KeptBounds> m_emptyBounds, m_boundsRead;
    // Nodes read and written, cloth by cloth in the order of their memory.
    std::unique_ptr<Staging<KeptNode>> m_read = std::make_unique<Staging<KeptNode>>();
    std::unique_ptr<Staging<KeptNode>> m_written = std::make_unique<Staging<KeptNode>>();
    KeptLaunch m_launch = {};
};
}  // namespace drape
