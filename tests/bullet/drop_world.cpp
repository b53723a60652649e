#include "tests/bullet/drop_world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "scenes/cloth_grid.h"

namespace drape::test
{
namespace
{
std::unique_ptr<btCollisionConfiguration> makeConfiguration(Plugin* plugin, Wiring wiring)
{
    if (plugin && wiring == Wiring::Configuration) return std::make_unique<CollisionConfiguration>(*plugin);
    return std::make_unique<btSoftBodyRigidBodyCollisionConfiguration>();
}

std::unique_ptr<btSoftBodySolver> makeSolver(Plugin* plugin)
{
    if (!plugin) return nullptr;
    return std::make_unique<SoftBodySolver>(*plugin);
}

void addSprings(btSoftBody& body, const ClothGrid& grid)
{
    btSoftBody::Material* bending = body.appendMaterial();
    bending->m_kLST = btScalar(0.1);
    for (std::size_t i = 0; i < grid.m_edgeSprings.size(); i += 2)
        body.appendLink(grid.m_edgeSprings[i], grid.m_edgeSprings[i + 1], body.m_materials[0]);
    for (std::size_t i = 0; i < grid.m_bendingSprings.size(); i += 2)
        body.appendLink(grid.m_bendingSprings[i], grid.m_bendingSprings[i + 1], bending);
}
}  // namespace

std::unique_ptr<btSoftBody> makeCloth(btSoftBodyWorldInfo& info, const ClothSpec& spec)
{
    const ClothGrid grid = makeClothGrid(spec.m_nodes, spec.m_nodes, spec.m_size, 0);
    const TriangleMesh& mesh = grid.m_mesh;
    std::vector<btVector3> places(mesh.vertexCount());
    for (std::size_t i = 0; i < places.size(); ++i)
        places[i] = spec.m_centre + btVector3(btScalar(mesh.m_positions[3 * i]), btScalar(mesh.m_positions[3 * i + 1]),
                                              btScalar(mesh.m_positions[3 * i + 2]));
    const std::vector<btScalar> masses(places.size(), btScalar(1) / btScalar(places.size()));
    auto body = std::make_unique<btSoftBody>(&info, int(places.size()), places.data(), masses.data());
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
        body->appendFace(mesh.m_triangles[3 * t], mesh.m_triangles[3 * t + 1], mesh.m_triangles[3 * t + 2]);
    if (spec.m_springs) addSprings(*body, grid);
    body->getCollisionShape()->setMargin(kMargin);
    body->m_cfg.piterations = 4;
    body->m_cfg.kDP = spec.m_damping;
    body->m_cfg.kDF = btScalar(0.6);
    return body;
}

MeshShape::MeshShape(const TriangleMesh& mesh) : m_mesh(mesh)
{
    btIndexedMesh part;
    part.m_numTriangles = int(m_mesh.triangleCount());
    part.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(m_mesh.m_triangles.data());
    part.m_triangleIndexStride = 3 * sizeof(std::int32_t);
    part.m_numVertices = int(m_mesh.vertexCount());
    part.m_vertexBase = reinterpret_cast<const unsigned char*>(m_mesh.m_positions.data());
    part.m_vertexStride = 3 * sizeof(float);
    part.m_vertexType = PHY_FLOAT;
    m_arrays.addIndexedMesh(part, PHY_INTEGER);
    m_shape = std::make_unique<btBvhTriangleMeshShape>(&m_arrays, true);
    m_shape->setMargin(kMargin);
}

DropWorld::DropWorld(Plugin* plugin, Wiring wiring)
    : m_configuration(makeConfiguration(plugin, wiring)),
      m_solver(makeSolver(plugin)),
      m_dispatcher(m_configuration.get()),
      m_world(&m_dispatcher, &m_broadphase, &m_rigidSolver, m_configuration.get(), m_solver.get())
{
    m_world.setGravity(btVector3(0, btScalar(-9.81), 0));
    m_world.getWorldInfo().m_gravity = m_world.getGravity();
}

DropWorld::~DropWorld()
{
    while (!m_cloths.empty())
        remove(*m_cloths.back());
    while (!m_obstacles.empty())
        remove(*m_obstacles.back());
}

btSoftBody& DropWorld::addCloth(const ClothSpec& spec, int group, int mask)
{
    m_cloths.push_back(makeCloth(m_world.getWorldInfo(), spec));
    m_world.addSoftBody(m_cloths.back().get(), group, mask);
    return *m_cloths.back();
}

btCollisionObject& DropWorld::addObstacle(btCollisionShape& shape, const btTransform& pose)
{
    m_obstacles.push_back(std::make_unique<btCollisionObject>());
    btCollisionObject& object = *m_obstacles.back();
    object.setCollisionShape(&shape);
    object.setWorldTransform(pose);
    object.setFriction(1);
    m_world.addCollisionObject(&object, btBroadphaseProxy::StaticFilter,
                               btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::StaticFilter);
    return object;
}

btRigidBody& DropWorld::addKinematic(btCollisionShape& shape, const btTransform& pose)
{
    btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, &shape);
    info.m_startWorldTransform = pose;
    auto body = std::make_unique<btRigidBody>(info);
    btRigidBody& added = *body;
    // Most apps leave the flag of static bodies, which a body without mass has.
    added.setCollisionFlags(added.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    added.setActivationState(DISABLE_DEACTIVATION);
    added.setFriction(1);
    m_world.addRigidBody(&added);
    m_obstacles.push_back(std::move(body));
    return added;
}

btRigidBody& DropWorld::addDynamic(btCollisionShape& shape, btScalar mass, const btTransform& pose)
{
    btVector3 inertia;
    shape.calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &shape, inertia);
    info.m_startWorldTransform = pose;
    auto body = std::make_unique<btRigidBody>(info);
    btRigidBody& added = *body;
    added.setActivationState(DISABLE_DEACTIVATION);
    m_world.addRigidBody(&added);
    m_obstacles.push_back(std::move(body));
    return added;
}

