// Trees of every builder: valid, and the same bits on the host and on devices, in every shape of the work.
#include "study/trees/tree_builder.h"

#include <gtest/gtest.h>

#include <cmath>

#include <algorithm>
#include <iterator>
#include <limits>

#include "study/trees/tree_quality.h"
#include "scenes/models.h"
#include "scenes/shapes.h"
#include "study/kernel_programs.h"
#include "tests/support/cases.h"
#include "tests/support/device_side.h"
#include "tests/support/published_data.h"

namespace drape::test
{
namespace
{
// Around the work-groups of 64, 128 and 256, the windows of 64, 96 and 2,048 leaves, subtrees of 32, and the sort's
// tile of 2,048.
const int kSizes[] = {1,   2,   3,   31,  32,  33,  63,  64,   65,   95,   96,   97,   127,
                      128, 129, 191, 192, 193, 255, 257, 2047, 2048, 2049, 4096, 4097, 20011};

const TreeBuilder kBuilders[] = {TreeBuilder::Balanced, TreeBuilder::Radix, TreeBuilder::TopDown, TreeBuilder::Ploc};

struct NamedMethods
{
    std::string m_name;
    TreeMethods m_methods;
};

TreeMethods methodsOf(TreeBuilder builder, WorkShape shape)
{
    TreeMethods methods;
    methods.m_builder = builder;
    methods.m_workShape = shape;
    return methods;
}

std::vector<NamedMethods> allMethods()
{
    std::vector<NamedMethods> all;
    for (WorkShape shape : {WorkShape::Serial, WorkShape::Groups})
    {
        const std::string suffix = shape == WorkShape::Serial ? ", serial" : ", groups";
        all.push_back({"balanced" + suffix, methodsOf(TreeBuilder::Balanced, shape)});
        all.push_back({"radix, 30 bits" + suffix, methodsOf(TreeBuilder::Radix, shape)});
        all.push_back({"radix, 63 bits" + suffix, methodsOf(TreeBuilder::Radix, shape)});
        all.back().m_methods.m_mortonBits = 63;
        all.push_back({"ploc" + suffix, methodsOf(TreeBuilder::Ploc, shape)});
        all.push_back({"ploc, 63 bits, radius 3" + suffix, methodsOf(TreeBuilder::Ploc, shape)});
        all.back().m_methods.m_mortonBits = 63;
        all.back().m_methods.m_plocRadius = 3;
    }
    for (bool adaptive : {false, true})
    {
        for (bool small : {false, true})
        {
            for (bool large : {false, true})
            {
                TreeMethods methods = methodsOf(TreeBuilder::TopDown, WorkShape::Device);
                methods.m_topDown.m_adaptiveGroups = adaptive;
                methods.m_topDown.m_smallSplits = small;
                methods.m_topDown.m_largeNodes = large;
                methods.m_topDown.m_largeSize = 3000;  // so that the tests' meshes have large nodes
                all.push_back({"top-down, adaptive " + std::to_string(adaptive) + ", small " + std::to_string(small) +
                                   ", large " + std::to_string(large),
                               methods});
            }
        }
    }
    TreeMethods methods = methodsOf(TreeBuilder::TopDown, WorkShape::Device);
    methods.m_topDown.m_medianSplit = true;
    methods.m_topDown.m_smallShare = 2.0f;  // small nodes are always put aside
    methods.m_topDown.m_groupSize = 256;
    methods.m_topDown.m_largeSize = 3000;
    all.push_back({"top-down, median", methods});
    methods.m_topDown.m_leafSize = 7;
    methods.m_topDown.m_groupSize = 32;
    methods.m_topDown.m_compactionGroup = 64;
    all.push_back({"top-down, median, leaves of 7", methods});
    methods.m_topDown.m_largeNodes = false;
    all.push_back({"top-down, median, no large nodes", methods});
    return all;
}

Side sideOf(const TriangleMesh& mesh)
{
    return makeSide({mesh});
}

std::vector<NamedMesh> meshes()
{
    std::vector<NamedMesh> all;
    for (int size : kSizes)
        all.emplace_back("soup of " + std::to_string(size), makeSoup(1.0f, 0.1f, size, std::uint32_t(size)));
    for (const NamedMesh& mesh : degenerateMeshes(5000))
        all.push_back(mesh);
    all.emplace_back("sphere", makeSphere(0.5f, 4));
    all.emplace_back("terrain", makeTerrain(3.0f, 0.4f, 80, 5));
    return all;
}

std::string whyInvalid(const Tree& tree, const Side& side)
{
    return drape::whyInvalid(tree.m_nodes, 0, tree.m_order, side.m_pool.triangles(), side.m_start.data(), {0.0f});
}
}  // namespace

class TreeTest : public BackendTest
{
protected:
    void expectSameAsHost(Device& device, TreeBuilderStage& stage, const TreeMethods& methods, const Side& side)
    {
        DeviceSide buffers;
        buffers.upload(device, side);
        DeviceTree tree;
        const Tree host =
            buildTreeOnHost(methods, side.m_pool.triangles(), side.m_start.data(), side.m_pool.meshCount());
        EXPECT_EQ(whyInvalid(host, side), "");
        tree.m_leafCount = host.leafCount();
        guard(device, tree.m_nodes, host.m_nodes.size());
        guard(device, tree.m_splits, host.leafCount());
        guard(device, tree.m_order, host.leafCount());
        stage.enqueue(device, buffers.m_triangles, buffers.m_start, host.leafCount(), side.m_pool.meshCount(), tree);
        const Tree built = tree.download(device);
        EXPECT_TRUE(built.m_order == host.m_order);
        EXPECT_TRUE(built.m_splits == host.m_splits);
        EXPECT_TRUE(sameBytes(built.m_nodes, host.m_nodes));
        EXPECT_TRUE(intact(device, tree.m_nodes) && buffers.allIntact(device));
        ASSERT_FALSE(device.failed()) << device.error().text();
    }

