#include "benchmarks/soft_demo/demo_scenes.h"

#include <algorithm>
#include <cmath>

#include <BulletSoftBody/btSoftBodyHelpers.h>

#include "scenes/shapes.h"
#include "scenes/vector3.h"

namespace drape::bench
{
namespace
{
constexpr btScalar kLoadMass = 10;                    // kg
constexpr btScalar kLoadSpacing = 6;                  // m
constexpr double kEarLength = 0.8, kEarWidth = 0.22;  // m; radians
}  // namespace

const std::vector<DemoScene>& demoScenes()
{
    static const std::vector<DemoScene> scenes = []
    {
        std::vector<DemoScene> made;
        addSheetScenes(made);
        addRopeScenes(made);
        addClosedScenes(made);
        addClusterScenes(made);
        return made;
    }();
    return scenes;
}

void addColumnOfBodies(DemoWorld& world, int count)
{
    const auto bar = std::make_shared<btBoxShape>(btVector3(4, 1, 1));
    const auto roller = std::make_shared<btCylinderShapeX>(btVector3(4, 1, 1));
    const auto cross = std::make_shared<btCompoundShape>();
    cross->addChildShape(at(0, 0, 0), bar.get());
    cross->addChildShape(btTransform(btQuaternion(btVector3(0, 1, 0), SIMD_HALF_PI)), roller.get());
    world.keep(bar);
    world.keep(roller);
    const std::shared_ptr<btCollisionShape> shapes[] = {cross, std::make_shared<btBoxShape>(btVector3(1, 1, 1)),
                                                        std::make_shared<btSphereShape>(btScalar(1.5))};
    for (int i = 0; i < count; ++i)
        world.addBody(kLoadMass, at(0, 2 + kLoadSpacing * double(i), 0), shapes[i % 3]);
}

btRigidBody& addPlate(DemoWorld& world, double mass, double height)
{
    btRigidBody& plate = world.addBody(mass, at(0, height, 0.5), std::make_shared<btBoxShape>(btVector3(5, 1, 5)));
    plate.setFriction(1);
    return plate;
}

void addStairs(DemoWorld& world, const btVector3& first, const btVector3& half, int count)
{
    const auto step = std::make_shared<btBoxShape>(half);
    for (int i = 0; i < count; ++i)
    {
        const btVector3 centre = first + btScalar(2 * i) * btVector3(half.x(), half.y(), 0);
        world.addBody(0, btTransform(btQuaternion::getIdentity(), centre), step).setFriction(1);
    }
}

btSoftBody& addPatch(DemoWorld& world, const btVector3& centre, double half, int nodes, int corners)
{
    const btVector3 x(btScalar(half), 0, 0), z(0, 0, btScalar(half));
    return world.addSoft(btSoftBodyHelpers::CreatePatch(world.info(), centre - x - z, centre + x - z, centre - x + z,
                                                        centre + x + z, nodes, nodes, corners, true));
}

void addBendingLinks(btSoftBody& body, double stiffness, int distance)
{
    btSoftBody::Material* material = body.appendMaterial();
    material->m_kLST = btScalar(stiffness);
    body.generateBendingConstraints(distance, material);
}

btSoftBody* makeSoftMesh(DemoWorld& world, const TriangleMesh& mesh)
{
    const std::vector<btScalar> positions(mesh.m_positions.begin(), mesh.m_positions.end());
    const std::vector<int> triangles(mesh.m_triangles.begin(), mesh.m_triangles.end());
    return btSoftBodyHelpers::CreateFromTriMesh(world.info(), positions.data(), triangles.data(),
                                                int(mesh.triangleCount()));
}

TriangleMesh makeDemoTorus()
{
    return makeTorus(2, 0.5f, 30, 10);
}

TriangleMesh makeEaredBall()
{
    TriangleMesh mesh = makeSphere(0.75f, 3);
    const Vector3 ears[] = {normalized(Vector3{0.35, 1, 0}), normalized(Vector3{-0.35, 1, 0})};
    for (std::size_t i = 0; i < mesh.m_positions.size(); i += 3)
    {
        float* const vertex = &mesh.m_positions[i];
        const Vector3 outwards = normalized(Vector3{vertex[0], vertex[1], vertex[2]});
        double longest = 0;
        for (const Vector3& ear : ears)
        {
            const double angle = std::acos(std::min(1.0, dot(outwards, ear)));
            longest = std::max(longest, kEarLength * std::exp(-std::pow(angle / kEarWidth, 2)));
        }
        const double outside[] = {outwards.x, outwards.y, outwards.z};
        for (int axis = 0; axis < 3; ++axis)
            vertex[axis] += float(longest * outside[axis]);
    }
    return mesh;
}
}  // namespace drape::bench
