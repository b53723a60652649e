// The cull over patches lists every feature test that gives a contact, each at most once. The demand past a full list
// is the number of tests.
#include "bullet_plugin/core/broad_phase/patch_cull.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>
#include <tuple>

#include "bullet_plugin/core/scene/patch_packing.h"
#include "bullet_plugin/core/scene/patch_width.h"
#include "scenes/shapes.h"
#include "tests/support/cases.h"
#include "tests/support/device_side.h"

namespace drape::test
{
namespace
{
constexpr float kReachScale = 1.5f;

// A contact's feature pair: kind, cloth feature, obstacle feature.
using Pair = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>;

// The step's cloth, with others at its sides that are not in the step.
class DeviceCull
{
public:
    DeviceCull(Device& device, const StepCase& step, std::uint32_t mode = DRAPE_AUTOMATIC,
               const TriangleMesh& skipped = {})
        : m_device(device),
          m_mode(mode),
          m_cloth(makeSide({skipped, step.m_cloth, skipped})),
          m_obstacle(makeSide({step.m_obstacle}))
    {
        std::copy(step.m_end.begin(), step.m_end.end(),
                  m_cloth.m_end.begin() + std::ptrdiff_t(skipped.m_positions.size()));
        m_thickness = {-1.0f, step.m_thickness, -1.0f};
        const float radius = step.m_thickness * kReachScale * 1.001f;
        const ProgramLoader load = [&](const char* name) { return programOf(device, name, patchDefines(device)); };
        m_stage.create(device, load);
        m_packing.create(device, load("scene/patch_pack"));
        m_clothBuffers.upload(device, m_cloth);
        m_obstacleBuffers.upload(device, m_obstacle);
        guardCopy(device, m_thicknessBuffer, m_thickness);
        guardCopy(device, m_radius, std::vector<float>{-1.0f, radius, -1.0f});
        m_packing.setTopology(device, m_obstacle.m_pool, 0);
        guard(device, m_packing.arena());
        m_packing.pack(device, {0, 1}, m_obstacleBuffers.buffers());
    }

    // Returns the part of the list that fits.
    std::vector<FeatureTest> run(std::size_t capacity, StepCounters& counters)
    {
        Buffer<StepCounters> counterBuffer;
        clearCounters(m_device, counterBuffer);
        guard(m_device, m_tests.m_tests, capacity);
        m_stage.enqueue(m_device, m_clothBuffers.buffers(), {m_radius, m_thicknessBuffer, m_motions, 0, 1},
                        m_packing.patches(), {kReachScale, m_mode, 1u << 30, 1u << 30}, m_tests, counterBuffer);
        counters = readCounters(m_device, counterBuffer);
        const std::size_t count = std::min<std::size_t>(counters.m_candidates, m_tests.capacity());
        std::vector<FeatureTest> tests = contents(m_device, m_tests.m_tests, count);
        EXPECT_TRUE(intact(m_device, m_tests.m_tests) && intact(m_device, counterBuffer));
        EXPECT_TRUE(m_clothBuffers.allIntact(m_device) && m_obstacleBuffers.allIntact(m_device));
        EXPECT_TRUE(intact(m_device, m_packing.arena()));
        EXPECT_FALSE(m_device.failed()) << m_device.error().text();
        return tests;
    }

    Pair pairOf(const FeatureTest& test)
    {
        const std::uint32_t kind = test.m_cloth >> DRAPE_TEST_SHIFT;
        const Triangle& cloth = m_cloth.m_pool.triangles()[test.m_cloth & ((1u << DRAPE_TEST_SHIFT) - 1u)];
        if (kind < DRAPE_TEST_FACE) return {DRAPE_NODE_FACE, cloth.m_vertices[kind], id(m_packing.faceIds(), test)};
        if (kind == DRAPE_TEST_FACE)
        {
            return {DRAPE_FACE_VERTEX, std::uint32_t(&cloth - m_cloth.m_pool.triangles().data()),
                    id(m_packing.vertexIds(), test)};
        }
        return {DRAPE_EDGE_EDGE, cloth.m_edges[kind - DRAPE_TEST_EDGE], id(m_packing.edgeIds(), test)};
    }

