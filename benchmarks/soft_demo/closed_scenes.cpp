// Closed bodies: balls with pressure or volume, tori and eared balls, boxes that slide.
#include <BulletSoftBody/btSoftBodyHelpers.h>

#include "benchmarks/soft_demo/demo_scenes.h"

namespace drape::bench
{
namespace
{
btSoftBody& addBallAboveStairs(DemoWorld& world)
{
    btSoftBody& ball =
        world.addSoft(btSoftBodyHelpers::CreateEllipsoid(world.info(), btVector3(35, 25, 0), btVector3(3, 3, 3), 512));
    addPlate(world, 15, 4);
    addStairs(world, btVector3(0, 0, 0), btVector3(2, 1, 5), 10);
    return ball;
}

// A ball with pressure that falls down stairs, past a plate.
void buildPressure(DemoWorld& world)
{
    btSoftBody& ball = addBallAboveStairs(world);
    ball.m_materials[0]->m_kLST = btScalar(0.1);
    ball.m_cfg.kDF = 1;
    ball.m_cfg.kDP = btScalar(0.001);
    ball.m_cfg.kPR = 2500;
    ball.setTotalMass(30, true);
}

// A ball that keeps its volume.
void buildVolume(DemoWorld& world)
{
    btSoftBody& ball = addBallAboveStairs(world);
    ball.m_materials[0]->m_kLST = btScalar(0.45);
    ball.m_cfg.kVC = 20;
    ball.setTotalMass(50, true);
    ball.setPose(true, false);
}

// Turns a body about x and moves it there, then scales it.
void place(btSoftBody& body, const btVector3& place, const btVector3& angles, btScalar scale)
{
    btMatrix3x3 turn;
    turn.setEulerZYX(angles.x(), angles.y(), angles.z());
    body.randomizeConstraints();
    body.transform(btTransform(turn, place));
    body.scale(btVector3(scale, scale, scale));
}

const btVector3 kUpright(SIMD_HALF_PI, 0, 0), kNoTurn(0, 0, 0);

void buildTorus(DemoWorld& world)
{
    btSoftBody* torus = makeSoftMesh(world, makeDemoTorus());
    torus->generateBendingConstraints(2);
    torus->m_cfg.piterations = 2;
    place(*torus, btVector3(0, 4, 0), kUpright, 2);
    torus->setTotalMass(50, true);
    world.addSoft(torus);
}

void buildTorusMatch(DemoWorld& world)
{
    btSoftBody* torus = makeSoftMesh(world, makeDemoTorus());
    torus->m_materials[0]->m_kLST = btScalar(0.1);
    torus->m_cfg.kMT = btScalar(0.05);
    place(*torus, btVector3(0, 4, 0), kUpright, 2);
    torus->setTotalMass(50, true);
    torus->setPose(false, true);
    world.addSoft(torus);
}

void buildBunny(DemoWorld& world)
{
    btSoftBody* bunny = makeSoftMesh(world, makeEaredBall());
    addBendingLinks(*bunny, 0.5);
    bunny->m_cfg.piterations = 2;
    bunny->m_cfg.kDF = btScalar(0.5);
    place(*bunny, btVector3(0, 0, 0), kNoTurn, 3);
    bunny->setTotalMass(100, true);
    world.addSoft(bunny);
}

void buildBunnyMatch(DemoWorld& world)
{
    btSoftBody* bunny = makeSoftMesh(world, makeEaredBall());
    bunny->m_cfg.kDF = btScalar(0.5);
    bunny->m_cfg.kMT = btScalar(0.05);
    bunny->m_cfg.piterations = 5;
    place(*bunny, btVector3(0, 0, 0), kNoTurn, 3);
    bunny->setTotalMass(100, true);
    bunny->setPose(false, true);
    world.addSoft(bunny);
}

// Three closed bodies that fall on each other, nodes against faces.
void addColliding(DemoWorld& world, const TriangleMesh& mesh, double stiffness, btScalar scale, double mass,
                  const btVector3& first, const btVector3& next)
{
    for (int i = 0; i < 3; ++i)
    {
        const bool odd = i % 2 == 1;
        btSoftBody* body = makeSoftMesh(world, mesh);
        addBendingLinks(*body, stiffness);
        body->m_cfg.piterations = 2;
        body->m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
        const btVector3 angles(odd || next.y() > 0 ? 0 : SIMD_HALF_PI, odd ? SIMD_HALF_PI : 0, 0);
        place(*body, first + btScalar(i) * next, angles, scale);
        body->setTotalMass(btScalar(mass), true);
        world.addSoft(body);
    }
}

void buildCollide(DemoWorld& world)
{
    addColliding(world, makeDemoTorus(), 1, 2, 50, btVector3(0, 2, 0), btVector3(3, 0, 0));
}

void buildStack(DemoWorld& world)
{
    addColliding(world, makeEaredBall(), 0.5, 3, 100, btVector3(0, -1, 0), btVector3(0, 5, 0));
    for (const auto& body : world.softBodies())
        body->m_cfg.kDF = btScalar(0.5);
}

// Twenty boxes that slide over the ground, with friction from 0.005 to 0.1.
void buildFriction(DemoWorld& world)
{
    constexpr int kBoxes = 20;
    constexpr btScalar kSide = 2;
    for (int i = 0; i < kBoxes; ++i)
    {
        const btVector3 centre(btScalar(1.25) * kSide * btScalar(i - kBoxes / 2), -10 + kSide, 40);
        btVector3 corners[8];
        for (int corner = 0; corner < 8; ++corner)
            corners[corner] =
                centre + kSide / 2 * btVector3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        btSoftBody* box = btSoftBodyHelpers::CreateFromConvexHull(world.info(), corners, 8);
        box->generateBendingConstraints(2);
        world.addSoft(box);
        box->m_cfg.kDF = btScalar(0.1) * btScalar(i + 1) / kBoxes;
        box->addVelocity(btVector3(0, 0, -10));
    }
}
}  // namespace

void addClosedScenes(std::vector<DemoScene>& scenes)
{
    const DemoScene added[] = {
        {"pressure", "ball with pressure falls down stairs", kClosed, buildPressure},
        {"volume", "ball of constant volume falls down stairs", kClosed, buildVolume},
        {"torus", "torus falls on its edge", kClosed, buildTorus},
        {"torus_match", "torus that keeps its shape", kClosed, buildTorusMatch},
        {"bunny", "eared ball falls", kClosed, buildBunny},
        {"bunny_match", "eared ball that keeps its shape", kClosed, buildBunnyMatch},
        {"collide", "three tori fall into each other", kClosed | kSoftPairs, buildCollide},
        {"stack", "three eared balls fall on each other", kClosed | kSoftPairs, buildStack},
        {"friction", "twenty boxes slide with rising friction", kClosed | kByFriction, buildFriction}};
    scenes.insert(scenes.end(), std::begin(added), std::end(added));
}
}  // namespace drape::bench
