// Uses an installed Drape as an outside project does: asks it two questions, then a cloth falls on a ground of two
// triangles and must stay on it.
//
// Computes on the host, so that it runs where there is no OpenCL device. Exit code 0 when the answers are right,
// Drape found contacts and every node ended at or above the ground, 1 otherwise, with the reason on standard error.
#include <cstdint>
#include <cstdio>
#include <memory>
#include <vector>

#include <btBulletDynamicsCommon.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <drape/drape.h>
#include <drape/queries.h>

namespace
{
const int kSteps = 90;
const btScalar kStepTime = btScalar(1.0 / 60.0);  // s
const btScalar kDrop = btScalar(0.3);             // m

// Adds two triangles, 4 m wide, at height 0.
void addGround(btTriangleMesh& mesh)
{
    const btVector3 a(-2, 0, -2), b(2, 0, -2), c(2, 0, 2), d(-2, 0, 2);
    mesh.addTriangle(a, c, b);
    mesh.addTriangle(a, d, c);
}

btSoftBody* makeCloth(btSoftBodyWorldInfo& info)
{
    btSoftBody* cloth = btSoftBodyHelpers::CreatePatch(info, btVector3(-1, kDrop, -1), btVector3(1, kDrop, -1),
                                                       btVector3(-1, kDrop, 1), btVector3(1, kDrop, 1), 9, 9, 0, true);
    cloth->setTotalMass(1);
    cloth->getCollisionShape()->setMargin(btScalar(0.01));
    return cloth;
}

btScalar lowestNode(const btSoftBody& cloth)
{
    btScalar lowest = cloth.m_nodes[0].m_x.y();
    for (int i = 1; i < cloth.m_nodes.size(); ++i)
        lowest = btMin(lowest, cloth.m_nodes[i].m_x.y());
    return lowest;
}

// Steps the world and returns the most contacts that a step had.
unsigned long drop(btSoftRigidDynamicsWorld& world, const drape::Plugin& plugin)
{
    unsigned long contacts = 0;
    for (int step = 0; step < kSteps; ++step)
    {
        world.stepSimulation(kStepTime, 1, kStepTime);
        contacts = btMax(contacts, static_cast<unsigned long>(plugin.statistics().m_contacts));
    }
    return contacts;
}

drape::MeshDescription describe(const std::vector<float>& positions, const std::vector<std::int32_t>& triangles)
{
    drape::MeshDescription mesh;
    mesh.m_positions = positions.data();
    mesh.m_vertexCount = positions.size() / 3;
    mesh.m_triangles = triangles.data();
    mesh.m_triangleCount = triangles.size() / 3;
    return mesh;
}

// Checks known answers. A third triangle pierces the second of two adjacent triangles and is 5 cm from the first. A
// point that goes through a face meets it half-way.
bool answersAreRight(const drape::Settings& settings)
{
    drape::Error error;
    const std::unique_ptr<drape::Queries> queries = drape::Queries::create(settings, error);
    if (!queries) return false;

    const std::vector<float> ground = {0, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0, 1};
    const std::vector<std::int32_t> groundTriangles = {0, 1, 2, 2, 1, 3};
    const std::vector<float> spike = {0.55f, -1, 0.55f, 0.6f, 1, 0.55f, 0.55f, 1, 0.6f};
    const std::vector<std::int32_t> spikeTriangles = {0, 1, 2};
    const drape::MeshDescription other = describe(spike, spikeTriangles);
    drape::MeshPairs pairs;
    if (!queries->meshPairs(describe(ground, groundTriangles), &other, 0.1f, pairs)) return false;
    if (pairs.m_within.size() != 2 || pairs.m_intersecting.size() != 1 || pairs.m_intersecting[0].m_a != 1)
        return false;

    const drape::CcdQuery query = {
        {0.2f, 1, 0.2f, 0, 0, 0, 0, 0, 1, 1, 0, 0}, {0.2f, -1, 0.2f, 0, 0, 0, 0, 0, 1, 1, 0, 0}, DRAPE_VERTEX_FACE};
    drape::CcdResult result;
    if (!queries->motions(&query, 1, drape::defaultCcdSettings(), &result)) return false;
    return result.m_hit && result.m_time <= 0.5f && result.m_time > 0.49f;
}
}  // namespace

int main()
{
    drape::Settings settings;
    settings.m_backend = drape::Backend::Host;
    if (!answersAreRight(settings))
    {
        std::fprintf(stderr, "wrong answers to questions about triangles\n");
        return 1;
    }
    drape::Plugin plugin(settings);
    if (!plugin.ready())
    {
        std::fprintf(stderr, "%s\n", plugin.error().c_str());
        return 1;
    }

    drape::CollisionConfiguration configuration(plugin);
    drape::SoftBodySolver solver(plugin);
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver constraints;
    btSoftRigidDynamicsWorld world(&dispatcher, &broadphase, &constraints, &configuration, &solver);
    world.getWorldInfo().m_dispatcher = &dispatcher;
    world.getWorldInfo().m_broadphase = &broadphase;

    btTriangleMesh mesh;
    addGround(mesh);
    btBvhTriangleMeshShape shape(&mesh, true);
    shape.setMargin(btScalar(0.01));
    btRigidBody ground(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &shape));
    world.addRigidBody(&ground);
    btSoftBody* cloth = makeCloth(world.getWorldInfo());
    world.addSoftBody(cloth);

    const unsigned long contacts = drop(world, plugin);
    const btScalar lowest = lowestNode(*cloth);
    world.removeSoftBody(cloth);
    world.removeRigidBody(&ground);
    delete cloth;

    std::printf("%s\ncontacts %lu, lowest node at %.4f m\n", plugin.report().c_str(), contacts, double(lowest));
    if (contacts > 0 && lowest > 0) return 0;
    std::fprintf(stderr, "the cloth was not held\n");
    return 1;
}