    std::vector<Contact> hostContacts() const
    {
        std::vector<Contact> contacts;
        contactsOfPairs(allPairs(m_cloth, m_obstacle), m_cloth.cloth(), m_obstacle.obstacle(),
                        {m_thickness, 1, kReachScale, m_mode}, contacts);
        return contacts;
    }

    std::size_t featurePairs() const
    {
        const MeshPool &a = m_cloth.m_pool, &b = m_obstacle.m_pool;
        return a.vertexCount() * b.triangles().size() + a.triangles().size() * b.vertexCount() +
               a.edges().size() * b.edges().size();
    }

private:
    std::uint32_t id(const ArenaArray<cl_uint>& ids, const FeatureTest& test)
    {
        std::vector<cl_uint>& copy = m_ids[&ids];
        if (copy.empty()) copy = contents(m_device, ids, ids.capacity());
        return copy[test.m_lane];
    }

    Device& m_device;
    std::uint32_t m_mode;
    Side m_cloth, m_obstacle;
    PatchCullStage m_stage;
    PatchPacking m_packing;
    FeatureTestList m_tests{"test"};
    DeviceCloths m_clothBuffers;
    DeviceObstacles m_obstacleBuffers;
    std::vector<float> m_thickness;
    Buffer<float> m_thicknessBuffer, m_radius;
    Buffer<ObstacleMotion> m_motions;  // none
    std::map<const ArenaArray<cl_uint>*, std::vector<cl_uint>> m_ids;
};

// Expects that every contact's test is listed once, and that less than `share` of all feature pairs is listed.
StepCounters expectContactsListed(Device& device, const StepCase& step, std::uint32_t mode, double share = 0.5,
                                  const TriangleMesh& skipped = {})
{
    SCOPED_TRACE("mode " + std::to_string(mode));
    DeviceCull cull(device, step, mode, skipped);
    StepCounters counters;
    cull.run(1, counters);
    std::map<Pair, int> listed;
    for (const FeatureTest& test : cull.run(counters.m_candidates, counters))
        ++listed[cull.pairOf(test)];
    for (const auto& entry : listed)
        EXPECT_EQ(entry.second, 1);
    const std::vector<Contact> contacts = cull.hostContacts();
    for (const Contact& contact : contacts)
    {
        const Pair pair = {contact.m_kind, contact.m_clothFeature, contact.m_obstacleFeature};
        EXPECT_EQ(listed.count(pair), 1u) << "kind " << contact.m_kind << " cloth " << contact.m_clothFeature
                                          << " obstacle " << contact.m_obstacleFeature;
    }
    EXPECT_GT(contacts.size(), 0u);
    EXPECT_LT(double(counters.m_candidates), share * double(cull.featurePairs()));
    return counters;
}
}  // namespace

class PatchCullTest : public BackendTest
{
protected:
    void SetUp() override
    {
        BackendTest::SetUp();
        if (HasFatalFailure() || IsSkipped()) return;
        m_device = openDevice(GetParam());
        ASSERT_TRUE(m_device);
    }

    std::unique_ptr<Device> m_device;
};

TEST_P(PatchCullTest, ListsEveryContactOfSoups)
{
    const int sizes[][2] = {{65, 15}, {63, 16}, {64, 17}, {31, 257}, {161, 183}, {33, 1023}};
    std::uint32_t seed = 300;
    for (const auto& size : sizes)
    {
        for (bool moving : {false, true})
        {
            const StepCase step = soupCase(size[0], size[1], moving, ++seed);
            SCOPED_TRACE(step.trace() + ", " + std::to_string(size[0]) + " and " + std::to_string(size[1]) +
                         " triangles");
            for (const std::uint32_t mode : {DRAPE_DISCRETE, DRAPE_CONTINUOUS, DRAPE_AUTOMATIC})
                expectContactsListed(*m_device, step, mode);
        }
    }
}

// Packets that hold triangles of several cloths, and some with invalid nodes.
TEST_P(PatchCullTest, ListsEveryContactBesideSkippedAndInvalidTriangles)
{
    const float bad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 2e9f};
    for (const int skipped : {1, 15, 16, 23, 130})
    {
        StepCase step = soupCase(41, 183, true, 360 + std::uint32_t(skipped));
        SCOPED_TRACE(step.trace() + ", " + std::to_string(skipped) + " skipped");
        // One corner each of three triangles, and all three of one.
        const std::size_t vertices[] = {4, 27, 62, 96, 97, 98};
        for (std::size_t i = 0; i < 6; ++i)
            step.m_end[3 * vertices[i] + i % 3] = bad[i % 3];
        for (const std::uint32_t mode : {DRAPE_DISCRETE, DRAPE_CONTINUOUS, DRAPE_AUTOMATIC})
        {
            const StepCounters counters =
                expectContactsListed(*m_device, step, mode, 0.5, makeSoup(1.0f, 0.2f, skipped, 370));
            EXPECT_EQ(counters.m_invalidNodes, 6u);
        }
    }
}

