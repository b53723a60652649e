// A C99 program that uses all of drape/c_api.h. c_api_test.cpp runs it and checks its results.
#include "tests/cloth_world/flat_program.h"

#include "drape/version.h"

#include <math.h>
#include <string.h>

#define CHECK(condition)                     \
    do                                       \
    {                                        \
        if (!(condition)) return #condition; \
    } while (0)

static const float kGround[] = {0, 0, 0, 0, 0, 1, 1, 0, 0};
static const float kSpike[] = {0.2f, -1, 0.2f, 0.3f, 1, 0.2f, 0.2f, 1, 0.3f};
static const int32_t kTriangle[] = {0, 1, 2};

static DrapeMesh meshOf(const float* positions)
{
    DrapeMesh mesh = {0};
    mesh.m_positions = positions;
    mesh.m_vertexCount = 3;
    mesh.m_triangles = kTriangle;
    mesh.m_triangleCount = 1;
    return mesh;
}

static const char* askQueries(DrapeQueries* queries)
{
    const DrapeMesh ground = meshOf(kGround), spike = meshOf(kSpike);
    DrapeMeshPairs pairs;
    CHECK(drapeMeshPairs(queries, &ground, &spike, 0.001f, &pairs) == DRAPE_OK);
    CHECK(pairs.m_limits == DRAPE_QUERY_WHOLE && pairs.m_withinListed == 1 && pairs.m_intersectingListed == 1);
    CHECK(pairs.m_intersecting[0].m_a == 0 && pairs.m_intersecting[0].m_b == 0);

    // Two triangles of one mesh: the second goes through the first.
    float both[18], end[18];
    const int32_t triangles[] = {0, 1, 2, 3, 4, 5};
    memcpy(both, kGround, sizeof(kGround));
    memcpy(both + 9, kSpike, sizeof(kSpike));
    for (int i = 3; i < 6; ++i)
        both[3 * i + 1] += 2;
    memcpy(end, both, sizeof(both));
    for (int i = 3; i < 6; ++i)
        end[3 * i + 1] -= 4;
    DrapeMesh mesh = {0};
    mesh.m_positions = both;
    mesh.m_vertexCount = 6;
    mesh.m_triangles = triangles;
    mesh.m_triangleCount = 2;
    DrapeMeshMotion motion;
    CHECK(drapeMeshMotion(queries, &mesh, end, NULL, &motion) == DRAPE_OK);
    CHECK(motion.m_touchingListed > 0 && motion.m_vertexFaceHits + motion.m_edgeHits == motion.m_touchingListed);
    CHECK(drapeMeshPairs(queries, &mesh, NULL, 0, &pairs) == DRAPE_OK && pairs.m_intersectingCount == 0);

    TriangleQuery two;
    uint32_t meets = 7;
    memcpy(two.m_a, kGround, sizeof(kGround));
    memcpy(two.m_b, kSpike, sizeof(kSpike));
    CHECK(drapeTriangles(queries, &two, 1, DRAPE_TEST_EXACT, &meets) == DRAPE_OK && meets == 1);

    const CcdQuery question = {
        {0.2f, 1, 0.2f, 0, 0, 0, 0, 0, 1, 1, 0, 0}, {0.2f, -1, 0.2f, 0, 0, 0, 0, 0, 1, 1, 0, 0}, DRAPE_VERTEX_FACE};
    CcdSettings settings;
    CcdResult result;
    drapeDefaultCcdSettings(&settings);
    CHECK(drapeMotions(queries, &question, 1, &settings, &result) == DRAPE_OK && result.m_hit == 1);
    CHECK(result.m_time <= 0.5f && result.m_time > 0.49f);

    CHECK(drapeMeshPairs(queries, &mesh, NULL, -1, &pairs) == DRAPE_BAD_INPUT);
    CHECK(strstr(drapeErrorText(), "radius") != NULL);
    CHECK(drapeTriangles(queries, &two, 1, 5, &meets) == DRAPE_BAD_INPUT);
    CHECK(drapeMotions(queries, NULL, 1, NULL, &result) == DRAPE_BAD_INPUT);
    CHECK(drapeMeshMotion(queries, &mesh, NULL, NULL, &motion) == DRAPE_BAD_INPUT);
    DrapeDeviceReport device;
    CHECK(drapeQueriesDevice(queries, &device) == DRAPE_OK && device.m_onHost == 1);
    CHECK(strcmp(device.m_device.m_name, "host") == 0);
    return NULL;
}

