#include "kept_nodes.h"

#include <algorithm>

#include "bullet_plugin/core/device/list_launch.h"
#include "kernels/lib/geometry/vec3.h"

namespace drape
{
namespace
{
// Maximum work-items of a cloth. Their bounds meet in one word of memory.
constexpr std::size_t kMostLanes = 4096;

KeptBoxes boxesOf(const KeptBounds& bounds)
{
    KeptBoxes boxes;
    for (std::size_t k = 0; k < 3 * DRAPE_KEPT_BOXES; ++k)
    {
        boxes.m_low[k / 3][k % 3] = drapeFromBits(numberBits(bounds.m_low[k]));
        boxes.m_high[k / 3][k % 3] = drapeFromBits(numberBits(bounds.m_high[k]));
    }
    boxes.m_areFinite = bounds.m_isInvalid == 0;
    return boxes;
}

KeptBounds emptyBounds()
{
    KeptBounds bounds = {};
    std::fill_n(bounds.m_low, 3 * DRAPE_KEPT_BOXES, 0xffffffffu);
    return bounds;
}
}  // namespace

void KeptNodes::create(Device& device, const ProgramLoader& load)
{
    const cl::Program program = load("solver/kept_nodes");
    m_predict.create(device, program);
    m_takePaths.create(device, program);
    m_keep.create(device, program);
    m_device = &device;
}

KeptId KeptNodes::add(std::size_t count)
{
    const auto isFit = [count](const Slot& slot) { return !slot.m_isUsed && slot.m_room >= count; };
    auto slot = std::find_if(m_slots.begin(), m_slots.end(), isFit);
    if (slot == m_slots.end())
    {
        const std::size_t first = m_slots.empty() ? 0 : m_slots.back().m_first + m_slots.back().m_room;
        m_device->wait();  // for transfers into the memory that grows
        m_nodes.extend(*m_device, 2 * (first + count), 2 * first);
        growRead(first + count);
        m_written->reserve(m_device, first + count);
        m_slots.emplace_back();
        m_slots.back().m_first = first;
        m_slots.back().m_room = count;
        slot = m_slots.end() - 1;
    }
    slot->m_isUsed = true;
    slot->m_count = count;
    slot->m_boxes = KeptBoxes();
    return KeptId(slot - m_slots.begin());
}

// Keeps nodes that were read: nodesRead() of other cloths may still be due.
void KeptNodes::growRead(std::size_t count)
{
    if (m_read->capacity() >= count) return;
    auto larger = std::make_unique<Staging<KeptNode>>();
    larger->reserve(m_device, count);
    std::copy(m_read->data(), m_read->data() + m_read->capacity(), larger->data());
    m_read = std::move(larger);
}

void KeptNodes::remove(KeptId id)
{
    m_slots[id].m_isUsed = false;
}

void KeptNodes::write(KeptId id, const std::vector<KeptNode>& nodes, const KeptBoxes& boxes)
{
    Slot& slot = m_slots[id];
    slot.m_boxes = boxes;
    if (slot.m_waitsAtWrite == m_device->waits()) m_device->wait();
    slot.m_waitsAtWrite = m_device->waits();
    KeptNode* const sent = m_written->data() + slot.m_first;
    std::copy(nodes.begin(), nodes.end(), sent);
    m_nodes.write(*m_device, sent, slot.m_count, firstNodeOf(slot, slot.m_turn));
}

void KeptNodes::beginRead(KeptId id)
{
    const Slot& slot = m_slots[id];
    m_nodes.read(*m_device, m_read->data() + slot.m_first, slot.m_count, firstNodeOf(slot, slot.m_turn));
    m_device->flush();
}

KeptCloth KeptNodes::clothOf(const KeptStep& step) const
{
    const Slot& slot = m_slots[step.m_id];
    KeptCloth cloth = {};
    cloth.m_count = cl_uint(slot.m_count);
    cloth.m_before = firstNodeOf(slot, slot.m_turn);
    cloth.m_after = firstNodeOf(slot, 1 - slot.m_turn);
    cloth.m_start = cloth.m_end = DRAPE_NOT_DETECTED;
    cloth.m_gravity = step.m_gravity;
    cloth.m_time = step.m_time;
    cloth.m_perSecond = step.m_perSecond;
    cloth.m_shift = step.m_shift;
    cloth.m_supportShift = step.m_supportShift;
    return cloth;
}

// Sets the launch over the cloths. Returns its number of work-items.
std::size_t KeptNodes::width(const std::vector<KeptCloth>& cloths)
{
    std::size_t most = 1;
    for (const KeptCloth& cloth : cloths)
        most = std::max(most, std::size_t(cloth.m_count));
    m_launch = {cl_uint(cloths.size()), cl_uint(std::min(most, kMostLanes))};
    return cloths.size() * m_launch.m_lanes;
}

void KeptNodes::predict(const std::vector<KeptCloth>& cloths, Buffer<float>& detected)
{
    m_detectedSent = cloths;
    m_detected.assign(*m_device, m_detectedSent);
    const std::size_t items = width(m_detectedSent);
    m_predict.launch(*m_device, items, listGroup(*m_device), m_launch, m_detected, m_nodes, detected);
}

void KeptNodes::takePaths(const std::vector<KeptCloth>& cloths, const SolveLayout& layout,
                          Buffer<SolveTopologyWord>& topology, Buffer<SolveWorkWord>& work)
{
    m_solvedSent = cloths;
    m_solved.assign(*m_device, m_solvedSent);
    const std::size_t items = width(m_solvedSent);
    m_takePaths.launch(*m_device, items, listGroup(*m_device), m_launch, layout, topology, m_solved, m_nodes, work);
}

void KeptNodes::keep(const SolveLayout& layout, Buffer<SolveTopologyWord>& topology, Buffer<SolveWorkWord>& work)
{
    m_emptyBounds.assign(m_solvedSent.size(), emptyBounds());
    m_boundsRead.resize(m_solvedSent.size());
    m_bounds.assign(*m_device, m_emptyBounds);
    const std::size_t items = width(m_solvedSent);
    m_keep.launch(*m_device, items, listGroup(*m_device), m_launch, layout, topology, m_solved, m_nodes, work,
                  m_bounds);
    m_bounds.read(*m_device, m_boundsRead.data(), m_boundsRead.size());
}

bool KeptNodes::isGood(std::size_t index) const
{
    return m_boundsRead[index].m_isInvalid == 0 && m_boundsRead[index].m_isOffPath == 0;
}

void KeptNodes::accept(KeptId id, std::size_t index)
{
    Slot& slot = m_slots[id];
    slot.m_turn = 1 - slot.m_turn;
    slot.m_boxes = boxesOf(m_boundsRead[index]);
}
}  // namespace drape
