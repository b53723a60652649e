// Host and device give the same contacts, bit for bit, over random sequences of steps in which meshes come, go and
// move.
#include <gtest/gtest.h>

#include <algorithm>

#include "scenes/cloth_grid.h"
#include "scenes/shapes.h"
#include "tests/support/backends.h"
#include "tests/support/pipeline_driver.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
struct LiveMesh
{
    MeshId m_id;
    TriangleMesh m_mesh;
};

// The same scene in both pipelines; ids must agree.
class Twins
{
public:
    Twins(Pipeline& host, Pipeline& device, std::uint32_t seed) : m_host(host), m_device(device), m_random(seed) {}

    void changeMeshes()
    {
        if (m_cloths.size() < 4 && m_random.below(3) == 0) add(m_cloths, randomCloth(), true);
        if (m_obstacles.size() < 4 && m_random.below(3) == 0) add(m_obstacles, randomObstacle(), false);
        if (m_random.below(5) == 0) removeOne(m_cloths);
        if (m_random.below(5) == 0) removeOne(m_obstacles);
        for (LiveMesh& obstacle : m_obstacles)
        {
            if (m_random.below(4) != 0) continue;
            translate(obstacle.m_mesh.m_positions, m_random.uniform(-0.05f, 0.05f), m_random.uniform(-0.05f, 0.05f),
                      0.0f);
            m_host.moveObstacle(obstacle.m_id, obstacle.m_mesh.m_positions.data());
            m_device.moveObstacle(obstacle.m_id, obstacle.m_mesh.m_positions.data());
        }
    }

    void moveCloths()
    {
        for (LiveMesh& cloth : m_cloths)
        {
            std::vector<float> end = cloth.m_mesh.m_positions;
            translate(end, 0.0f, m_random.uniform(-0.05f, 0.03f), 0.0f);
            disturb(end, 0.02f, m_random);
            setMotion(m_host, cloth.m_id, cloth.m_mesh.m_positions, end);
            setMotion(m_device, cloth.m_id, cloth.m_mesh.m_positions, end);
            cloth.m_mesh.m_positions = end;
        }
    }

    void namePairs()
    {
        for (const LiveMesh& cloth : m_cloths)
        {
            for (const LiveMesh& obstacle : m_obstacles)
            {
                if (m_random.below(4) == 0) continue;
                const float thickness = m_random.uniform(0.01f, 0.05f);
                m_host.addPair(cloth.m_id, obstacle.m_id, thickness);
                m_device.addPair(cloth.m_id, obstacle.m_id, thickness);
            }
        }
    }

private:
    TriangleMesh randomCloth()
    {
        const int nodes = 3 + int(m_random.below(14));
        TriangleMesh mesh = makeClothGrid(nodes, nodes + 1, 1.0f, m_random.uniform(0.1f, 0.5f)).m_mesh;
        if (m_random.below(5) == 0) mesh.m_triangles.clear();
        return mesh;
    }
    TriangleMesh randomObstacle()
    {
        const char* const shapes[] = {"sphere", "box", "torus", "terrain"};
        if (m_random.below(6) == 0) return TriangleMesh();
        if (m_random.below(4) == 0) return makeSoup(1.0f, 0.2f, int(1 + m_random.below(150)), m_random.below(1000));
        return shapeNamed(shapes[m_random.below(4)]);
    }
    void add(std::vector<LiveMesh>& meshes, TriangleMesh mesh, bool cloth)
    {
        const MeshId id = cloth ? addCloth(m_host, mesh) : addObstacle(m_host, mesh);
        EXPECT_EQ(cloth ? addCloth(m_device, mesh) : addObstacle(m_device, mesh), id);
        meshes.push_back({id, std::move(mesh)});
    }
    void removeOne(std::vector<LiveMesh>& meshes)
    {
        if (meshes.empty()) return;
        const std::ptrdiff_t at = std::ptrdiff_t(m_random.below(std::uint32_t(meshes.size())));
        m_host.remove(meshes[std::size_t(at)].m_id);
        m_device.remove(meshes[std::size_t(at)].m_id);
        meshes.erase(meshes.begin() + at);
    }

    Pipeline& m_host;
    Pipeline& m_device;
    Random m_random;
    std::vector<LiveMesh> m_cloths, m_obstacles;
};
}  // namespace

class HostDeviceTest : public BackendTest
{
protected:
    std::unique_ptr<Pipeline> m_host, m_device;

    bool makeBoth(bool intersections = false)
    {
        Settings host = allBackends()[0].m_settings, device = GetParam().m_settings;
        host.m_reportIntersections = device.m_reportIntersections = intersections;
        m_host = makePipeline(host);
        m_device = makePipeline(device);
        return m_host && m_device;
    }
};

TEST_P(HostDeviceTest, RandomSequences)
{
    std::size_t contacts = 0, quiet = 0;
    for (std::uint32_t seed = 800; seed < 804; ++seed)
    {
        ASSERT_TRUE(makeBoth());
        Twins twins(*m_host, *m_device, seed);
        for (int step = 0; step < 60; ++step)
        {
            SCOPED_TRACE("seed " + std::to_string(seed) + ", step " + std::to_string(step));
            twins.changeMeshes();
            twins.moveCloths();
            twins.namePairs();
            const std::vector<Contact> host = runStep(*m_host), device = runStep(*m_device);
            ASSERT_TRUE(sameBytes(device, host)) << difference(device, host);
            EXPECT_EQ(m_device->statistics().m_status, m_host->statistics().m_status) << m_device->lastError().text();
            contacts += host.size();
            quiet += host.empty();
        }
    }
    EXPECT_GT(contacts, 10000u);
    EXPECT_LT(quiet, 200u);
    EXPECT_FALSE(m_device->deviceReport().m_onHost);
}

TEST_P(HostDeviceTest, LargeStepGrowsBuffersAndAgrees)
{
    ASSERT_TRUE(makeBoth(true));
    const StepCase step = soupCase(3000, 3000, true, 810);
    SCOPED_TRACE(step.trace());
    const std::vector<Contact> host = runCase(*m_host, step), device = runCase(*m_device, step);
    EXPECT_GT(m_device->statistics().m_retries, 0u);
    EXPECT_EQ(m_host->statistics().m_intersections, m_device->statistics().m_intersections);
    EXPECT_GT(m_host->statistics().m_intersections, 100u);
    EXPECT_TRUE(sameBytes(device, host)) << difference(device, host);
    EXPECT_GT(host.size(), 10000u);
}

// Two runs of the same on one device: the order of its work-items leaves no trace.
TEST_P(HostDeviceTest, RunsRepeat)
{
    const StepCase step = fallingCase("terrain", 33, 0.03f, 820);
    SCOPED_TRACE(step.trace());
    std::vector<Contact> first;
    for (int run = 0; run < 5; ++run)
    {
        const std::unique_ptr<Pipeline> pipeline = makePipeline(GetParam().m_settings);
        ASSERT_TRUE(pipeline);
        const std::vector<Contact> contacts = runCase(*pipeline, step);
        if (run == 0) first = contacts;
        ASSERT_TRUE(sameBytes(contacts, first)) << difference(contacts, first);
    }
}

INSTANTIATE_TEST_SUITE_P(Devices, HostDeviceTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