static const char* stepWorld(DrapeWorld* world, int cloth, int obstacle)
{
    const double turned[4] = {0, 0.1, 0, 1}, position[3] = {0, 0, 0}, gravity[3] = {0, -5, 0};
    CHECK(drapeWorldSetGravity(world, gravity) == DRAPE_OK);
    for (int step = 0; step < 90; ++step)
        CHECK(drapeWorldStep(world, 1.0 / 60) == DRAPE_OK);
    const ClothContact* contacts = NULL;
    size_t count = 0;
    CHECK(drapeWorldContacts(world, &contacts, &count) == DRAPE_OK && count > 0);
    CHECK(contacts[0].m_cloth == cloth && contacts[0].m_obstacle == obstacle);
    DrapeStatistics statistics;
    CHECK(drapeWorldStatistics(world, &statistics) == DRAPE_OK && statistics.m_contacts == count);
    CHECK(statistics.m_status == DRAPE_STEP_GOOD && statistics.m_callsMs > 0);
    CHECK(strcmp(drapeStatusText(statistics.m_status), "") == 0);
    const ClothStepContact* records = NULL;
    CHECK(drapeWorldStepContacts(world, &records, &count) == DRAPE_OK && count == 0);
    CHECK(drapeWorldRecordContacts(world, 1) == DRAPE_OK && drapeWorldStep(world, 1.0 / 60) == DRAPE_OK);
    CHECK(drapeWorldStepContacts(world, &records, &count) == DRAPE_OK && count > 0);
    CHECK(records[0].m_cloth == cloth && records[0].m_obstacle == obstacle && records[0].m_other == -1);
    CHECK(records[0].m_triangle >= 0 && drapeWorldRecordContacts(world, 0) == DRAPE_OK);
    const ClothTriangles* meeting = NULL;
    CHECK(drapeWorldClothTriangles(world, &meeting, &count) == DRAPE_OK && count == 0);
    CHECK(drapeWorldSetPose(world, obstacle, position, turned, 0) == DRAPE_OK);
    CHECK(drapeWorldStep(world, 1.0 / 60) == DRAPE_OK);
    CHECK(strstr(drapeWorldReport(world), "Drape on host") != NULL);
    CHECK(strcmp(drapeWorldDiagnose(world), "") == 0 && strcmp(drapeWorldDeviceError(world), "") == 0);
    DrapeDeviceReport device;
    CHECK(drapeWorldAwaitDevice(world) == DRAPE_OK);
    CHECK(drapeWorldDevice(world, &device) == DRAPE_OK && device.m_onHost == 1 && device.m_isStarting == 0);
    return NULL;
}

static const char* useNodes(DrapeWorld* world, int cloth)
{
    NodeView view;
    CHECK(drapeWorldNodes(world, cloth, &view) == DRAPE_OK && view.m_count == 3);
    float positions[9], velocities[9], normals[9];
    CHECK(drapeWorldCopyNodes(world, cloth, positions, velocities, normals) == DRAPE_OK);
    if (view.m_scalarBytes == sizeof(float))
        for (size_t i = 0; i < view.m_count; ++i)
            CHECK(memcmp((const char*)view.m_positions + i * view.m_strideBytes, positions + 3 * i, 12) == 0);
    CHECK(fabsf(positions[1] - 0.02f) < 0.002f);
    const int32_t node = 1;
    const float place[3] = {0, 1, 0.5f};
    CHECK(drapeWorldSetVelocities(world, cloth, &node, 1, place) == DRAPE_OK);
    CHECK(drapeWorldSetPinned(world, cloth, &node, 1, 1) == DRAPE_OK);
    CHECK(drapeWorldSetVelocities(world, cloth, &node, 1, place) == DRAPE_BAD_INPUT);
    CHECK(drapeWorldSetPositions(world, cloth, &node, 1, place, 0) == DRAPE_OK);
    CHECK(drapeWorldCopyNodes(world, cloth, positions, NULL, NULL) == DRAPE_OK && positions[4] == 1);
    CHECK(drapeWorldNodes(world, 9, &view) == DRAPE_BAD_INPUT);
    CHECK(strcmp(drapeErrorText(), "nodes: there is no cloth 9") == 0);
    return NULL;
}

