#include "solve_stage.h"

namespace drape
{
namespace
{
// Maximum nodes of a cloth for the small group.
constexpr std::size_t kMostSmallNodes = 512;
}  // namespace

void SolveStage::create(Device& device, const ProgramLoader& load)
{
    m_solve.create(device, load("solver/solve_cloths"));
    m_solveSmall.create(device, load("solver/solve_cloths"));
    m_device = &device;
}

SolveInputWord* SolveStage::input(std::size_t words)
{
    if (m_inputWritten->capacity() < words) m_inputWritten->reserve(m_device, words + words / 4);
    return m_inputWritten->data();
}

template <class Kernel>
void SolveStage::launch(Kernel& kernel, std::size_t gpuGroup, const SolveStep& step)
{
    const std::size_t group = m_device->isGpu() ? gpuGroup : DRAPE_SOLVE_CPU_GROUP;
    kernel.launch(*m_device, step.m_clothCount * group, group, step.m_layout, m_input, m_topology, m_contacts, m_work,
                  step.m_mostNodes);
}

void SolveStage::submit(const SolveStep& step)
{
    Device& device = *m_device;
    m_input.reserve(device, step.m_inputWords);
    m_input.write(device, step.m_input, step.m_inputWords);
    if (step.m_topology)
    {
        m_topology.reserve(device, step.m_topologyWords);
        m_topology.write(device, step.m_topology, step.m_topologyWords);
    }
    m_contacts.reserve(device, step.m_contactCount);
    m_contacts.write(device, step.m_contacts, step.m_contactCount);
    m_work.reserve(device, step.m_workWords);
    if (m_resultRead->capacity() < step.m_resultWords)
        m_resultRead->reserve(m_device, step.m_resultWords + step.m_resultWords / 4);
    if (step.m_mostNodes <= kMostSmallNodes)
        launch(m_solveSmall, DRAPE_SOLVE_SMALL_GROUP, step);
    else
        launch(m_solve, DRAPE_SOLVE_GROUP, step);
    m_work.read(device, m_resultRead->data(), step.m_resultWords);
    device.flush();
}

const SolveWorkWord* SolveStage::finish()
{
    m_device->wait();
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