TEST_P(PatchCullTest, ListsEveryContactOfShapes)
{
    for (const char* shape : {"sphere", "torus", "bowl", "stairs", "box"})
    {
        const StepCase step = fallingCase(shape, 14, 0.03f, 320);
        SCOPED_TRACE(step.trace());
        for (const std::uint32_t mode : {DRAPE_DISCRETE, DRAPE_CONTINUOUS, DRAPE_AUTOMATIC})
            expectContactsListed(*m_device, step, mode);
    }
}

// Thin triangles are kept by their distance alone, so that the list is longer.
TEST_P(PatchCullTest, ListsEveryContactOfNeedles)
{
    std::uint32_t seed = 340;
    for (const Thin thin : {Thin::Cloth, Thin::Obstacle, Thin::Both})
    {
        for (const bool moving : {false, true})
        {
            const StepCase step = needleCase(thin, 60, 1.0f, moving, ++seed);
            SCOPED_TRACE(step.trace() + ", thin " + std::to_string(int(thin)));
            for (const std::uint32_t mode : {DRAPE_DISCRETE, DRAPE_CONTINUOUS, DRAPE_AUTOMATIC})
                expectContactsListed(*m_device, step, mode, 0.9);
        }
    }
}

// The edge has 0.03 mm and is 14 m from its triangle's first corner. Relative to that corner its ends are rounded so
// far that the edge turns by two degrees.
TEST_P(PatchCullTest, ListsAShortEdgeFarFromTheFirstCorner)
{
    const TriangleMesh cloth = looseTriangles({-8.54378986f, 5.84034204f, 9.6088419f, -0.0835678056f, 0.983666301f,
                                               0.159511417f, -0.0835902393f, 0.983652651f, 0.159499258f});
    const TriangleMesh obstacle = looseTriangles({-0.0795672387f, 0.999655068f, 0.14446871f, -0.103625663f,
                                                  0.996899843f, 0.16811575f, -0.0932211801f, 1.01372147f, 0.14674969f});
    const StepCase step = {"short edge", 0, cloth, obstacle, cloth.m_positions, 0.02f};
    for (const std::uint32_t mode : {DRAPE_DISCRETE, DRAPE_CONTINUOUS, DRAPE_AUTOMATIC})
        expectContactsListed(*m_device, step, mode, 1.0);
}

// The node is level with a box's upper face to the last bit, 24 mm beside it. The edges' cones admit points in the
// face's plane, at any height of the node above it.
TEST_P(PatchCullTest, ListsANodeLevelWithAFaceBesideIt)
{
    const TriangleMesh cloth = looseTriangles({0.55f, 0.31f, 0.0f, 0.55f, 0.31f, 0.06f, 0.524f, 0.3f, 0.03f});
    const StepCase step = {"level node", 0, cloth, makeBox(1.0f, 0.6f, 0.8f), cloth.m_positions, 0.02f};
    for (const std::uint32_t mode : {DRAPE_DISCRETE, DRAPE_CONTINUOUS, DRAPE_AUTOMATIC})
        expectContactsListed(*m_device, step, mode, 1.0);
}

