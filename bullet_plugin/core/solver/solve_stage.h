// Solves packed cloths on a device: one launch, in which each cloth has a work-group (kernels/solver/solve_cloths.cl).
//
// Input: a packed step. Output: the nodes' displacements and states, and a result by cloth, as the host's solver would
// give them, bit for bit. Cost: one submission and one wait. Errors: in the device.
#pragma once

#include "bullet_plugin/core/device/bound_kernel.h"
#include "kernels/solver/solver_bindings.h"
#include "revision.h"

namespace drape
{
// A step as it lies in the device's memory. The arrays stay the caller's, unchanged until finish().
struct SolveStep
{
    SolveLayout m_layout = {};
    std::size_t m_clothCount = 0, m_nodeCount = 0;
    std::size_t m_mostNodes = 0;  // nodes of the largest cloth
    const SolveInputWord* m_input = nullptr;
    std::size_t m_inputWords = 0;
    // Null: the topology of the last step.
    const SolveTopologyWord* m_topology = nullptr;
    std::size_t m_topologyWords = 0;
    const Contact* m_contacts = nullptr;
    std::size_t m_contactCount = 0;
    std::size_t m_workWords = 0;
    std::size_t m_resultWords = 0;  // words at the start of the working memory that are read back
};

class SolveStage
{
public:
    // Maximum nodes of a cloth: they take 16 bytes each of a work-group's local memory, mostly 48 KiB.
    static constexpr std::size_t kMostNodes = 3000;

    void create(Device& device, const ProgramLoader& load);
    // Returns whether create() was called.
    bool created() const { return m_device != nullptr; }
    // Differs from that of every stage before and after in which the last step's topology is lost.
    std::uint64_t revision() const { return m_revision; }

    // Host memory for the coming step's input, pinned if the device has such.
    SolveInputWord* input(std::size_t words);
    // Returns after enqueueing.
    void submit(const SolveStep& step);
    // Waits. Returns the words that were read back, null if the device failed. They stay until the next submit().
    const SolveWorkWord* finish();
    // Releases memory that only earlier, larger steps needed. Waits.
    void giveBackRoom();

private:
    Device* m_device = nullptr;
    std::uint64_t m_revision = newRevision();
    template <class Kernel>
    void launch(Kernel& kernel, std::size_t gpuGroup, const SolveStep& step);

    BoundKernel<kernels::solveCloths> m_solve;
    BoundKernel<kernels::solveSmallCloths> m_solveSmall;
    Buffer<SolveInputWord> m_input{"solver input"};
    Buffer<SolveTopologyWord> m_topology{"solver topology"};
    Buffer<Contact> m_contacts{"solver contacts"};
    Buffer<SolveWorkWord> m_work{"solver memory"};
    std::unique_ptr<Staging<SolveInputWord>> m_inputWritten = std::make_unique<Staging<SolveInputWord>>();
    std::unique_ptr<Staging<SolveWorkWord>> m_resultRead = std::make_unique<Staging<SolveWorkWord>>();
};
}  // namespace drape
