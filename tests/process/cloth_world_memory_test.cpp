// Each allocation in turn fails in the functions of ClothWorld and of the C interface. They say so, and the world
// continues.
#include <gtest/gtest.h>

#include <drape/c_api.h>
#include <drape/cloth_world.h>

#include "scenes/cloth_grid.h"
#include "scenes/shapes.h"
#include "tests/process/failing_allocations.h"
#include "tests/support/own_process.h"

namespace drape::test
{
namespace
{
constexpr double kDt = 1.0 / 60;  // s
constexpr long kMostAllocations = 20000;

Settings onHost()
{
    Settings settings;
    settings.m_backend = Backend::Host;
    settings.m_threads = 1;
    return settings;
}

struct Meshes
{
    Meshes()
    {
        m_cloth.m_positions = m_sheet.m_positions.data();
        m_cloth.m_vertexCount = m_sheet.vertexCount();
        m_cloth.m_triangles = m_sheet.m_triangles.data();
        m_cloth.m_triangleCount = m_sheet.triangleCount();
        m_cloth.m_selfCollision = 1;
        m_floor.m_positions = m_box.m_positions.data();
        m_floor.m_vertexCount = m_box.vertexCount();
        m_floor.m_triangles = m_box.m_triangles.data();
        m_floor.m_triangleCount = m_box.triangleCount();
    }

    TriangleMesh m_sheet = makeClothGrid(4, 4, 0.5f, 0.115f).m_mesh, m_box = makeBox(2, 0.2f, 2);
    ClothDescription m_cloth = defaultCloth();
    ObstacleDescription m_floor = defaultObstacle();
};

// Returns the number of contacts after some steps.
std::size_t contactsOf(ClothWorld& world)
{
    for (int step = 0; step < 6; ++step)
        EXPECT_TRUE(world.step(kDt)) << world.error().text();
    std::vector<ClothContact> contacts;
    EXPECT_TRUE(world.contacts(contacts)) << world.error().text();
    return contacts.size();
}

// Calls scenario(number) until it returns false, which means that there were not so many allocations.
template <class Scenario>
void forEachAllocation(const Scenario& scenario)
{
    long number = 0;
    while (number < kMostAllocations && !testing::Test::HasFailure() && scenario(number))
        ++number;
    EXPECT_GT(number, 0);
    EXPECT_LT(number, kMostAllocations);
}
}  // namespace

TEST(ClothWorldOutOfMemory, AWorldIsMadeOrSaysWhyNot)
{
    inOwnProcess(
        []
        {
            const Settings settings = onHost();
            const Meshes meshes;
            forEachAllocation(
                [&](long number)
                {
                    std::unique_ptr<ClothWorld> world;
                    Error error;
                    bool failed = false;
                    {
                        const FailingAllocations failing(number);
                        world = ClothWorld::create(settings, error);
                        failed = FailingAllocations::hasFailed();
                    }
                    EXPECT_EQ(world == nullptr, error.failed());
                    if (!world)
                        EXPECT_EQ(error.m_kind, ErrorKind::Memory) << error.text();
                    else
                    {
                        EXPECT_EQ(world->addCloth(meshes.m_cloth), 0);
                        EXPECT_EQ(world->addObstacle(meshes.m_floor), 0);
                        EXPECT_GT(contactsOf(*world), 0u) << "allocation " << number;
                    }
                    return failed;
                });
        });
}

TEST(ClothWorldOutOfMemory, FunctionsSaySoAndTheWorldGoesOn)
{
    inOwnProcess(
        []
        {
            const Meshes meshes;
            forEachAllocation(
                [&](long number)
                {
                    Error error;
                    const std::unique_ptr<ClothWorld> world = ClothWorld::create(onHost(), error);
                    int cloth = -1, floor = -1;
                    bool failed = false;
                    {
                        const FailingAllocations failing(number);
                        cloth = world->addCloth(meshes.m_cloth);
                        floor = world->addObstacle(meshes.m_floor);
                        const double position[3] = {0, 0, 0}, rotation[4] = {0, 0, 0, 1};
                        world->setPose(floor, position, rotation, true);
                        world->step(kDt);
                        std::vector<ClothContact> contacts;
                        world->contacts(contacts);
                        world->diagnose();
                        failed = FailingAllocations::hasFailed();
                    }
                    EXPECT_TRUE(failed || (cloth == 0 && floor == 0));
                    EXPECT_EQ(cloth < 0 ? world->addCloth(meshes.m_cloth) : 0, 0) << world->error().text();
                    EXPECT_EQ(floor < 0 ? world->addObstacle(meshes.m_floor) : 0, 0) << world->error().text();
                    EXPECT_GT(contactsOf(*world), 0u) << "allocation " << number;
                    return failed;
                });
        });
}

TEST(ClothWorldOutOfMemory, TheCInterfaceReturnsItsCode)
{
    inOwnProcess(
        []
        {
            DrapeSettings settings = {};
            drapeDefaultSettings(&settings);
            settings.m_backend = DRAPE_BACKEND_HOST;
            forEachAllocation(
                [&](long number)
                {
                    DrapeWorld* world = nullptr;
                    DrapeResult result = DRAPE_OK;
                    bool failed = false;
                    {
                        const FailingAllocations failing(number);
                        result = drapeWorldCreate(&settings, &world);
                        failed = FailingAllocations::hasFailed();
                    }
                    EXPECT_TRUE(result == DRAPE_OK || result == DRAPE_OUT_OF_MEMORY) << drapeErrorText();
                    EXPECT_EQ(world != nullptr, result == DRAPE_OK);
                    EXPECT_TRUE(world || std::string(drapeErrorText()).find("out of memory") != std::string::npos);
                    drapeWorldDestroy(world);
                    return failed;
                });
        });
}
}  // namespace drape::test
