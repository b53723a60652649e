// Lines of Settings::m_log about a world's setup, each told once.
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"

namespace drape::test
{
namespace
{
class LogTest : public testing::Test
{
protected:
    LogTest()
    {
        m_settings.m_backend = Backend::Host;
        m_settings.m_log = [this](const char* line) { m_lines.push_back(line); };
    }

    std::size_t countOf(const std::string& part) const
    {
        return std::size_t(std::count_if(m_lines.begin(), m_lines.end(),
                                         [&](const std::string& line)
                                         { return line.find(part) != std::string::npos; }));
    }

    // Drops two cloths onto a ball.
    void drop(DropWorld& world, float margin = kMargin)
    {
        world.addObstacle(m_ball.shape());
        for (const float height : {0.55f, 0.65f})
        {
            ClothSpec spec;
            spec.m_centre = btVector3(0, btScalar(height), 0);
            world.addCloth(spec).getCollisionShape()->setMargin(btScalar(margin));
        }
        world.step(10);
    }

    std::vector<std::string> m_lines;
    Settings m_settings;
    MeshShape m_ball{makeSphere(0.5f, 3)};
};
}  // namespace

TEST_F(LogTest, SaysNothingOfAGoodWorld)
{
    Plugin plugin(m_settings);
    DropWorld world(&plugin);
    drop(world);
    EXPECT_FALSE(plugin.contacts().empty());
    EXPECT_TRUE(m_lines.empty()) << m_lines[0];
}

TEST_F(LogTest, NamesExceptionsOfTheAppsFunctionsOnce)
{
    m_settings.m_threads = 4;
    m_settings.m_parallelFor = [](std::size_t, const std::function<void(std::size_t)>&)
    { throw std::runtime_error("no workers"); };
    Plugin plugin(m_settings);
    plugin.setContactListener([](const StepContacts&) { throw std::runtime_error("an app's mistake"); });
    DropWorld world(&plugin);
    ClothSpec large;
    large.m_nodes = 65;
    large.m_centre = btVector3(5, 1, 0);
    world.addCloth(large);
    drop(world);
    EXPECT_EQ(m_lines.size(), 2u);
    EXPECT_EQ(countOf("contact listener threw an exception"), 1u);
    EXPECT_EQ(countOf("m_parallelFor threw an exception"), 1u);
}

TEST_F(LogTest, NamesAWorldWithoutTheCollisionConfigurationOnce)
{
    Plugin plugin(m_settings);
    DropWorld world(&plugin, Wiring::SolverOnly);
    drop(world);
    EXPECT_EQ(m_lines.size(), 1u);
    EXPECT_EQ(countOf("dispatcher does not have this plugin's algorithm"), 1u);
}

TEST_F(LogTest, NamesAWorldWithoutTheSolverOnce)
{
    Plugin plugin(m_settings);
    DropWorld world(nullptr);
    ASSERT_TRUE(install(plugin, world.dispatcher(), world.world()));
    drop(world);
    EXPECT_EQ(m_lines.size(), 1u);
    EXPECT_EQ(countOf("solver is not a drape::SoftBodySolver"), 1u);
    uninstall(plugin, world.dispatcher(), world.world());
}

TEST_F(LogTest, NamesADeviceThatIsMissing)
{
    m_settings.m_backend = Backend::Auto;
    m_settings.m_device = "no device has this name";
    const Plugin plugin(m_settings);
    EXPECT_FALSE(plugin.ready());
    EXPECT_EQ(m_lines.size(), 1u);
    EXPECT_EQ(countOf(m_settings.m_device), 1u);
}

TEST_F(LogTest, NamesAThicknessOutOfProportionToTheEdges)
{
    Plugin plugin(m_settings);
    DropWorld world(&plugin);
    drop(world, 0.3f);
    EXPECT_EQ(countOf("times the mean edge"), 2u) << "a line for each cloth";
}

// The second thread calls while the first is in a step, which waits in the log for it.
TEST_F(LogTest, NamesTwoThreadsInOnePlugin)
{
    Plugin* used = nullptr;
    m_settings.m_log = [&](const char* line)
    {
        m_lines.push_back(line);
        if (m_lines.size() == 1)
            std::thread([&] { used->prepare(static_cast<const btCollisionObject*>(nullptr)); }).join();
    };
    Plugin plugin(m_settings);
    used = &plugin;
    DropWorld world(&plugin, Wiring::SolverOnly);
    drop(world);
    ASSERT_EQ(m_lines.size(), 2u);
    EXPECT_EQ(countOf("two threads"), 1u);
    EXPECT_NE(m_lines[1].find("two threads"), std::string::npos) << m_lines[1];
}
}  // namespace drape::test
