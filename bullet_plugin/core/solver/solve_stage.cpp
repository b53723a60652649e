#include "solve_stage.h"

namespace drape
{
namespace
{
// Work-items of a cloth: on a GPU as many as its registers allow; on a CPU one, without barriers.
constexpr std::size_t kGroupGpu = 512, kGroupCpu = 1;
}  // namespace

void SolveStage::create(Device& device, const ProgramLoader& load)
{
    m_solve.create(device, load("solver/solve_cloths"));
    m_device = &device;
}

SolveInputWord* SolveStage::input(std::size_t words)
{
    if (m_inputWritten->capacity() < words) m_inputWritten->reserve(m_device, words + words / 4);
    return m_inputWritten->data();
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
    const std::size_t group = device.isGpu() ? kGroupGpu : kGroupCpu;
    m_solve.launch(device, step.m_clothCount * group, group, step.m_layout, m_input, m_topology, m_contacts, m_work,
                   step.m_mostNodes);
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