void DropWorld::remove(btSoftBody& cloth)
{
    m_world.removeSoftBody(&cloth);
    m_cloths.erase(
        std::find_if(m_cloths.begin(), m_cloths.end(), [&](const auto& owned) { return owned.get() == &cloth; }));
}

void DropWorld::remove(btCollisionObject& obstacle)
{
    m_world.removeCollisionObject(&obstacle);
    m_obstacles.erase(std::find_if(m_obstacles.begin(), m_obstacles.end(),
                                   [&](const auto& owned) { return owned.get() == &obstacle; }));
}

void DropWorld::step(int count)
{
    for (int i = 0; i < count; ++i)
        m_world.stepSimulation(kDt, 1, kDt);
}

Settings hostSettings()
{
    Settings settings;
    settings.m_backend = Backend::Host;
    return settings;
}

std::vector<float> positionsOf(const btSoftBody& cloth)
{
    std::vector<float> positions;
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            positions.push_back(static_cast<float>(cloth.m_nodes[i].m_x[axis]));
    return positions;
}

TriangleMesh meshOf(const btSoftBody& cloth)
{
    TriangleMesh mesh;
    mesh.m_positions = positionsOf(cloth);
    for (int f = 0; f < cloth.m_faces.size(); ++f)
        for (const btSoftBody::Node* node : cloth.m_faces[f].m_n)
            mesh.m_triangles.push_back(static_cast<std::int32_t>(node - &cloth.m_nodes[0]));
    return mesh;
}

btScalar lowestOf(const btSoftBody& cloth)
{
    btScalar lowest = SIMD_INFINITY;
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        lowest = std::min(lowest, cloth.m_nodes[i].m_x.y());
    return lowest;
}

double rmsSpeed(const btSoftBody& cloth)
{
    double sum = 0;
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        sum += static_cast<double>(cloth.m_nodes[i].m_v.length2());
    return std::sqrt(sum / cloth.m_nodes.size());
}

bool sameContacts(const std::vector<ContactInfo>& a, const std::vector<ContactInfo>& b)
{
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(),
                                              [](const ContactInfo& one, const ContactInfo& other)
                                              { return std::memcmp(&one, &other, sizeof one) == 0; });
}

btVector3 linearMomentumOf(const btSoftBody& cloth)
{
    btVector3 sum(0, 0, 0);
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        if (cloth.m_nodes[i].m_im > 0) sum += cloth.m_nodes[i].m_v / cloth.m_nodes[i].m_im;
    return sum;
}

btVector3 angularMomentumOf(const btSoftBody& cloth)
{
    btVector3 sum(0, 0, 0);
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        sum += cloth.m_nodes[i].m_x.cross(cloth.m_nodes[i].m_v) / cloth.m_nodes[i].m_im;
    return sum;
}

btVector3 angularMomentumOf(const btRigidBody& body)
{
    return body.getWorldTransform().getOrigin().cross(body.getLinearVelocity()) / body.getInvMass() +
           body.getInvInertiaTensorWorld().inverse() * body.getAngularVelocity();
}

int contactsHeld(const btSoftBody& cloth)
{
    return cloth.m_rcontacts.size() + cloth.m_scontacts.size();
}

TriangleMesh placed(const TriangleMesh& mesh, const btTransform& pose, const btVector3& scaling)
{
    TriangleMesh moved = mesh;
    for (std::size_t i = 0; i < moved.m_positions.size(); i += 3)
    {
        float* at = &moved.m_positions[i];
        const btVector3 world = pose * (btVector3(btScalar(at[0]), btScalar(at[1]), btScalar(at[2])) * scaling);
        for (int axis = 0; axis < 3; ++axis)
            at[axis] = static_cast<float>(world[axis]);
    }
    return moved;
}

std::uint64_t hashOf(const btSoftBody& cloth, std::uint64_t hash)
{
    for (float value : positionsOf(cloth))
    {
        std::uint32_t bits;
        std::memcpy(&bits, &value, sizeof bits);
        hash = (hash ^ bits) * 0x100000001b3ull;
    }
    return hash;
}

Course runMeasured(DropWorld& world, btSoftBody& cloth, const TriangleMesh& obstacle, int steps)
{
    Course course;
    PenetrationMeter meter(obstacle, meshOf(cloth));
    for (int i = 0; i < steps; ++i)
    {
        world.step();
        course.m_end = meter.measure(positionsOf(cloth).data());
        course.m_penetrationMax = std::max(course.m_penetrationMax, course.m_end.m_penetrationMax);
        course.m_hash = hashOf(cloth, course.m_hash);
    }
    return course;
}

void expectClean(const Course& course)
{
    EXPECT_EQ(course.m_penetrationMax, 0);
    EXPECT_EQ(course.m_end.nodesBelow(), 0u);
    EXPECT_EQ(course.m_end.m_intersectingPairs, 0u);
    EXPECT_EQ(course.m_end.m_invalidNodes, 0u);
}
}  // namespace drape::test
