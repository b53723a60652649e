// The records of kernels/shared have the same size and offsets on the device as on the host.
#include <gtest/gtest.h>

#include <cstddef>
#include <set>

#include "bullet_plugin/core/device/program.h"
#include "kernels/broad_phase/broad_phase_bindings.h"
#include "kernels/cloth_cloth/cloth_cloth_bindings.h"
#include "kernels/narrow_phase/narrow_phase_bindings.h"
#include "kernels/ordering/ordering_bindings.h"
#include "kernels/queries/queries_bindings.h"
#include "kernels/scene/scene_bindings.h"
#include "kernels/solver/solver_bindings.h"
#include "tests/support/backends.h"
#include "tests/support/canary.h"

namespace drape::test
{
namespace
{
// The files that declare the records.
const std::vector<std::string> kFiles = {"kernels/broad_phase/broad_phase_bindings.h",
                                         "kernels/cloth_cloth/cloth_cloth_bindings.h",
                                         "kernels/narrow_phase/narrow_phase_bindings.h",
                                         "kernels/ordering/ordering_bindings.h",
                                         "kernels/queries/queries_bindings.h",
                                         "kernels/scene/scene_bindings.h",
                                         "kernels/solver/solver_bindings.h"};

struct Field
{
    std::string m_type;
    std::string m_expression;  // in OpenCL C
    std::size_t m_value;       // on the host
};

#define DRAPE_TEST_SIZE(type)                    \
    Field                                        \
    {                                            \
#type, "sizeof(" #type ")", sizeof(type) \
    }
// OpenCL C has no offsetof; the difference of addresses in a real object gives it.
#define DRAPE_TEST_OFFSET(type, field)                                                                         \
    Field                                                                                                      \
    {                                                                                                          \
#type, "(uint)((const char*)&a" #type "." #field " - (const char*)&a" #type ")", offsetof(type, field) \
    }
// Compares a record's size and its last field: padding before the field moves it, padding behind it adds to the size.
#define DRAPE_TEST_RECORD(type, lastField) DRAPE_TEST_SIZE(type), DRAPE_TEST_OFFSET(type, lastField)

std::vector<Field> meshFields()
{
    return {DRAPE_TEST_SIZE(Vec3),
            DRAPE_TEST_SIZE(Triangle),
            DRAPE_TEST_SIZE(Edge),
            DRAPE_TEST_RECORD(MeshOffsets, m_edge),
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
    return {DRAPE_TEST_RECORD(ClothLayout, m_edgeCount),
            DRAPE_TEST_RECORD(ObstacleLayout, m_triangles),
            DRAPE_TEST_RECORD(PatchLayout, m_faceFeatures),
            DRAPE_TEST_RECORD(SelfPatchLayout, m_wideNodes),
            DRAPE_TEST_RECORD(CullValues, m_packet),
            DRAPE_TEST_RECORD(SelfCullValues, m_limit),
            DRAPE_TEST_RECORD(SelfFeatureValues, m_sums),
            DRAPE_TEST_SIZE(FeatureValues),
            DRAPE_TEST_OFFSET(FeatureValues, m_obstacle),
            DRAPE_TEST_OFFSET(FeatureValues, m_patches),
            DRAPE_TEST_OFFSET(FeatureValues, m_sums),
            DRAPE_TEST_RECORD(OrderingValues, m_parts),
            DRAPE_TEST_RECORD(MotionValues, m_count),
            DRAPE_TEST_RECORD(PairQueryValues, m_capacity),
            DRAPE_TEST_RECORD(TraverseValues, m_enough),
            DRAPE_TEST_RECORD(SelfFeaturesValues, m_edgeCapacity),
            DRAPE_TEST_RECORD(SelfTestValues, m_hitCapacity),
            DRAPE_TEST_RECORD(VolumeValues, m_radius),
            DRAPE_TEST_RECORD(NodeRange, m_count),
            DRAPE_TEST_RECORD(PackValues, m_count),
            DRAPE_TEST_RECORD(WidenValues, m_last),
            DRAPE_TEST_RECORD(PlaceValues, m_edgeCount)};
}

std::vector<Field> queryFields()
{
    return {DRAPE_TEST_RECORD(CcdQuery, m_kind),   DRAPE_TEST_RECORD(CcdSettings, m_boxLimit),
            DRAPE_TEST_RECORD(CcdResult, m_boxes), DRAPE_TEST_RECORD(TriangleQuery, m_b),
            DRAPE_TEST_RECORD(FeaturePair, m_b),   DRAPE_TEST_RECORD(FeatureHit, m_time),
            DRAPE_TEST_RECORD(PairAnswer, m_bits), DRAPE_TEST_RECORD(SelfCounters, m_tooDeep)};
}

std::vector<Field> solverFields()
{
    return {DRAPE_TEST_RECORD(SolverNode, m_inverseMass),
            DRAPE_TEST_RECORD(NodePath, m_freeMass),
            DRAPE_TEST_RECORD(NodeState, m_isFar),
            DRAPE_TEST_OFFSET(ContactRow, m_multiplier),
            DRAPE_TEST_OFFSET(ContactRow, m_inverseMobility),
            DRAPE_TEST_RECORD(ContactRow, m_mended),
            DRAPE_TEST_OFFSET(ActingContact, m_distance),
            DRAPE_TEST_RECORD(ActingContact, m_unused),
            DRAPE_TEST_RECORD(KeptNode, m_unused),
            DRAPE_TEST_OFFSET(KeptNode, m_velocity),
            DRAPE_TEST_RECORD(KeptCloth, m_mostOffPath),
            DRAPE_TEST_RECORD(KeptLaunch, m_lanes),
            DRAPE_TEST_RECORD(KeptBounds, m_isOffPath)};
}

std::vector<Field> solveStepFields()
{
    return {DRAPE_TEST_RECORD(SolveRange, m_count),         DRAPE_TEST_RECORD(SolveCloth, m_leastTolerance),
            DRAPE_TEST_RECORD(SolveGroup, m_edgeBuckets),   DRAPE_TEST_RECORD(SolveBatch, m_serial),
            DRAPE_TEST_RECORD(SolveFeature, m_nodes),       DRAPE_TEST_RECORD(SolveBucket, m_pushed),
            DRAPE_TEST_RECORD(SolveLink, m_strength),       DRAPE_TEST_RECORD(SolveSurface, m_obstacle),
            DRAPE_TEST_RECORD(SolveSpan, m_restSquared),    DRAPE_TEST_OFFSET(SolveContact, m_weights),
            DRAPE_TEST_OFFSET(SolveContact, m_nodes),       DRAPE_TEST_RECORD(SolveContact, m_rank),
            DRAPE_TEST_RECORD(SolveRegion, m_moves),        DRAPE_TEST_RECORD(SolveAllowance, m_isNear),
            DRAPE_TEST_RECORD(SolveProgress, m_worst),      DRAPE_TEST_RECORD(SolveResult, m_meets),
            DRAPE_TEST_RECORD(SolveLayout, m_bucketCloths), DRAPE_TEST_RECORD(SolvePass, m_round)};
}

std::vector<Field> rigidFields()
{
    return {DRAPE_TEST_OFFSET(RigidBody, m_moves),     DRAPE_TEST_RECORD(RigidBody, m_turning),
            DRAPE_TEST_RECORD(RigidPlane, m_friction), DRAPE_TEST_RECORD(RigidContact, m_plane),
            DRAPE_TEST_RECORD(RigidAnchor, m_share),   DRAPE_TEST_RECORD(RigidRowState, m_multiplier),
            DRAPE_TEST_RECORD(RigidGiven, m_turning),  DRAPE_TEST_RECORD(RigidRun, m_lastContact),
            DRAPE_TEST_RECORD(RigidChain, m_last),     DRAPE_TEST_RECORD(RigidLayout, m_given)};
}

std::vector<Field> fields()
{
    std::vector<Field> all = meshFields();
    for (const std::vector<Field>& more :
         {treeFields(), stepFields(), valueFields(), queryFields(), solverFields(), solveStepFields(), rigidFields()})
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
    std::string source = assembleSources(kFiles);
    ASSERT_FALSE(source.empty());
    source += "\n__kernel void reportRecords(__global uint* values)\n{\n";
    const std::vector<Field> expected = fields();
    std::set<std::string> types;
    for (std::size_t i = 0; i < expected.size(); ++i)
    {
        const std::string& type = expected[i].m_type;
        if (types.insert(type).second) source += "    " + type + " a" + type + ";\n";
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
