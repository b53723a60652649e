#include "solve_stage.h"

#include <algorithm>
#include <cstring>

#include "bullet_plugin/core/device/list_launch.h"
#include "bullet_plugin/core/solver/host/substeps.h"

namespace drape
{
void SolveStage::create(Device& device, const ProgramLoader& load)
{
    const cl::Program order = load("solver/order_contacts"), cloths = load("solver/solve_cloths"),
                      groups = load("solver/solve_groups"), rigid = load("solver/solve_rigid");
    m_takePaths.create(device, order);
    m_countContacts.create(device, order);
    m_placeBuckets.create(device, order);
    m_gatherContacts.create(device, order);
    m_prepareContacts.create(device, order);
    m_solve.create(device, cloths);
    m_solveSmall.create(device, cloths);
    m_sweepLeaves.create(device, cloths);
    m_sweepGroups.create(device, groups);
    m_passNodes.create(device, groups);
    m_takeRigid.create(device, rigid);
    m_projectRigid.create(device, rigid);
    m_kept.create(device, load);
    m_device = &device;
}

SolveInputWord* SolveStage::input(std::size_t words)
{
    if (m_inputWritten->capacity() < words) m_inputWritten->reserve(m_device, words + words / 4);
    return m_inputWritten->data();
}

void SolveStage::upload(const SolveStep& step)
{
    Device& device = *m_device;
    m_input.reserve(device, step.m_inputWords);
    m_input.write(device, step.m_input, step.m_inputWords);
    if (m_topologyRevision != step.m_topologyRevision)
    {
        m_topology.reserve(device, step.m_topologyWords);
        m_topology.write(device, step.m_topology, step.m_topologyWords);
        m_topologyRevision = step.m_topologyRevision;
    }
    if (!isOnDevice()) uploadContacts(step.m_contacts);
    if (m_work.capacity() < step.m_workWords) m_work.reserve(device, step.m_workWords + step.m_workWords / 4);
    m_work.fill(device, 0, step.m_clearedWords);
}

void SolveStage::uploadContacts(const ContactList& contacts)
{
    StepCounters counters = {};
    counters.m_contactsStored = std::uint32_t(contacts.size());
    static_assert(sizeof(counters) <= sizeof(m_head) * DRAPE_CONTACT_HEAD && DRAPE_CONTACT_HEAD == 1);
    std::memcpy(&m_head, &counters, sizeof(counters));
    m_contacts.reserve(*m_device, DRAPE_CONTACT_HEAD + contacts.size());
    m_contacts.write(*m_device, &m_head, DRAPE_CONTACT_HEAD);
    m_contacts.write(*m_device, contacts.begin(), contacts.size(), DRAPE_CONTACT_HEAD);
}

// Takes the nodes' paths, and sorts the contacts.
void SolveStage::orderContacts(const SolveStep& step)
{
    Device& device = *m_device;
    const auto launch = [&](auto& kernel, std::size_t items)
    {
        kernel.launch(device, listWidth(device, items), listGroup(device), step.m_layout, m_input, m_topology,
                      contacts(), m_work);
    };
    launch(m_takePaths, step.m_layout.m_nodeCount);
    if (!step.m_kept.empty()) m_kept.takePaths(step.m_kept, step.m_layout, m_topology, m_work);
    if (!hasContacts()) return;
    const std::size_t count =
        std::max(isOnDevice() ? step.m_onDevice.m_expected : step.m_contacts.size(), std::size_t(1));
    launch(m_countContacts, count);
    launch(m_placeBuckets, step.m_layout.m_bucketCount);
    launch(m_gatherContacts, count);
    launch(m_prepareContacts, count);
}

template <class Kernel>
void SolveStage::solveWhole(Kernel& kernel, std::size_t gpuGroup, const SolveRange& groups)
{
    const std::size_t group = m_device->isGpu() ? gpuGroup : DRAPE_SOLVE_CPU_GROUP;
    SolvePass pass = {};
    pass.m_firstGroup = groups.m_first;
    kernel.launch(*m_device, groups.m_count * group, group, m_step->m_layout, m_input, m_topology, contacts(), m_work,
                  pass, m_step->m_mostNodes, m_step->m_mostNodes);
}

// Runs a pass over the nodes of the leaves; the first one over all groups.
void SolveStage::passNodes(SolvePass pass)
{
    const std::size_t group = m_device->isGpu() ? DRAPE_SOLVE_GROUP : DRAPE_SOLVE_CPU_GROUP;
    pass.m_firstGroup = m_step->m_levels.front().m_groups.m_first;
    std::size_t groups = m_step->m_levels.front().m_groups.m_count;
    for (std::size_t i = 1; pass.m_pass == DRAPE_PASS_BEGIN && i < m_step->m_levels.size(); ++i)
        groups += m_step->m_levels[i].m_groups.m_count;
    m_passNodes.launch(*m_device, groups * group, group, m_step->m_layout, m_input, m_topology, contacts(), m_work,
                       pass);
}

// Runs a pass over the groups of each level, from the leaves on.
void SolveStage::passLevels(SolvePass pass)
{
    const bool isOfLinks = pass.m_pass == DRAPE_PASS_LINKS;
    if (!isOfLinks && !hasContacts()) return;
    const bool isSweep = pass.m_pass != DRAPE_PASS_SPEEDS && pass.m_pass != DRAPE_PASS_EDGE_SPEEDS;
    const bool gpu = m_device->isGpu();
    const std::size_t leaf = gpu ? DRAPE_SOLVE_GROUP : DRAPE_SOLVE_CPU_GROUP;
    const std::size_t join = gpu ? DRAPE_SOLVE_JOIN_GROUP : DRAPE_SOLVE_CPU_GROUP;
    for (const PackedTopology::Level& level : m_step->m_levels)
    {
        if (!(isOfLinks ? level.m_hasLinks : level.m_hasBuckets)) continue;
        pass.m_firstGroup = level.m_groups.m_first;
        if (isSweep && &level == &m_step->m_levels.front())
            m_sweepLeaves.launch(*m_device, level.m_groups.m_count * leaf, leaf, m_step->m_layout, m_input, m_topology,
                                 contacts(), m_work, pass, m_step->m_mostNodes, m_step->m_mostNodes);
        else
            m_sweepGroups.launch(*m_device, level.m_groups.m_count * join, join, m_step->m_layout, m_input, m_topology,
                                 contacts(), m_work, pass);
    }
}

void SolveStage::takeRigid()
{
    const RigidLayout& rigid = m_step->m_rigid;
    if (rigid.m_chainCount == 0) return;
    const std::size_t group = listGroup(*m_device), items = std::max(rigid.m_bodyCount, rigid.m_givenCount);
    m_takeRigid.launch(*m_device, (items + group - 1) / group * group, group, m_step->m_layout, rigid, m_input, m_work);
}

// Projects the rows beside rigid bodies.
void SolveStage::passRigid(SolvePass pass)
{
    const RigidLayout& rigid = m_step->m_rigid;
    if (rigid.m_chainCount == 0) return;
    const std::size_t group = listGroup(*m_device), width = (rigid.m_chainCount + group - 1) / group * group;
    m_projectRigid.launch(*m_device, width, group, m_step->m_layout, rigid, m_input, m_work, pass);
}

// Brings nodes back that left their paths too far, beside resting obstacles, then beside each moving one.
void SolveStage::limit(SolvePass pass)
{
    if (m_step->m_regions == 0) return;
    for (const std::uint32_t part : {DRAPE_PASS_LIMIT, DRAPE_PASS_BRING_BACK})
    {
        pass.m_pass = part;
        passNodes(pass);
    }
    if (m_step->m_rests || pass.m_round > 0) return;
    for (pass.m_region = 0; pass.m_region < m_step->m_regions; ++pass.m_region)
    {
        for (const std::uint32_t part : {DRAPE_PASS_NEAR, DRAPE_PASS_CARRY_BACK})
        {
            pass.m_pass = part;
            passNodes(pass);
        }
    }
}

void SolveStage::solveLarge()
{
    SolvePass pass = {};
    pass.m_pass = DRAPE_PASS_BEGIN;
    passNodes(pass);
    takeRigid();
    for (std::uint32_t substep = 0; substep <= m_step->m_substeps; ++substep)
    {
        pass.m_substep = substep;
        pass.m_pass = DRAPE_PASS_ADVANCE;
        passNodes(pass);
        if (substep == m_step->m_substeps) break;
        if (substep > 0) limit(pass);
        for (std::uint32_t sweep = 0; sweep < Substeps::kLinkSweeps; ++sweep)
        {
            for (const std::uint32_t part : {DRAPE_PASS_LINKS, DRAPE_PASS_FACES, DRAPE_PASS_EDGES})
            {
                pass.m_pass = part;
                passLevels(pass);
            }
            SolvePass rigid = pass;
            rigid.m_sweep = sweep;
            passRigid(rigid);
        }
        m_device->flush();
    }
    pass.m_substep = DRAPE_CLOSING;
    limit(pass);
    close(0, kFirstSweeps);
    endLarge(kFirstSweeps);
}

// Runs closing sweeps over the contacts.
void SolveStage::close(std::uint32_t first, std::uint32_t last)
{
    if (!hasContacts()) return;
    SolvePass pass = {};
    pass.m_substep = DRAPE_CLOSING;
    for (pass.m_sweep = first; pass.m_sweep < last; ++pass.m_sweep)
    {
        if (pass.m_sweep > 0 && !m_step->m_rests)
        {
            pass.m_pass = DRAPE_PASS_FAR;
            passNodes(pass);
            limit(pass);
        }
        for (const std::uint32_t part : {DRAPE_PASS_FACES, DRAPE_PASS_EDGES})
        {
            pass.m_pass = part;
            passLevels(pass);
        }
    }
}

// Ends the step of large cloths for which so many closing sweeps were enough.
void SolveStage::endLarge(std::uint32_t sweeps)
{
    m_sweeps = sweeps;
    SolvePass pass = {};
    pass.m_substep = DRAPE_CLOSING;
    pass.m_sweep = sweeps;
    pass.m_round = ++m_round;
    if (hasContacts())
    {
        pass.m_pass = DRAPE_PASS_NODES;
        passLevels(pass);
        pass.m_pass = DRAPE_PASS_FAR;
        passNodes(pass);
        limit(pass);
    }
    pass.m_pass = DRAPE_PASS_END;
    passNodes(pass);
    for (const std::uint32_t part : {DRAPE_PASS_SPEEDS, DRAPE_PASS_EDGE_SPEEDS})
    {
        pass.m_pass = part;
        passLevels(pass);
    }
    pass.m_pass = DRAPE_PASS_RESULT;
    passNodes(pass);
}

void SolveStage::readResults()
{
    if (!m_step->m_kept.empty()) m_kept.keep(m_step->m_layout, m_topology, m_work);
    const std::size_t words = m_step->m_resultWords;
    if (m_resultRead->capacity() < words) m_resultRead->reserve(m_device, words + words / 4);
    m_work.read(*m_device, m_resultRead->data(), words, m_step->m_clearedWords);
    m_device->flush();
}

void SolveStage::submit(const SolveStep& step)
{
    m_step = &step;
    m_round = 0;
    upload(step);
    orderContacts(step);
    if (step.m_small.m_count > 0) solveWhole(m_solveSmall, DRAPE_SOLVE_SMALL_GROUP, step.m_small);
    if (step.m_whole.m_count > 0) solveWhole(m_solve, DRAPE_SOLVE_GROUP, step.m_whole);
    if (!step.m_levels.empty()) solveLarge();
    readResults();
}

bool SolveStage::anyOpen() const
{
    const SolveWorkWord* const words = m_resultRead->data() + (m_step->m_layout.m_results - m_step->m_clearedWords);
    const auto* const results = reinterpret_cast<const SolveResult*>(words);
    const bool behind = isOnDevice();
    return std::any_of(results, results + m_step->m_clothCount,
                       [behind](const SolveResult& result) { return result.m_isOpen && !(behind && result.m_meets); });
}

const SolveWorkWord* SolveStage::finish(bool hasWaited)
{
    if (!hasWaited) m_device->wait();
    for (; !m_device->failed() && anyOpen(); m_device->wait())
    {
        const std::uint32_t done = m_sweeps;
        close(done, done + kMoreSweeps);
        endLarge(done + kMoreSweeps);
        readResults();
    }
    return m_device->failed() ? nullptr : m_resultRead->data();
}

void SolveStage::giveBackRoom()
{
    if (!created()) return;
    m_device->wait();
    m_contacts.release();
    m_work.release();
    m_inputWritten = std::make_unique<Staging<SolveInputWord>>();
    m_resultRead = std::make_unique<Staging<SolveWorkWord>>();
}
}  // namespace drape