    // By every method and in every shape of the work.
    void expectRefits(Device& device, TreeRefitStage& stage, const Tree& built, const Side& side)
    {
        const std::vector<float> radius = {0.05f};
        Tree expected = built, spoilt = built;
        std::size_t invalid = 0;
        refitTreeOnHost(expected, side.m_pool.triangles(), side.m_start.data(), side.m_end.data(), radius, invalid);
        for (BvhNode& node : spoilt.m_nodes)
        {
            std::fill(std::begin(node.m_low), std::end(node.m_low), 7.0f);
            std::fill(std::begin(node.m_high), std::end(node.m_high), -7.0f);
        }
        DeviceSide buffers;
        buffers.upload(device, side);
        Buffer<float> onDevice;
        guardCopy(device, onDevice, radius);
        for (const auto& [method, shape] : {std::pair<RefitMethod, WorkShape>(RefitMethod::Levels, WorkShape::Device),
                                            {RefitMethod::Subtrees, WorkShape::Serial},
                                            {RefitMethod::Subtrees, WorkShape::Groups}})
        {
            SCOPED_TRACE("method " + std::to_string(std::size_t(method)) + ", shape " +
                         std::to_string(std::size_t(shape)));
            TreeMethods methods;
            methods.m_refit = method;
            methods.m_workShape = shape;
            DeviceTree tree;
            guard(device, tree.m_nodes, built.m_nodes.size());
            tree.upload(device, spoilt);
            Buffer<StepCounters> counters;
            clearCounters(device, counters);
            stage.prepare(device, tree, methods);
            stage.enqueue(device, tree, {buffers.m_triangles, buffers.m_start, buffers.m_end, onDevice, counters},
                          methods);
            const Tree refitted = tree.download(device);
            EXPECT_TRUE(sameBytes(refitted.m_nodes, expected.m_nodes));
            EXPECT_EQ(readCounters(device, counters).m_invalidNodes, invalid);
            EXPECT_TRUE(intact(device, tree.m_nodes) && buffers.allIntact(device) && intact(device, counters));
            ASSERT_FALSE(device.failed()) << device.error().text();
        }
    }
};

// A step's start and end, both elsewhere than where the tree was built, and some vertices that are nowhere.
void move(Side& side, bool spoil)
{
    const std::vector<float> built = side.m_start;
    for (std::size_t i = 0; i < built.size(); ++i)
    {
        side.m_start[i] = built[i] + 0.3f * built[i - i % 3 + (i + 1) % 3];
        side.m_end[i] = side.m_start[i] - 0.2f * built[i - i % 3 + (i + 2) % 3] + 0.01f;
    }
    for (std::size_t i = 3; spoil && i < built.size(); i += 300)
        side.m_end[i] = std::numeric_limits<float>::quiet_NaN();
}

// Refits of one tree, whose volumes are first made such that none is right by chance.
TEST_P(TreeTest, EveryRefitMakesTheHostsVolumesOfMovedTriangles)
{
    const std::unique_ptr<Device> device = openDevice(GetParam());
    ASSERT_TRUE(device);
    TreeRefitStage stage, crowded;
    stage.create(*device, studyPrograms(*device));
    // Its groups have more splits than they merge in order.
    crowded.create(*device, studyPrograms(*device, "", "#define DRAPE_MERGED 4\n"));
    const std::vector<NamedMesh> cases = meshes();
    for (const TreeBuilder builder : kBuilders)
    {
        for (const auto& [name, mesh] : cases)
        {
            SCOPED_TRACE(name + ", builder " + std::to_string(std::size_t(builder)));
            Side side = sideOf(mesh);
            const Tree built = buildTreeOnHost(methodsOf(builder, WorkShape::Device), side.m_pool.triangles(),
                                               side.m_start.data(), side.m_pool.meshCount());
            move(side, false);
            Tree atRest = built;
            std::size_t invalid = 0;
            refitTreeOnHost(atRest, side.m_pool.triangles(), side.m_start.data(), side.m_start.data(), {0.0f}, invalid);
            EXPECT_EQ(whyInvalid(atRest, side), "");
            EXPECT_FALSE(sameBytes(atRest.m_nodes, built.m_nodes)) << "nothing moved";
            expectRefits(*device, stage, built, side);
            expectRefits(*device, crowded, built, side);
            move(side, true);
            expectRefits(*device, stage, built, side);
            if (HasFailure()) return;
        }
    }
}

TEST_P(TreeTest, EveryBuilderMakesTheHostsValidTree)
{
    const std::unique_ptr<Device> device = openDevice(GetParam());
    ASSERT_TRUE(device);
    const std::vector<NamedMesh> cases = meshes();
    for (const NamedMethods& named : allMethods())
    {
        TreeBuilderStage stage;
        stage.create(*device, studyPrograms(*device), named.m_methods);
        for (const auto& [name, mesh] : cases)
        {
            SCOPED_TRACE(named.m_name + ": " + name);
            expectSameAsHost(*device, stage, named.m_methods, sideOf(mesh));
            if (HasFailure()) return;  // later ones would say the same at length
        }
    }
}

// Returns the methods that the study's models show beside the builders' defaults: the thesis's construction without any
// optimisation, its split at the median, and codes of 63 bits, which tell triangles apart that are one to 30.
std::vector<NamedMethods> otherMethodsOfModels()
{
    std::vector<NamedMethods> all(4, {"top-down, normal", methodsOf(TreeBuilder::TopDown, WorkShape::Device)});
    TopDownSettings& normal = all[0].m_methods.m_topDown;
    normal.m_adaptiveGroups = normal.m_smallSplits = normal.m_largeNodes = false;
    all[1].m_name = "top-down, median";
    all[1].m_methods.m_topDown.m_medianSplit = true;
    all[2] = {"radix, 63 bits", methodsOf(TreeBuilder::Radix, WorkShape::Device)};
    all[3] = {"balanced, 63 bits", methodsOf(TreeBuilder::Balanced, WorkShape::Device)};
    all[2].m_methods.m_mortonBits = all[3].m_methods.m_mortonBits = 63;
    return all;
}

// Takes only models up to the bunny, to save time.
TEST_P(TreeTest, OtherMethodsMakeTheHostsValidTreeOfModels)
{
    const std::unique_ptr<Device> device = openDevice(GetParam());
    ASSERT_TRUE(device);
    const std::vector<NamedMethods> all = otherMethodsOfModels();
    std::vector<TreeBuilderStage> stages(all.size());
    for (std::size_t i = 0; i < all.size(); ++i)
        stages[i].create(*device, studyPrograms(*device), all[i].m_methods);
    std::size_t models = 0;
    for (const char* model : {"spot", "terrain_6272", "torus_16301", "bunny"})
    {
        TriangleMesh mesh;
        if (!loadStudyModel(model, mesh)) continue;
        const Side side = sideOf(mesh);
        for (std::size_t i = 0; i < all.size(); ++i)
        {
            SCOPED_TRACE(all[i].m_name + ": " + model);
            expectSameAsHost(*device, stages[i], all[i].m_methods, side);
            if (HasFailure()) return;
        }
        ++models;
    }
    EXPECT_GE(models, 2u);
}

// The study's models: those that are made, and the scans whose files are there, up to 1.1 million triangles.
TEST_P(TreeTest, EveryBuilderMakesTheHostsValidTreeOfModels)
{
    const std::unique_ptr<Device> device = openDevice(GetParam());
    ASSERT_TRUE(device);
    std::vector<TreeBuilderStage> stages(std::size(kBuilders));
    for (std::size_t builder = 0; builder < stages.size(); ++builder)
        stages[builder].create(*device, studyPrograms(*device), methodsOf(kBuilders[builder], WorkShape::Device));
    std::size_t models = 0;
    for (const std::string& model : studyModelNames())
    {
        TriangleMesh mesh;
        if (!loadStudyModel(model, mesh)) continue;
        const Side side = sideOf(mesh);
        for (std::size_t builder = 0; builder < stages.size(); ++builder)
        {
            SCOPED_TRACE(model + ", builder " + std::to_string(builder));
            expectSameAsHost(*device, stages[builder], methodsOf(kBuilders[builder], WorkShape::Device), side);
            if (HasFailure()) return;
        }
        ++models;
    }
    EXPECT_GE(models, 3u);
}

namespace
{
// Trees of every builder hold the triangles in a height near the least there can be.
void expectShallowTrees(const TriangleMesh& mesh)
{
    const Side side = makeSide({mesh});
    const std::size_t leaves = side.m_pool.triangles().size();
    const std::uint32_t least = std::uint32_t(std::ceil(std::log2(double(leaves))));
    for (const TreeBuilder builder :
         {TreeBuilder::Balanced, TreeBuilder::Radix, TreeBuilder::TopDown, TreeBuilder::Ploc})
    {
        TreeMethods methods;
        methods.m_builder = builder;
        const Tree tree = buildTreeOnHost(methods, side.m_pool.triangles(), side.m_start.data(), 1);
        ASSERT_EQ(tree.leafCount(), leaves);
        const std::uint32_t height = measureTree(tree.m_nodes, 0).m_height;
        EXPECT_GE(height, least);
        EXPECT_LE(height, 2 * least) << "builder " << int(builder);
        EXPECT_EQ(whyInvalid(tree.m_nodes, 0, tree.m_order, side.m_pool.triangles(), side.m_start.data(), {0.0f}), "");
    }
}
}  // namespace

TEST(ShallowTrees, OfClothsCollapsedToAPointOrALine)
{
    for (const bool line : {false, true})
    {
        StepCase step = fallingCase("sphere", 12, 0.03f, 904);
        SCOPED_TRACE(step.trace());
        for (std::size_t node = 0; node < step.m_cloth.vertexCount(); ++node)
        {
            float* p = &step.m_cloth.m_positions[3 * node];
            p[0] = line ? 0.001f * float(node) : 0.0f;
            p[1] = 0.55f;
            p[2] = 0.0f;
        }
        expectShallowTrees(step.m_cloth);
    }
}

INSTANTIATE_TEST_SUITE_P(Devices, TreeTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
