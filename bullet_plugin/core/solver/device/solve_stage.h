// Solves packed cloths on a device (kernels/solver).
//
// First the contacts are sorted into buckets (order_contacts.cl). A cloth of one leaf is then solved by one work-group,
// all such cloths in one launch (solve_cloths.cl). Larger cloths take launches for each pass of the step, with a
// work-group for each group of a level: leaves in local memory, then the levels above (solve_groups.cl). So do cloths
// beside rigid bodies, whose rows are passes of their own (solve_rigid.cl). Launches do not depend on the number of
// cloths. Input: a packed step. Output: the nodes' displacements and states, and a result by cloth, as the host's
// solver would give them, bit for bit. The contacts are the host's, or those that a detection leaves on the device; its
// step and the solver's then have one wait. Cost: one submission and one wait, or more where contacts of a large cloth
// need many closing sweeps. Errors: in the device.
#pragma once

#include "bullet_plugin/core/device/bound_kernel.h"
#include "bullet_plugin/core/ordering/contact_list.h"
#include "kernels/lib/solver/closing_sweeps.h"
#include "kernels/solver/solver_bindings.h"
#include "kept_nodes.h"
#include "packed_topology.h"
#include "bullet_plugin/core/solver/topology/revision.h"

namespace drape
{
// A step as it lies in the device's memory. The arrays stay the caller's, unchanged until finish().
struct SolveStep
{
    SolveLayout m_layout = {};
    const SolveInputWord* m_input = nullptr;
    std::size_t m_inputWords = 0;
    const SolveTopologyWord* m_topology = nullptr;
    std::size_t m_topologyWords = 0;
    std::uint64_t m_topologyRevision = 0;  // uploaded where it is not that of the last step
    ContactList m_contacts;
    DeviceContacts m_onDevice;  // instead of them, unless its list is null
    std::size_t m_clothCount = 0;
    std::size_t m_mostNodes = 0;     // nodes of the largest leaf
    std::size_t m_clearedWords = 0;  // words at the start of the working memory that begin as 0
    std::size_t m_resultWords = 0;   // words behind them that are read back
    std::vector<KeptCloth> m_kept;   // cloths whose nodes stay on the device
    std::size_t m_workWords = 0;
    // Groups of cloths with one leaf, and levels of large cloths, from the leaves on.
    SolveRange m_small = {}, m_whole = {};
    std::vector<PackedTopology::Level> m_levels;
    // Maxima over large cloths, and whether all of their obstacles rest.
    std::uint32_t m_substeps = 0, m_regions = 0;
    bool m_rests = true;
    RigidLayout m_rigid = {};  // without chains if there are no rows beside rigid bodies
};

class SolveStage
{
public:
    void create(Device& device, const ProgramLoader& load);
    // Returns whether create() was called.
    bool created() const { return m_device != nullptr; }
    // Differs from that of every stage before and after, whose nodes are lost.
    std::uint64_t revision() const { return m_revision; }

    // Nodes that stay on the device from step to step.
    KeptNodes& kept() { return m_kept; }
    const KeptNodes& kept() const { return m_kept; }

    // Host memory for the coming step's input, pinned if the device has such.
    SolveInputWord* input(std::size_t words);
    // Returns after enqueueing.
    void submit(const SolveStep& step);
    // Waits, unless the caller has. Returns the words that were read back, null if the device failed. They stay until
    // the next submit(). Behind a detection, cloths with a path that meets a surface are not finished.
    const SolveWorkWord* finish(bool hasWaited = false);
    // Releases memory that only earlier, larger steps needed. Waits.
    void giveBackRoom();

private:
    // Closing sweeps of the first round, and of each later one.
    static constexpr std::uint32_t kFirstSweeps = DRAPE_LEAST_CLOSING, kMoreSweeps = 24;
    static_assert(DRAPE_CLOSING_SWEEPS == DRAPE_LEAST_CLOSING + DRAPE_MOST_FURTHER);

    void upload(const SolveStep& step);
    void uploadContacts(const ContactList& contacts);
    void orderContacts(const SolveStep& step);
    template <class Kernel>
    void solveWhole(Kernel& kernel, std::size_t gpuGroup, const SolveRange& groups);
    void passNodes(SolvePass pass);
    void passLevels(SolvePass pass);
    void takeRigid();
    void passRigid(SolvePass pass);
    void limit(SolvePass pass);
    void solveLarge();
    void close(std::uint32_t first, std::uint32_t last);
    void endLarge(std::uint32_t sweeps);
    void readResults();
    bool anyOpen() const;
    bool isOnDevice() const { return m_step->m_onDevice.m_list != nullptr; }
    bool hasContacts() const { return isOnDevice() || m_step->m_contacts.size() > 0; }
    Buffer<Contact>& contacts() { return isOnDevice() ? *m_step->m_onDevice.m_list : m_contacts; }

    Device* m_device = nullptr;
    std::uint64_t m_revision = newRevision();
    const SolveStep* m_step = nullptr;
    std::uint32_t m_sweeps = 0, m_round = 0;  // enqueued closing sweeps, and rounds of them

    BoundKernel<kernels::takePaths> m_takePaths;
    BoundKernel<kernels::countContacts> m_countContacts;
    BoundKernel<kernels::placeBuckets> m_placeBuckets;
    BoundKernel<kernels::gatherContacts> m_gatherContacts;
    BoundKernel<kernels::prepareContacts> m_prepareContacts;
    BoundKernel<kernels::solveCloths> m_solve;
    BoundKernel<kernels::solveSmallCloths> m_solveSmall;
    BoundKernel<kernels::sweepLeaves> m_sweepLeaves;
    BoundKernel<kernels::sweepGroups> m_sweepGroups;
    BoundKernel<kernels::passNodes> m_passNodes;
    BoundKernel<kernels::takeRigid> m_takeRigid;
    BoundKernel<kernels::projectRigid> m_projectRigid;
    Buffer<SolveInputWord> m_input{"solver input"};
    Buffer<SolveTopologyWord> m_topology{"solver topology"};
    std::uint64_t m_topologyRevision = 0;  // several solvers share the stage
    Buffer<Contact> m_contacts{"solver contacts"};
    Buffer<SolveWorkWord> m_work{"solver memory"};
    std::unique_ptr<Staging<SolveInputWord>> m_inputWritten = std::make_unique<Staging<SolveInputWord>>();
    std::unique_ptr<Staging<SolveWorkWord>> m_resultRead = std::make_unique<Staging<SolveWorkWord>>();
    Contact m_head = {};  // head of the uploaded contacts
    KeptNodes m_kept;
};
}  // namespace drape
