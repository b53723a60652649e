// The worlds of drape/c_api.h.
#include "bullet_plugin/adapter/c_api/c_call.h"
#include "bullet_plugin/adapter/c_api/c_records.h"
#include "drape/cloth_world.h"

namespace drape
{
struct DrapeWorld
{
    std::unique_ptr<ClothWorld> m_world;
    std::vector<ClothContact> m_contacts;
    std::vector<ClothStepContact> m_stepContacts;
    std::vector<ClothTriangles> m_triangles;
};

namespace
{
// Returns the code of work(), a call of the handle's world that returns false for a failure.
template <class Work>
DrapeResult callWorld(const DrapeWorld* world, const char* call, const Work& work) noexcept
{
    if (!world) return refuseC(call, "the handle is null");
    return resultOf(work(*world->m_world), *world->m_world);
}

// Does the same for a call that returns an index, -1 for a failure.
template <class Description, class Work>
DrapeResult addToWorld(DrapeWorld* world, const Description* description, int* index, const char* call,
                       const Work& work) noexcept
{
    if (!world || !description || !index) return refuseC(call, "an argument is null");
    *index = work(*world->m_world);
    return resultOf(*index >= 0, *world->m_world);
}
}  // namespace

void drapeDefaultCloth(ClothDescription* cloth)
{
    if (cloth) *cloth = defaultCloth();
}

void drapeDefaultObstacle(ObstacleDescription* obstacle)
{
    if (obstacle) *obstacle = defaultObstacle();
}

DrapeResult drapeWorldCreate(const DrapeSettings* settings, DrapeWorld** world)
{
    const char* const call = "drapeWorldCreate";
    if (!world) return refuseC(call, "an argument is null");
    *world = nullptr;
    return callC(call,
                 [&]
                 {
                     std::unique_ptr<DrapeWorld> made(new DrapeWorld);
                     Error error;
                     made->m_world = ClothWorld::create(settingsOf(settings), error);
                     if (!made->m_world) return failC(error);
                     *world = made.release();
                     return DRAPE_OK;
                 });
}

void drapeWorldDestroy(DrapeWorld* world)
{
    delete world;
}

DrapeResult drapeWorldSetGravity(DrapeWorld* world, const double gravity[3])
{
    return callWorld(world, "drapeWorldSetGravity", [&](ClothWorld& own) { return own.setGravity(gravity); });
}

DrapeResult drapeWorldAddCloth(DrapeWorld* world, const ClothDescription* cloth, int* index)
{
    return addToWorld(world, cloth, index, "drapeWorldAddCloth", [&](ClothWorld& own) { return own.addCloth(*cloth); });
}

DrapeResult drapeWorldAddObstacle(DrapeWorld* world, const ObstacleDescription* obstacle, int* index)
{
    return addToWorld(world, obstacle, index, "drapeWorldAddObstacle",
                      [&](ClothWorld& own) { return own.addObstacle(*obstacle); });
}

DrapeResult drapeWorldRemoveCloth(DrapeWorld* world, int cloth)
{
    return callWorld(world, "drapeWorldRemoveCloth", [&](ClothWorld& own) { return own.removeCloth(cloth); });
}

DrapeResult drapeWorldRemoveObstacle(DrapeWorld* world, int obstacle)
{
    return callWorld(world, "drapeWorldRemoveObstacle", [&](ClothWorld& own) { return own.removeObstacle(obstacle); });
}

DrapeResult drapeWorldSetPose(DrapeWorld* world, int obstacle, const double position[3], const double rotation[4],
                              int teleport)
{
    return callWorld(world, "drapeWorldSetPose",
                     [&](ClothWorld& own) { return own.setPose(obstacle, position, rotation, teleport != 0); });
}

DrapeResult drapeWorldSetVertices(DrapeWorld* world, int obstacle, const float* positions, size_t vertexCount,
                                  int teleport)
{
    return callWorld(world, "drapeWorldSetVertices",
                     [&](ClothWorld& own) { return own.setVertices(obstacle, positions, vertexCount, teleport != 0); });
}

DrapeResult drapeWorldLeaveOutTriangles(DrapeWorld* world, int obstacle, const int32_t* triangles, size_t count)
{
    return callWorld(world, "drapeWorldLeaveOutTriangles",
                     [&](ClothWorld& own) { return own.leaveOutTriangles(obstacle, triangles, count); });
}

DrapeResult drapeWorldSetPinned(DrapeWorld* world, int cloth, const int32_t* nodes, size_t count, int pinned)
{
    return callWorld(world, "drapeWorldSetPinned",
                     [&](ClothWorld& own) { return own.setPinned(cloth, nodes, count, pinned != 0); });
}

DrapeResult drapeWorldSetPositions(DrapeWorld* world, int cloth, const int32_t* nodes, size_t count,
                                   const float* positions, int teleport)
{
    return callWorld(world, "drapeWorldSetPositions",
                     [&](ClothWorld& own) { return own.setPositions(cloth, nodes, count, positions, teleport != 0); });
}

DrapeResult drapeWorldSetVelocities(DrapeWorld* world, int cloth, const int32_t* nodes, size_t count,
                                    const float* velocities)
{
    return callWorld(world, "drapeWorldSetVelocities",
                     [&](ClothWorld& own) { return own.setVelocities(cloth, nodes, count, velocities); });
}

DrapeResult drapeWorldStep(DrapeWorld* world, double dt)
{
    return callWorld(world, "drapeWorldStep", [&](ClothWorld& own) { return own.step(dt); });
}

DrapeResult drapeWorldNodes(const DrapeWorld* world, int cloth, NodeView* view)
{
    if (!view) return refuseC("drapeWorldNodes", "an argument is null");
    return callWorld(world, "drapeWorldNodes", [&](const ClothWorld& own) { return own.nodes(cloth, *view); });
}

DrapeResult drapeWorldCopyNodes(const DrapeWorld* world, int cloth, float* positions, float* velocities, float* normals)
{
    NodeArrays arrays;
    arrays.m_positions = positions;
    arrays.m_velocities = velocities;
    arrays.m_normals = normals;
    return callWorld(world, "drapeWorldCopyNodes", [&](const ClothWorld& own) { return own.copyNodes(cloth, arrays); });
}

DrapeResult drapeWorldStatistics(const DrapeWorld* world, DrapeStatistics* statistics)
{
    if (!world || !statistics) return refuseC("drapeWorldStatistics", "an argument is null");
    *statistics = statisticsOf(world->m_world->plugin().statistics());
    return DRAPE_OK;
}

DrapeResult drapeWorldContacts(DrapeWorld* world, const ClothContact** contacts, size_t* count)
{
    if (!world || !contacts || !count) return refuseC("drapeWorldContacts", "an argument is null");
    if (!world->m_world->contacts(world->m_contacts)) return failC(world->m_world->error());
    *contacts = world->m_contacts.data();
    *count = world->m_contacts.size();
    return DRAPE_OK;
}

DrapeResult drapeWorldRecordContacts(DrapeWorld* world, int record)
{
    if (!world) return refuseC("drapeWorldRecordContacts", "an argument is null");
    world->m_world->plugin().recordContacts(record != 0);
    return DRAPE_OK;
}

DrapeResult drapeWorldStepContacts(DrapeWorld* world, const ClothStepContact** contacts, size_t* count)
{
    if (!world || !contacts || !count) return refuseC("drapeWorldStepContacts", "an argument is null");
    if (!world->m_world->stepContacts(world->m_stepContacts)) return failC(world->m_world->error());
    *contacts = world->m_stepContacts.data();
    *count = world->m_stepContacts.size();
    return DRAPE_OK;
}

DrapeResult drapeWorldClothTriangles(DrapeWorld* world, const ClothTriangles** pairs, size_t* count)
{
    if (!world || !pairs || !count) return refuseC("drapeWorldClothTriangles", "an argument is null");
    if (!world->m_world->clothTriangles(world->m_triangles)) return failC(world->m_world->error());
    *pairs = world->m_triangles.data();
    *count = world->m_triangles.size();
    return DRAPE_OK;
}

DrapeResult drapeWorldDevice(const DrapeWorld* world, DrapeDeviceReport* device)
{
    if (!world || !device) return refuseC("drapeWorldDevice", "an argument is null");
    *device = reportOf(world->m_world->plugin().device());
    return DRAPE_OK;
}

DrapeResult drapeWorldAwaitDevice(DrapeWorld* world)
{
    if (!world) return refuseC("drapeWorldAwaitDevice", "the handle is null");
    world->m_world->plugin().awaitDevice();
    return DRAPE_OK;
}

const char* drapeWorldReport(const DrapeWorld* world)
{
    static thread_local std::string t_text;
    return textC(t_text, [&] { return world ? world->m_world->plugin().report() : std::string(); });
}

const char* drapeWorldDiagnose(const DrapeWorld* world)
{
    static thread_local std::string t_text;
    return textC(t_text, [&] { return world ? world->m_world->diagnose() : std::string(); });
}

const char* drapeWorldDeviceError(const DrapeWorld* world)
{
    static thread_local std::string t_text;
    return textC(t_text, [&] { return world ? world->m_world->plugin().error() : std::string(); });
}
}  // namespace drape
