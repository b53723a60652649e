// Feature tests that a cull lists: their input data, and how to run one. For kernels only.
#ifndef DRAPE_LIB_FEATURE_TESTS_H
#define DRAPE_LIB_FEATURE_TESTS_H

#include "list_contacts.h"
#include "pair_contact.h"

// Loads the position and cone of a lane of a vertex or edge block.
static Vec3 laneVec3(__global const float* restrict blocks, const uint floats, const uint lane, const uint first)
{
    __global const float* p =
        blocks + ((lane / DRAPE_PATCH_WIDTH) * floats + first) * DRAPE_PATCH_WIDTH + lane % DRAPE_PATCH_WIDTH;
    return vec3(p[0], p[DRAPE_PATCH_WIDTH], p[2 * DRAPE_PATCH_WIDTH]);
}

static NormalCone laneCone(__global const float* restrict blocks, const uint floats, const uint lane)
{
    NormalCone cone;
    cone.m_axis = laneVec3(blocks, floats, lane, floats - 4);
    cone.m_cosine =
        blocks[((lane / DRAPE_PATCH_WIDTH) * floats + floats - 1) * DRAPE_PATCH_WIDTH + lane % DRAPE_PATCH_WIDTH];
    return cone;
}

// Returns the motion of a test's obstacle; null if it rests.
static __global const ObstacleMotion* motionOfTest(__global const ObstacleMotion* motions, const FeatureTest test)
{
    return test.m_motion == 0 ? 0 : motions + (test.m_motion - 1);
}

static int featureContact(const FeatureTest feature, const ClothView* cloth, const ObstacleView* obstacle,
                          const PackedPatches* packed, Contact* contact)
{
    const uint test = feature.m_cloth >> DRAPE_TEST_SHIFT, lane = feature.m_lane;
    const uint triangle = feature.m_cloth & ((1u << DRAPE_TEST_SHIFT) - 1u);
    if (test < DRAPE_TEST_FACE)
    {
        __global const float* faces = packed->m_faces;
        return pairNodeFace(test, cloth, triangle, laneVec3(faces, DRAPE_FACE_FLOATS, lane, 0),
                            laneVec3(faces, DRAPE_FACE_FLOATS, lane, 3), laneVec3(faces, DRAPE_FACE_FLOATS, lane, 6),
                            obstacle, packed->m_faceIds[lane], feature.m_reach, contact);
    }
    if (test == DRAPE_TEST_FACE)
    {
        __global const float* vertices = packed->m_vertices;
        return pairFaceVertex(cloth, triangle, laneVec3(vertices, DRAPE_VERTEX_FLOATS, lane, 0),
                              laneCone(vertices, DRAPE_VERTEX_FLOATS, lane), packed->m_vertexIds[lane], feature.m_reach,
                              contact);
    }
    __global const float* edges = packed->m_edges;
    return pairEdgeEdge(test - DRAPE_TEST_EDGE, cloth, triangle, laneVec3(edges, DRAPE_EDGE_FLOATS, lane, 0),
                        laneVec3(edges, DRAPE_EDGE_FLOATS, lane, 3), laneCone(edges, DRAPE_EDGE_FLOATS, lane),
                        packed->m_edgeIds[lane], feature.m_reach, contact);
}

#define DRAPE_TEST_KINDS 3
static uint kindOfTest(const FeatureTest feature)
{
    const uint test = feature.m_cloth >> DRAPE_TEST_SHIFT;
    return test < DRAPE_TEST_FACE ? 0 : test == DRAPE_TEST_FACE ? 1 : 2;
}

// Tests the item-th feature pair. Lists its contact, or the test in `swept` if only the continuous test can decide.
static void testFeature(__global const FeatureTest* tests, const uint item, ClothView* cloth,
                        const ObstacleView* obstacle, const PackedPatches* packed,
                        __global const ObstacleMotion* motions, const ContactSink* sink, __global uint* swept,
                        __global StepCounters* counters)
{
    const FeatureTest test = tests[item];
    cloth->m_motion = motionOfTest(motions, test);
    Contact contact;
    const int found = featureContact(test, cloth, obstacle, packed, &contact);
    if (found == DRAPE_IS_CONTACT)
        listContact(sink, &contact);
    else if (found == DRAPE_UNDECIDED)
        swept[atomic_inc(&counters->m_swept)] = item;
}

#endif