static const char* useWorld(DrapeWorld* world)
{
    const float sheet[] = {-0.1f, 0.1f, 0.2f, 0.1f, 0.1f, 0.4f, 0.3f, 0.1f, 0.2f};
    const float floor[] = {-9, 0, -9, 0, 0, 9, 9, 0, -9};
    ClothDescription cloth;
    drapeDefaultCloth(&cloth);
    cloth.m_positions = sheet;
    cloth.m_vertexCount = 3;
    cloth.m_triangles = kTriangle;
    cloth.m_triangleCount = 1;
    ObstacleDescription obstacle;
    drapeDefaultObstacle(&obstacle);
    obstacle.m_positions = floor;
    obstacle.m_vertexCount = 3;
    obstacle.m_triangles = kTriangle;
    obstacle.m_triangleCount = 1;
    int own = -1, below = -1;
    CHECK(drapeWorldAddCloth(world, &cloth, &own) == DRAPE_OK && own == 0);
    CHECK(drapeWorldAddObstacle(world, &obstacle, &below) == DRAPE_OK && below == 0);
    cloth.m_friction = 2;
    int bad = 0;
    CHECK(drapeWorldAddCloth(world, &cloth, &bad) == DRAPE_BAD_INPUT && bad == -1);
    const char* problem = stepWorld(world, own, below);
    if (!problem) problem = useNodes(world, own);
    if (problem) return problem;
    CHECK(drapeWorldSetVertices(world, below, floor, 3, 1) == DRAPE_OK);
    const int32_t triangles[] = {0, 1};
    CHECK(drapeWorldLeaveOutTriangles(world, below, triangles, 1) == DRAPE_OK);
    CHECK(drapeWorldLeaveOutTriangles(world, below, triangles, 2) == DRAPE_BAD_INPUT);
    CHECK(drapeWorldLeaveOutTriangles(world, below, NULL, 0) == DRAPE_OK);
    CHECK(drapeWorldStep(world, 0) == DRAPE_BAD_INPUT);
    CHECK(drapeWorldRemoveCloth(world, own) == DRAPE_OK && drapeWorldRemoveCloth(world, own) == DRAPE_BAD_INPUT);
    CHECK(drapeWorldRemoveObstacle(world, below) == DRAPE_OK);
    return NULL;
}

const char* runFlatProgram(void)
{
    DrapeSettings settings;
    drapeDefaultSettings(&settings);
    settings.m_backend = DRAPE_BACKEND_HOST;
    CHECK(strcmp(drapeWhyNoDevice(&settings), "") == 0);
    const DrapeDeviceInfo* devices = NULL;
    size_t count = 0;
    CHECK(drapeListDevices(&devices, &count) == DRAPE_OK);
    CHECK(strcmp(drapeVersion(), DRAPE_VERSION_STRING) == 0);
    CHECK(drapeVersionNumber() == DRAPE_VERSION_NUMBER);

    DrapeQueries* queries = NULL;
    CHECK(drapeQueriesCreate(&settings, &queries) == DRAPE_OK);
    const char* problem = askQueries(queries);
    drapeQueriesDestroy(queries);
    if (problem) return problem;

    DrapeWorld* world = NULL;
    CHECK(drapeWorldCreate(&settings, &world) == DRAPE_OK);
    problem = useWorld(world);
    drapeWorldDestroy(world);
    if (problem) return problem;

    settings.m_activation = 9;
    CHECK(drapeWorldCreate(&settings, &world) == DRAPE_BAD_INPUT && world == NULL);
    CHECK(strstr(drapeErrorText(), "m_activation") != NULL);
    drapeDefaultSettings(&settings);
    settings.m_backend = DRAPE_BACKEND_OPENCL;
    settings.m_device = "there is no such device";
    CHECK(drapeQueriesCreate(&settings, &queries) == DRAPE_NO_DEVICE && queries == NULL);
    return NULL;
}
