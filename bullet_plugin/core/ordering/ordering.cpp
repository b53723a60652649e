#include "ordering.h"

#include <algorithm>

#include "bullet_plugin/core/device/list_launch.h"

namespace drape
{
namespace
{
constexpr std::size_t kBlock = 1024;  // features of a group that sums, as in kernels/ordering/ordering.cl
constexpr std::size_t kSumGroupGpu = 256, kSumGroupCpu = 64;
constexpr std::size_t kSortGroup = 256;    // one group sorts a feature's contacts, however many
constexpr std::size_t kSortBlockGpu = 32;  // features that a group sorts one after the other
// Maximum contacts of a feature that a GPU sorts by counting lesser ones. orderingSort would count the same in local
// memory, with one launch more.
constexpr cl_uint kRankedGpu = 512;

std::size_t blocksOf(std::size_t features)
{
    return (features + kBlock - 1) / kBlock;
}
}  // namespace

void OrderingStage::create(Device& device, const ProgramLoader& load)
{
    const cl::Program ordering = load("ordering/ordering");
    m_count.create(device, ordering);
    m_place.create(device, ordering);
    m_gather.create(device, ordering);
    m_sort.create(device, ordering);
    m_write.create(device, ordering);
    if (device.isGpu()) m_gatherSmall.create(device, load("ordering/ordering_small"));
}

void OrderingStage::resizeFeatures(Device& device, std::size_t features)
{
    m_firsts.reserve(device, features);
    m_blockCounts.reserve(device, blocksOf(features));
}

void OrderingStage::reserve(Device& device, std::size_t count)
{
    m_contacts.reserve(device, DRAPE_CONTACT_HEAD + count);
    m_members.reserve(device, count);
    m_keys.reserve(device, count);
}

void OrderingStage::release()
{
    m_contacts.release();
    m_members.release();
    m_keys.release();
}

// Computes the first position of each feature's contacts. A group sums the numbers of all features before its own,
// or of all blocks where they are many.
void OrderingStage::enqueuePositions(Device& device, const OrderingValues& step, UnsortedContacts& unsorted,
                                     StepTally tally)
{
    const std::size_t group = device.isGpu() ? kSumGroupGpu : kSumGroupCpu;
    const std::size_t width = blocksOf(step.m_features) * group;
    const bool few = unsorted.few();
    OrderingValues values = step;
    values.m_block = few ? cl_uint(kBlock) : 1;
    if (!few) m_count.launch(device, width, group, values, unsorted.m_featureCounts, m_blockCounts, group);
    m_place.launch(device, width, group, values, unsorted.m_featureCounts,
                   few ? unsorted.m_featureCounts : m_blockCounts, m_firsts, tally.m_now, group);
}

// Computes the positions, and lists the members of each feature.
void OrderingStage::enqueueGather(Device& device, const OrderingValues& step, UnsortedContacts& unsorted,
                                  StepTally tally)
{
    if (step.m_sums > 0)
    {
        m_gatherSmall.launch(device, listWidth(device, step.m_features + tally.m_contacts), listGroup(device), step,
                             unsorted.m_contacts, unsorted.m_ranks, unsorted.m_featureCounts, m_firsts, m_members,
                             m_keys, tally.m_now, tally.m_next);
        return;
    }
    enqueuePositions(device, step, unsorted, tally);
    m_gather.launch(device, listWidth(device), listGroup(device), step, unsorted.m_contacts, unsorted.m_featureCounts,
                    m_firsts, m_members, m_keys, tally.m_now, tally.m_next);
}

// Sorts the members of features with more than step.m_ranked contacts.
void OrderingStage::enqueueSort(Device& device, const OrderingValues& step, StepTally tally)
{
    OrderingValues values = step;
    values.m_block = cl_uint(device.isGpu() ? kSortBlockGpu : kBlock);
    m_sort.launch(device, (step.m_features + values.m_block - 1) / values.m_block * kSortGroup, kSortGroup, values,
                  m_firsts, m_members, m_keys, tally.m_now);
}

void OrderingStage::enqueue(Device& device, UnsortedContacts& unsorted, StepTally tally)
{
    const cl_uint ranked = device.isGpu() ? kRankedGpu : DRAPE_RANKED;
    const OrderingValues values = {cl_uint(unsorted.capacity()),
                                   cl_uint(unsorted.features()),
                                   ranked,
                                   unsorted.sums(),
                                   cl_uint(kBlock),
                                   copyParts(device)};
    tally.m_contacts = std::min(tally.m_contacts, unsorted.capacity());
    enqueueGather(device, values, unsorted, tally);
    if (tally.m_ordered) enqueueSort(device, values, tally);
    m_write.launch(device, listWidth(device, tally.m_contacts * values.m_parts), listGroup(device), values,
                   unsorted.m_contacts, m_firsts, m_members, m_keys, m_contacts, tally.m_now, unsorted.m_featureCounts);
}
}  // namespace drape
