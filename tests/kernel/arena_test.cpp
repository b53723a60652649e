// Arenas: arrays of one allocation keep what a demand keeps, wherever they move, and are listed by name.
#include "bullet_plugin/core/device/arena.h"

#include <gtest/gtest.h>

#include <numeric>

#include "kernels/shared/arenas.h"
#include "tests/support/backends.h"
#include "tests/support/canary.h"

namespace drape::test
{
namespace
{
std::vector<float> risingFrom(float first, std::size_t count)
{
    std::vector<float> numbers(count);
    std::iota(numbers.begin(), numbers.end(), first);
    return numbers;
}

std::size_t bytesOf(Device& device, const std::string& name)
{
    for (const MemoryUse& use : device.memory().list())
        if (use.m_name == name) return use.m_bytes;
    return 0;
}
}  // namespace

class ArenaTest : public DeviceTest
{
};

TEST_P(ArenaTest, GrowthKeepsWhatTheDemandKeeps)
{
    Arena<ClothWord> arena;
    ArenaArray<float> first(arena, "first"), second(arena, "second");
    first.demand(3);
    second.demand(70);
    arena.make(*m_device);
    const std::vector<float> own = risingFrom(1, 3), others = risingFrom(100, 70);
    first.append(*m_device, own);
    second.append(*m_device, others);
    m_device->wait();
    EXPECT_EQ(second.word() % 64, 0u) << "arrays begin at cache lines";

    first.demand(1000, 2);  // the second array has no demand and keeps all
    arena.make(*m_device);
    EXPECT_EQ(first.capacity(), 1250u) << "with spare room";
    EXPECT_EQ(contents(*m_device, first, 2), risingFrom(1, 2));
    EXPECT_EQ(contents(*m_device, second, 70), others);
    EXPECT_FALSE(m_device->failed()) << m_device->error().text();
}

TEST_P(ArenaTest, DemandsThatFitMoveNothing)
{
    Arena<ClothWord> arena;
    ArenaArray<float> array(arena, "array");
    array.demand(64);
    arena.make(*m_device);
    const std::vector<float> numbers = risingFrom(0, 64);
    array.append(*m_device, numbers);
    const cl_mem before = arena.handle()();
    array.demand(10, 0);
    arena.make(*m_device);
    EXPECT_EQ(arena.handle()(), before);
    EXPECT_EQ(contents(*m_device, array, 64), numbers);
}

TEST_P(ArenaTest, ArraysAreListedWhileTheyLive)
{
    {
        Arena<ClothWord> arena;
        ArenaArray<float> array(arena, "fruit"), other(arena, "stone"), empty(arena, "fruit");
        array.demand(10);
        other.demand(3);
        arena.make(*m_device);
        EXPECT_EQ(bytesOf(*m_device, "fruit"), 44u) << "an array has one element at least";
        EXPECT_EQ(bytesOf(*m_device, "stone"), 12u);
        other.demand(100);
        arena.make(*m_device);
        EXPECT_EQ(bytesOf(*m_device, "stone"), 400u);
        arena.release();
        EXPECT_EQ(bytesOf(*m_device, "stone"), 0u);
        array.demand(5);
        arena.make(*m_device);
        EXPECT_EQ(bytesOf(*m_device, "fruit"), 24u);
    }
    EXPECT_TRUE(m_device->memory().list().empty());
}

TEST_P(ArenaTest, CopiesTheFirstElementsOfAnotherArena)
{
    Arena<ClothWord> from, to;
    ArenaArray<float> gap(from, "gap"), source(from, "source"), target(to, "target");
    gap.demand(100);
    source.demand(20);
    target.demand(30);
    from.make(*m_device);
    to.make(*m_device);
    const std::vector<float> numbers = risingFrom(7, 20);
    source.append(*m_device, numbers);
    target.copy(*m_device, source, 20);
    EXPECT_EQ(contents(*m_device, target, 20), numbers);
}

TEST_P(ArenaTest, AnArenaThatIsTooLargeIsAnError)
{
    Arena<ClothWord> arena;
    ArenaArray<float> array(arena, "array");
    array.demand(std::size_t(1) << 40);
    arena.make(*m_device);
    EXPECT_TRUE(m_device->failed());
    EXPECT_EQ(arena.bytes(), 0u);
}

INSTANTIATE_TEST_SUITE_P(Devices, ArenaTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
