// The records of kernels/shared have the same size and offsets on the device as on the host.
#include <gtest/gtest.h>

#include <cstddef>

#include "bullet_plugin/core/device/program.h"
#include "kernels/narrow_phase/narrow_phase_bindings.h"
#include "kernels/shared/contact.h"
#include "kernels/shared/motion.h"
#include "kernels/shared/patch.h"
#include "tests/support/backends.h"
#include "tests/support/canary.h"

namespace drape::test
{
namespace
{
struct Field
{
    std::string m_expression;  // in OpenCL C
    std::size_t m_value;       // on the host
};

#define DRAPE_TEST_SIZE(type)             \
    Field                                 \
    {                                     \
        "sizeof(" #type ")", sizeof(type) \
    }
// OpenCL C has no offsetof; the difference of addresses in a real object gives it.
#define DRAPE_TEST_OFFSET(type, field)                                                                  \
    Field                                                                                               \
    {                                                                                                   \
        "(uint)((const char*)&a" #type "." #field " - (const char*)&a" #type ")", offsetof(type, field) \
    }

std::vector<Field> meshFields()
{
    return {DRAPE_TEST_SIZE(Vec3),
            DRAPE_TEST_SIZE(Triangle),
            DRAPE_TEST_SIZE(Edge),
            DRAPE_TEST_SIZE(NormalCone),
            DRAPE_TEST_SIZE(Patch),
            DRAPE_TEST_SIZE(ObstaclePlace),
            DRAPE_TEST_SIZE(ObstacleMotion),
            DRAPE_TEST_OFFSET(Vec3, z),
            DRAPE_TEST_OFFSET(Triangle, m_vertices),
            DRAPE_TEST_OFFSET(Triangle, m_edges),
            DRAPE_TEST_OFFSET(Triangle, m_owned),
            DRAPE_TEST_OFFSET(Triangle, m_mesh),
            DRAPE_TEST_OFFSET(Edge, m_vertices),
            DRAPE_TEST_OFFSET(Edge, m_opposite),
            DRAPE_TEST_OFFSET(NormalCone, m_axis),
            DRAPE_TEST_OFFSET(NormalCone, m_cosine),
            DRAPE_TEST_OFFSET(Patch, m_edgeBlocks),
            DRAPE_TEST_OFFSET(Patch, m_mesh),
            DRAPE_TEST_OFFSET(ObstaclePlace, m_posed),
            DRAPE_TEST_OFFSET(ObstaclePlace, m_firstVertex),
            DRAPE_TEST_OFFSET(ObstaclePlace, m_firstEdge),
            DRAPE_TEST_OFFSET(ObstacleMotion, m_low),
            DRAPE_TEST_OFFSET(ObstacleMotion, m_mesh)};
}

std::vector<Field> treeFields()
{
    return {DRAPE_TEST_SIZE(BvhNode), DRAPE_TEST_OFFSET(BvhNode, m_low), DRAPE_TEST_OFFSET(BvhNode, m_high),
            DRAPE_TEST_OFFSET(BvhNode, m_first), DRAPE_TEST_OFFSET(BvhNode, m_count)};
}

std::vector<Field> stepFields()
{
    return {DRAPE_TEST_SIZE(Candidate),
            DRAPE_TEST_SIZE(StepCounters),
            DRAPE_TEST_SIZE(Contact),
            DRAPE_TEST_SIZE(FeatureTest),
            DRAPE_TEST_OFFSET(Candidate, m_cloth),
            DRAPE_TEST_OFFSET(Candidate, m_obstacle),
            DRAPE_TEST_OFFSET(StepCounters, m_candidates),
            DRAPE_TEST_OFFSET(StepCounters, m_contactsFound),
            DRAPE_TEST_OFFSET(StepCounters, m_crowded),
            DRAPE_TEST_OFFSET(StepCounters, m_contactsStored),
            DRAPE_TEST_OFFSET(StepCounters, m_invalidNodes),
            DRAPE_TEST_OFFSET(StepCounters, m_swept),
            DRAPE_TEST_OFFSET(StepCounters, m_patchPairs),
            DRAPE_TEST_OFFSET(StepCounters, m_selfPairs),
            DRAPE_TEST_OFFSET(StepCounters, m_selfTests),
            DRAPE_TEST_OFFSET(StepCounters, m_selfSwept),
            DRAPE_TEST_OFFSET(Contact, m_featureIndex),
            DRAPE_TEST_OFFSET(Contact, m_kind),
            DRAPE_TEST_OFFSET(Contact, m_clothFeature),
            DRAPE_TEST_OFFSET(Contact, m_obstacleFeature),
            DRAPE_TEST_OFFSET(Contact, m_normal),
            DRAPE_TEST_OFFSET(Contact, m_gap1),
            DRAPE_TEST_OFFSET(Contact, m_point),
            DRAPE_TEST_OFFSET(Contact, m_gap0),
            DRAPE_TEST_OFFSET(Contact, m_weights),
            DRAPE_TEST_OFFSET(Contact, m_time),
            DRAPE_TEST_OFFSET(FeatureTest, m_lane),
            DRAPE_TEST_OFFSET(FeatureTest, m_reach),
            DRAPE_TEST_OFFSET(FeatureTest, m_motion)};
}

// Records that kernels take by value.
std::vector<Field> valueFields()
{
    return {DRAPE_TEST_SIZE(ClothLayout),
            DRAPE_TEST_SIZE(ObstacleLayout),
            DRAPE_TEST_SIZE(PatchLayout),
            DRAPE_TEST_SIZE(SelfPatchLayout),
            DRAPE_TEST_SIZE(FeatureValues),
            DRAPE_TEST_OFFSET(FeatureValues, m_obstacle),
            DRAPE_TEST_OFFSET(FeatureValues, m_patches),
            DRAPE_TEST_OFFSET(FeatureValues, m_sums)};
}

std::vector<Field> fields()
{
    std::vector<Field> all = meshFields();
    for (const std::vector<Field>& more : {treeFields(), stepFields(), valueFields()})
        all.insert(all.end(), more.begin(), more.end());
    return all;
}
}  // namespace

class RecordsTest : public BackendTest
{
};

TEST_P(RecordsTest, DeviceAndHostAgree)
{
    const std::unique_ptr<Device> device = openDevice(GetParam());
    ASSERT_TRUE(device);
    // Embedded files bring the shared headers; the test's kernel follows them.
    std::string source = assembleSource("kernels/narrow_phase/narrow_phase.cl");
    source += "\n__kernel void reportRecords(__global uint* values)\n{\n";
    for (const char* type : {"Vec3", "Triangle", "Edge", "NormalCone", "BvhNode", "Candidate", "StepCounters",
                             "Contact", "Patch", "FeatureTest", "ObstaclePlace", "ObstacleMotion", "FeatureValues"})
    {
        source += std::string("    ") + type + " a" + type + ";\n";
    }
    const std::vector<Field> expected = fields();
    for (std::size_t i = 0; i < expected.size(); ++i)
    {
        source += "    values[" + std::to_string(i) + "] = " + expected[i].m_expression + ";\n";
    }
    source += "}\n";
    const cl::Program program = compileSource(*device, "records", source);
    Kernel kernel;
    kernel.create(*device, program, "reportRecords");
    Buffer<cl_uint> values;
    guard(*device, values, expected.size());
    kernel.launch(*device, 1, 1, values.handle());
    const std::vector<cl_uint> found = contents(*device, values, expected.size());
    ASSERT_FALSE(device->failed()) << device->error().text();
    EXPECT_TRUE(intact(*device, values));
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_EQ(found[i], expected[i].m_value) << expected[i].m_expression;
}

INSTANTIATE_TEST_SUITE_P(Devices, RecordsTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
