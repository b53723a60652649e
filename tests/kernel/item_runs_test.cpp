// Launches of fixed width over lists: every item is taken, once, and on a CPU what lies side by side by one work-item.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "bullet_plugin/core/device/program.h"
#include "tests/support/backends.h"
#include "tests/support/canary.h"

namespace drape::test
{
namespace
{
constexpr cl_uint kLongestRun = 128;

const char* const kTake = R"(
__kernel void takeItems(const uint count, const uint parts, __global uint* takenBy, __global uint* taken,
                        __global uint* taker)
{
    for (ItemRuns runs = itemRuns(count, parts); runs.m_item < count; nextItem(&runs))
    {
        atomic_inc(taken + runs.m_item);
        atomic_or(takenBy + runs.m_item, 1u << get_global_id(0) % parts);
        taker[runs.m_item] = get_global_id(0) / parts;
    }
}
)";

// Records for each item the parts that took it, as bits, how often any did, and the last taker.
struct Taken
{
    std::vector<cl_uint> m_parts, m_times, m_taker;
};

class Taking
{
public:
    Taking(Device& device, const std::string& defines) : m_device(device)
    {
        m_program =
            compileSource(device, "item_runs", defines + assembleSource("kernels/lib/work_items/item_runs.h") + kTake);
        m_kernel.create(device, m_program, "takeItems");
    }

    Taken run(cl_uint width, cl_uint count, cl_uint parts, cl_uint group = 8)
    {
        Buffer<cl_uint> takenBy, taken, taker;
        const std::vector<cl_uint> zeros(std::max(count, 1u), 0);
        guardCopy(m_device, takenBy, zeros);
        guardCopy(m_device, taken, zeros);
        guardCopy(m_device, taker, zeros);
        m_kernel.launch(m_device, width, group, count, parts, takenBy.handle(), taken.handle(), taker.handle());
        const Taken found = {contents(m_device, takenBy, count), contents(m_device, taken, count),
                             contents(m_device, taker, count)};
        EXPECT_TRUE(intact(m_device, takenBy) && intact(m_device, taken) && intact(m_device, taker));
        return found;
    }

private:
    Device& m_device;
    cl::Program m_program;
    Kernel m_kernel;
};

// Returns the number of items whose successor belongs to another work-item.
cl_uint changes(const std::vector<cl_uint>& taker)
{
    cl_uint count = 0;
    for (std::size_t i = 1; i < taker.size(); ++i)
        count += taker[i] != taker[i - 1];
    return count;
}

// Returns the largest difference between the numbers of items of two work-items.
cl_uint imbalance(const std::vector<cl_uint>& taker, cl_uint takers)
{
    std::vector<cl_uint> share(takers, 0);
    for (cl_uint by : taker)
        ++share.at(by);
    std::sort(share.begin(), share.end());
    return share.back() - share.front();
}

struct Launch
{
    cl_uint m_width, m_group;
};
const Launch kLaunches[] = {{24, 8}, {64, 8}, {64, 64}, {768, 8}, {768, 64}};
const cl_uint kCounts[] = {0, 1, 2, 23, 24, 25, 63, 64, 65, 129, 3071, 3072, 3073, 8191, 8192, 8193, 100003};
}  // namespace

class ItemRunsTest : public BackendTest
{
};

TEST_P(ItemRunsTest, EveryItemIsTakenByEachPartOnce)
{
    const std::unique_ptr<Device> device = openDevice(GetParam());
    ASSERT_TRUE(device);
    for (const char* defines : {"", "#define DRAPE_CPU\n"})
    {
        Taking taking(*device, defines);
        for (Launch launch : kLaunches)
            for (cl_uint count : kCounts)
                for (cl_uint parts : {1u, 2u, 4u})
                {
                    const Taken taken = taking.run(launch.m_width, count, parts, launch.m_group);
                    EXPECT_EQ(taken.m_parts, std::vector<cl_uint>(count, (1u << parts) - 1u));
                    EXPECT_EQ(taken.m_times, std::vector<cl_uint>(count, parts))
                        << defines << count << " items, " << parts << " parts, " << launch.m_width << " work-items";
                }
    }
    ASSERT_FALSE(device->failed()) << device->error().text();
}

TEST_P(ItemRunsTest, NeighboursOnACpuAreOneWorkItemsUpToTheLongestRun)
{
    const std::unique_ptr<Device> device = openDevice(GetParam());
    ASSERT_TRUE(device);
    Taking strides(*device, ""), runs(*device, "#define DRAPE_CPU\n");
    EXPECT_EQ(changes(strides.run(64, 8192, 1).m_taker), 8191u);
    EXPECT_EQ(changes(runs.run(64, 640, 1).m_taker), 63u);  // ten each
    const cl_uint count = 3 * 64 * kLongestRun + 1;         // in four turns
    EXPECT_EQ(changes(runs.run(64, count, 1).m_taker), 4 * 64 - 1u);
    ASSERT_FALSE(device->failed()) << device->error().text();
}

// The numbers of items of two work-items differ by one in each turn, at most.
TEST_P(ItemRunsTest, WorkItemsTakeEqualShares)
{
    const std::unique_ptr<Device> device = openDevice(GetParam());
    ASSERT_TRUE(device);
    for (const char* defines : {"", "#define DRAPE_CPU\n"})
    {
        Taking taking(*device, defines);
        for (Launch launch : kLaunches)
            for (cl_uint count : kCounts)
            {
                const cl_uint turns = count / (launch.m_width * kLongestRun) + 1;
                EXPECT_LE(imbalance(taking.run(launch.m_width, count, 1, launch.m_group).m_taker, launch.m_width),
                          turns)
                    << defines << count << " items, " << launch.m_width << " work-items";
            }
    }
    ASSERT_FALSE(device->failed()) << device->error().text();
}

INSTANTIATE_TEST_SUITE_P(Devices, ItemRunsTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
