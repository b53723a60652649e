// Soft bodies that collide by clusters, which Drape leaves to Bullet, alone and beside cloth that it handles.
#include <BulletSoftBody/btSoftBodyHelpers.h>

#include "benchmarks/soft_demo/demo_scenes.h"

namespace drape::bench
{
namespace
{
constexpr int kByClusters = btSoftBody::fCollision::CL_SS + btSoftBody::fCollision::CL_RS;

btSoftBody& addClusterMesh(DemoWorld& world, const TriangleMesh& mesh, const btVector3& scale, const btQuaternion& turn,
                           const btVector3& place, double mass, int clusters)
{
    btSoftBody* body = makeSoftMesh(world, mesh);
    addBendingLinks(*body, 1);
    body->m_cfg.piterations = 2;
    body->m_cfg.kDF = 1;
    body->m_cfg.collisions = kByClusters;
    body->randomizeConstraints();
    body->scale(scale);
    body->rotate(turn);
    body->translate(place);
    body->setTotalMass(btScalar(mass), true);
    body->generateClusters(clusters);
    return world.addSoft(body);
}

btSoftBody& addClusterTorus(DemoWorld& world, const btVector3& place, const btQuaternion& turn,
                            const btVector3& scale = btVector3(2, 2, 2), int clusters = 64)
{
    return addClusterMesh(world, makeDemoTorus(), scale, turn, place, 50, clusters);
}

const btQuaternion kStanding(btVector3(1, 0, 0), SIMD_HALF_PI), kLying(0, 0, 0, 1);

void buildDeform(DemoWorld& world)
{
    addClusterTorus(world, btVector3(0, 0, 0), kStanding, btVector3(2, 2, 2), 8);
}

// A sheet whose triangles are clusters, held at its corners, and ten bodies.
void buildClusterSheet(DemoWorld& world)
{
    btSoftBody& cloth = addPatch(world, btVector3(0, 0, 0), 8, 17, 1 + 2 + 4 + 8);
    addBendingLinks(cloth, 0.4);
    cloth.m_cfg.kDF = 1;
    cloth.m_cfg.kSRHR_CL = 1;
    cloth.m_cfg.kSR_SPLT_CL = 0;
    cloth.m_cfg.collisions = kByClusters;
    cloth.getCollisionShape()->setMargin(btScalar(0.05));
    cloth.setTotalMass(50);
    cloth.generateClusters(0);
    addColumnOfBodies(world, 10);
}

void buildClusterCollide(DemoWorld& world)
{
    const btQuaternion turns[] = {kStanding, btQuaternion(btVector3(0, 1, 0), SIMD_HALF_PI), kStanding};
    for (int i = 0; i < 3; ++i)
    {
        btSoftBody& torus = addClusterTorus(world, btVector3(btScalar(3 * i), 2, 0), turns[i], btVector3(2, 2, 2), 16);
        torus.m_cfg.kSSHR_CL = 1;
        torus.m_cfg.kSS_SPLT_CL = 0;
        torus.m_cfg.kSKHR_CL = btScalar(0.1);
        torus.m_cfg.kSK_SPLT_CL = 1;
    }
}

void buildSocket(DemoWorld& world)
{
    btSoftBody& torus = addClusterTorus(world, btVector3(0, 0, 0), kStanding);
    btSoftBody::LJoint::Specs joint;
    joint.position = btVector3(0, 5, 0);
    torus.appendLinearJoint(joint, &addPlate(world, 50, 8));
}

void buildHinge(DemoWorld& world)
{
    btSoftBody& torus = addClusterTorus(world, btVector3(0, 0, 0), kStanding);
    btSoftBody::AJoint::Specs joint;
    joint.axis = btVector3(0, 0, 1);
    torus.appendAngularJoint(joint, &addPlate(world, 50, 8));
}

// Turns a joint at a constant speed, as far as the torque allows.
struct Motor : btSoftBody::AJoint::IControl
{
    btScalar Speed(btSoftBody::AJoint*, btScalar current) override
    {
        return current + btMin(m_torque, btMax(-m_torque, m_goal - current));
    }
    btScalar m_goal = 4, m_torque = 10;  // rad/s; change of the speed in a step
};

// Makes a wheel soft: clusters follow its nodes slowly.
void soften(btSoftBody& wheel)
{
    wheel.m_cfg.piterations = 1;
    wheel.m_clusters[0]->m_matching = wheel.m_clusters[0]->m_ndamping = btScalar(0.05);
}

void buildCombine(DemoWorld& world)
{
    const btVector3 scale(2, 4, 2);
    btSoftBody& first = addClusterTorus(world, btVector3(0, 8, 0), kStanding, scale);
    btSoftBody& second = addClusterTorus(world, btVector3(0, 8, 10), kStanding, scale);
    for (btSoftBody* wheel : {&first, &second})
    {
        wheel->m_cfg.kDP = 0;
        soften(*wheel);
    }
    const auto motor = std::make_shared<Motor>();
    world.keep(motor);
    btSoftBody::AJoint::Specs turning;
    turning.axis = btVector3(0, 0, 1);
    turning.icontrol = motor.get();
    first.appendAngularJoint(turning, &second);
    btSoftBody::LJoint::Specs joint;
    joint.position = btVector3(0, 8, 5);
    first.appendLinearJoint(joint, &second);
}

// A car with soft wheels that drives on the mesh, down stairs and into bodies.
void buildCar(DemoWorld& world)
{
    btSoftBody& body = addClusterMesh(world, makeEaredBall(), btVector3(4, 4, 4), kLying, btVector3(0, 0, 0), 150, 1);
    const btQuaternion wheelTurn(btVector3(0, 0, 1), SIMD_HALF_PI);
    const auto motor = std::make_shared<Motor>();
    world.keep(motor);
    std::vector<btSoftBody*> parts = {&body};
    for (int i = 0; i < 4; ++i)
    {
        const bool rear = i >= 2;
        const btVector3 place((i % 2 == 0 ? 1 : -1) * btScalar(rear ? 9 : 8), -4, rear ? -8 : 8);
        btSoftBody& wheel = addClusterTorus(world, place, wheelTurn, btVector3(2, rear ? 5 : 4, 2));
        soften(wheel);
        btSoftBody::LJoint::Specs joint;
        joint.cfm = joint.erp = 1;
        joint.position = place;
        body.appendLinearJoint(joint, &wheel);
        btSoftBody::AJoint::Specs turning;
        turning.cfm = turning.erp = 1;
        turning.axis = btVector3(1, 0, 0);
        if (rear) turning.icontrol = motor.get();
        body.appendAngularJoint(turning, &wheel);
        parts.push_back(&wheel);
    }
    for (btSoftBody* part : parts)
    {
        part->rotate(btQuaternion(btVector3(0, 1, 0), -SIMD_HALF_PI));
        part->translate(btVector3(20, 12, 0));
    }
    addStairs(world, btVector3(0, -8, 0), btVector3(3, 1, 20), 5);
    addColumnOfBodies(world, 10);
}

// A plate on three soft balls, on a slope.
void buildRobot(DemoWorld& world)
{
    const btVector3 places[] = {btVector3(-8, 25, 8), btVector3(8, 25, 8),
                                btVector3(0, 25, 8 + 8 * btSqrt(btScalar(2)))};
    std::vector<btSoftBody*> balls;
    btVector3 centre(0, 5, 0);
    for (const btVector3& place : places)
    {
        btSoftBody* ball = btSoftBodyHelpers::CreateEllipsoid(world.info(), place, btVector3(3, 3, 3), 512);
        ball->m_materials[0]->m_kLST = btScalar(0.45);
        ball->m_cfg.kVC = 20;
        ball->setTotalMass(50, true);
        ball->setPose(true, false);
        ball->generateClusters(1);
        balls.push_back(&world.addSoft(ball));
        centre += ball->clusterCom(0) / 3;
    }
    btRigidBody& plate = world.addBody(50, btTransform(btQuaternion::getIdentity(), centre),
                                       std::make_shared<btCylinderShape>(btVector3(8, 1, 8)));
    for (btSoftBody* ball : balls)
    {
        btSoftBody::LJoint::Specs joint;
        joint.erp = btScalar(0.5);
        joint.position = ball->clusterCom(0);
        ball->appendLinearJoint(joint, &plate);
    }
    const btQuaternion slope(btVector3(1, 0, 0), SIMD_HALF_PI / 4);
    world.addBody(0, btTransform(slope, btVector3(0, 0, 0)), std::make_shared<btBoxShape>(btVector3(20, 1, 40)));
}

void buildSoftStack(DemoWorld& world)
{
    for (int i = 0; i < 10; ++i)
        addClusterTorus(world, btVector3(0, -5 + btScalar(2.75) * btScalar(i), 0), kLying);
}

void buildMixedStack(DemoWorld& world)
{
    for (int i = 0; i < 10; ++i)
    {
        const double height = -5 + 4.25 * i;
        if (i % 2 == 0)
            addPlate(world, 50, height);
        else
            addClusterTorus(world, btVector3(0, btScalar(height), 0), kLying);
    }
}

// A cube of 4 x 4 x 4 cells of five tetrahedra each.
void buildTetraCube(DemoWorld& world)
{
    constexpr int kNodes = 5;
    std::vector<btVector3> nodes;
    for (int i = 0; i < kNodes * kNodes * kNodes; ++i)
        nodes.emplace_back(btScalar(i % kNodes), 2 + btScalar(i / kNodes % kNodes), btScalar(i / (kNodes * kNodes)));
    btSoftBody* cube = new btSoftBody(&world.info(), int(nodes.size()), nodes.data(), nullptr);
    // The corners of a cell are numbered by bits x, y, z; neighbouring cells are mirrored.
    constexpr int kSplit[5][4] = {{0, 3, 5, 6}, {1, 0, 3, 5}, {2, 3, 0, 6}, {4, 5, 6, 0}, {7, 6, 5, 3}};
    for (int cell = 0; cell < 64; ++cell)
    {
        const int x = cell % 4, y = cell / 4 % 4, z = cell / 16, mirror = (x + y + z) % 2;
        const auto node = [&](int corner)
        {
            const int dx = (corner & 1) ^ mirror, dy = corner >> 1 & 1, dz = corner >> 2;
            return (z + dz) * kNodes * kNodes + (y + dy) * kNodes + x + dx;
        };
        for (const int(&tetra)[4] : kSplit)
        {
            cube->appendTetra(node(tetra[0]), node(tetra[1]), node(tetra[2]), node(tetra[3]));
            for (int i = 0; i < 4; ++i)
                for (int j = 0; j < i; ++j)
                    cube->appendLink(node(tetra[i]), node(tetra[j]), nullptr, true);
        }
    }
    cube->setVolumeMass(300);
    cube->m_cfg.piterations = 1;
    cube->m_materials[0]->m_kLST = btScalar(0.8);
    cube->m_cfg.collisions = kByClusters;
    cube->getCollisionShape()->setMargin(btScalar(0.01));
    cube->generateClusters(16);
    world.addSoft(cube);
}

// A torus of clusters that lands on a sheet beside a sheet with clusters: Drape and Bullet in one world.
void buildMixed(DemoWorld& world)
{
    btSoftBody& cloth = addPatch(world, btVector3(0, 0, 0), 8, 25, 0);
    cloth.getCollisionShape()->setMargin(btScalar(0.1));
    cloth.m_cfg.kDF = 1;
    cloth.setTotalMass(50);
    addClusterTorus(world, btVector3(0, 12, 0), kLying);
    addClusterTorus(world, btVector3(30, 4, 0), kStanding);
}
}  // namespace

void addClusterScenes(std::vector<DemoScene>& scenes)
{
    constexpr unsigned kMesh = kClusters | kWavyGround;
    const DemoScene added[] = {
        {"cluster_deform", "torus of 8 clusters on the mesh", kMesh, buildDeform},
        {"cluster_sheet", "sheet of clusters under ten bodies", kMesh | kLoads, buildClusterSheet, -8.5},
        {"cluster_collide", "three tori of clusters", kMesh, buildClusterCollide},
        {"cluster_socket", "torus hangs from a plate by a socket", kMesh, buildSocket},
        {"cluster_hinge", "torus and plate with a hinge", kMesh, buildHinge},
        {"cluster_combine", "two tori, a motor between them", kMesh | kDriven, buildCombine},
        {"cluster_car", "car of clusters on stairs and the mesh", kMesh | kDriven, buildCar},
        {"cluster_robot", "plate on three soft balls on a slope", kMesh, buildRobot},
        {"cluster_stack", "ten tori of clusters in a stack", kMesh, buildSoftStack},
        {"cluster_stack_mixed", "plates and tori of clusters in a stack", kMesh, buildMixedStack},
        {"tetra_cube", "cube of tetrahedra with clusters", kMesh, buildTetraCube},
        {"mixed", "tori of clusters beside a sheet, on the mesh", kWavyGround, buildMixed}};
    scenes.insert(scenes.end(), std::begin(added), std::end(added));
}
}  // namespace drape::bench