TEST_P(PatchCullTest, FullListCountsOn)
{
    DeviceCull cull(*m_device, fallingCase("sphere", 12, 0.03f, 330));
    SCOPED_TRACE("seed 330");
    StepCounters whole, counters;
    cull.run(1, whole);
    ASSERT_GT(whole.m_candidates, 100u);
    for (std::size_t capacity : {std::size_t(1), std::size_t(63), std::size_t(whole.m_candidates - 1)})
    {
        EXPECT_EQ(cull.run(capacity, counters).size(), capacity);
        EXPECT_EQ(counters.m_candidates, whole.m_candidates);
    }
}

// The packed features of obstacles, as bytes.
class PackedObstacles
{
public:
    explicit PackedObstacles(Device& device) : m_device(device)
    {
        m_packing.create(device, programOf(device, "scene/patch_pack", patchDefines(device)));
    }

    // Packs from that slot on; earlier slots remain unchanged.
    void pack(const std::vector<TriangleMesh>& meshes, std::size_t firstSlot)
    {
        const Side side = makeSide(meshes);
        DeviceObstacles buffers;
        buffers.upload(m_device, side);
        m_packing.setTopology(m_device, side.m_pool, firstSlot);
        m_packing.pack(m_device, {firstSlot, meshes.size()}, buffers.buffers());
        m_device.wait();
        EXPECT_TRUE(buffers.allIntact(m_device));
        m_layout = makePatches(side.m_pool, side.m_start.data(), patchWidth(m_device));
    }

    std::vector<std::uint32_t> bytes()
    {
        std::vector<std::uint32_t> all;
        append(all, m_packing.faces(), m_layout.m_faceOwners.size() * DRAPE_FACE_FLOATS);
        append(all, m_packing.vertices(), m_layout.m_vertexOwners.size() * DRAPE_VERTEX_FLOATS);
        append(all, m_packing.edges(), m_layout.m_edgeOwners.size() * DRAPE_EDGE_FLOATS);
        append(all, m_packing.faceIds(), m_layout.m_faceOwners.size());
        append(all, m_packing.vertexIds(), m_layout.m_vertexOwners.size());
        append(all, m_packing.edgeIds(), m_layout.m_edgeOwners.size());
        return all;
    }

private:
    template <typename T>
    void append(std::vector<std::uint32_t>& all, const ArenaArray<T>& array, std::size_t count)
    {
        const std::vector<T> values = contents(m_device, array, count);
        const std::size_t before = all.size();
        all.resize(before + count);
        std::memcpy(all.data() + before, values.data(), count * sizeof(T));
    }

    Device& m_device;
    PatchPacking m_packing;
    Patches m_layout;
};

// Obstacles that come behind others and go again leave the packed features of all that are there.
TEST_P(PatchCullTest, ObstaclesThatComeLaterArePackedAsIfAllCameAtOnce)
{
    const TriangleMesh sphere = makeSphere(1.0f, 3), box = makeBox(1.0f, 0.5f, 0.7f), none;
    const TriangleMesh soup = makeSoup(1.0f, 0.2f, 519, 381), terrain = shapeNamed("terrain");
    struct Scene
    {
        std::vector<TriangleMesh> m_meshes;
        std::size_t m_firstSlot;  // first new slot
    };
    const Scene scenes[] = {{{sphere}, 0},
                            {{sphere, box}, 1},
                            {{sphere, box, terrain, none}, 2},
                            {{sphere, box, soup}, 2},
                            {{sphere, none}, 1},
                            {{sphere, soup, terrain, sphere}, 1},
                            {{none, soup}, 0}};
    PackedObstacles kept(*m_device);
    for (const Scene& scene : scenes)
    {
        SCOPED_TRACE(std::to_string(&scene - scenes) + ", seed 381");
        PackedObstacles anew(*m_device);
        kept.pack(scene.m_meshes, scene.m_firstSlot);
        anew.pack(scene.m_meshes, 0);
        EXPECT_TRUE(kept.bytes() == anew.bytes());
    }
    EXPECT_FALSE(m_device->failed()) << m_device->error().text();
}

INSTANTIATE_TEST_SUITE_P(Devices, PatchCullTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
