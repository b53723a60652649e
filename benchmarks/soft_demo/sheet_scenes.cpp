// Cloth: held at corners, under loads, cut, in the wind, and on other cloth.
#include <BulletSoftBody/btSoftBodyHelpers.h>

#include "benchmarks/soft_demo/demo_scenes.h"

namespace drape::bench
{
namespace
{
constexpr int kAllCorners = 1 + 2 + 4 + 8;

// A sheet of 150 kg, held at its corners, and ten bodies that fall on it.
void buildCloth(DemoWorld& world)
{
    btSoftBody& cloth = addPatch(world, btVector3(0, 0, 0), 8, 31, kAllCorners);
    cloth.getCollisionShape()->setMargin(btScalar(0.5));
    addBendingLinks(cloth, 0.4);
    cloth.setTotalMass(150);
    addColumnOfBodies(world, 10);
}

// A sheet that hangs from two pins and from a box.
void buildClothAttach(DemoWorld& world)
{
    constexpr double kHalf = 4, kHeight = 6;
    constexpr int kNodes = 9;
    btSoftBody& cloth = addPatch(world, btVector3(0, btScalar(kHeight), 0), kHalf, kNodes, 4 + 8);
    btRigidBody& box = world.addBody(20, at(0, kHeight, -(kHalf + 3.5)),
                                     std::make_shared<btBoxShape>(btVector3(btScalar(kHalf), 1, 3)));
    cloth.appendAnchor(0, &box);
    cloth.appendAnchor(kNodes - 1, &box);
}

// A light sheet that falls over a fixed capsule.
void buildCapsule(DemoWorld& world)
{
    auto capsule = std::make_shared<btCapsuleShapeX>(btScalar(1), btScalar(5));
    capsule->setMargin(btScalar(0.5));
    world.addBody(0, at(0, 4, 0), std::move(capsule)).setFriction(btScalar(0.8));
    btSoftBody& cloth = addPatch(world, btVector3(0, 6, 0), 4, 20, 0);
    cloth.setTotalMass(btScalar(0.1));
    cloth.m_cfg.piterations = cloth.m_cfg.citerations = cloth.m_cfg.diterations = 10;
}

// A small sheet that falls on a large one, nodes against faces.
void buildSheetOnSheet(DemoWorld& world)
{
    btSoftBody& large = addPatch(world, btVector3(0, 0, 0), 8, 15, kAllCorners);
    large.m_materials[0]->m_kLST = btScalar(0.4);
    btSoftBody& small = addPatch(world, btVector3(5, 10, 0), 4, 7, 0);
    addBendingLinks(small, 0.1);
    small.m_materials[0]->m_kLST = btScalar(0.5);
    for (btSoftBody* cloth : {&large, &small})
    {
        cloth->m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
        cloth->setTotalMass(150);
    }
}

// Cuts the faces and links on a sphere's surface.
struct SphereCut : btSoftBody::ImplicitFn
{
    SphereCut(const btVector3& centre, btScalar radius) : m_centre(centre), m_radius(radius) {}
    btScalar Eval(const btVector3& x) override { return (x - m_centre).length() - m_radius; }

    btVector3 m_centre;
    btScalar m_radius;  // m
};

// A sheet that is cut twice.
void buildCutting(DemoWorld& world)
{
    btSoftBody& cloth = addPatch(world, btVector3(0, 2, 0), 6, 16, kAllCorners);
    cloth.m_cfg.piterations = 1;
    const auto cut = [&cloth](int node)
    {
        SphereCut sphere(cloth.m_nodes[node].m_x, 1);
        cloth.refine(&sphere, btScalar(0.0001), true);
    };
    world.doBefore(60, [=] { cut(8 * 16 + 8); });
    world.doBefore(120, [=] { cut(4 * 16 + 11); });
}

// Turns that differ a little, from -1 to 1.
btScalar varied(int index, int salt)
{
    return btScalar((index * 37 + salt * 61) % 101) / 50 - 1;
}

// Fifty sheets of 0.1 kg that glide.
void buildFlyers(DemoWorld& world)
{
    for (int i = 0; i < 50; ++i)
    {
        btSoftBody& flyer = addPatch(world, btVector3(0, 10, 0), 2, 6, 0);
        addBendingLinks(flyer, 1);
        flyer.m_cfg.kLF = btScalar(0.004);
        flyer.m_cfg.kDG = btScalar(0.0003);
        flyer.m_cfg.aeromodel = btSoftBody::eAeroModel::V_TwoSided;
        btQuaternion turn;
        turn.setEuler(SIMD_PI / 8 + btScalar(0.1) * varied(i, 1), -SIMD_PI / 7 + btScalar(0.1) * varied(i, 2),
                      btScalar(0.1) * varied(i, 3));
        flyer.transform(
            btTransform(turn, btVector3(15 * varied(i, 4), 20 + 15 * varied(i, 5), 80 + 15 * varied(i, 6))));
        flyer.setTotalMass(btScalar(0.1));
        flyer.addForce(btVector3(0, 2, 0), 0);
    }
}

// Five flags in the wind, held at two corners.
void buildFlags(DemoWorld& world)
{
    constexpr int kNodes = 10;
    constexpr btScalar kHalf = 5;
    for (int i = 0; i < 5; ++i)
    {
        btSoftBody& flag = world.addSoft(btSoftBodyHelpers::CreatePatch(
            world.info(), btVector3(-kHalf, 0, -3 * kHalf), btVector3(kHalf, 0, -3 * kHalf),
            btVector3(-kHalf, 0, kHalf), btVector3(kHalf, 0, kHalf), kNodes, 3 * kNodes, 1 + 2, true));
        flag.getCollisionShape()->setMargin(btScalar(0.5));
        addBendingLinks(flag, 0.0004);
        flag.m_cfg.kLF = btScalar(0.05);
        flag.m_cfg.kDG = btScalar(0.01);
        flag.m_cfg.piterations = 2;
        flag.m_cfg.aeromodel = btSoftBody::eAeroModel::V_TwoSidedLiftDrag;
        flag.setWindVelocity(btVector3(4, -12, -25));
        const btQuaternion upright(btVector3(1, 0, 0), SIMD_HALF_PI);
        flag.transform(btTransform(upright, btVector3((2 * kHalf + btScalar(0.5)) * btScalar(i - 2), 0, 0)));
        flag.setTotalMass(2);
        btSoftBodyHelpers::ReoptimizeLinkOrder(&flag);
    }
}

// A sheet on the wavy mesh, with a weight on it.
void buildClothOnMesh(DemoWorld& world)
{
    btSoftBody& cloth = addPatch(world, btVector3(0, 0, 0), 8, 31, 0);
    cloth.getCollisionShape()->setMargin(btScalar(0.1));
    addBendingLinks(cloth, 0.4);
    cloth.setTotalMass(50);
    cloth.m_cfg.kDF = 1;
    world.addBody(10, at(0, 3, 0), std::make_shared<btSphereShape>(btScalar(1.5)));
}

// A ball of 10 kg that hits a sheet at 40 m/s.
void buildFastBall(DemoWorld& world)
{
    btSoftBody& cloth = addPatch(world, btVector3(0, 0, 0), 8, 31, kAllCorners);
    cloth.getCollisionShape()->setMargin(btScalar(0.1));
    cloth.setTotalMass(50);
    btRigidBody& ball = world.addBody(10, at(0, 8, 0), std::make_shared<btSphereShape>(btScalar(1.5)));
    ball.setLinearVelocity(btVector3(0, -40, 0));
}
}  // namespace

void addSheetScenes(std::vector<DemoScene>& scenes)
{
    const DemoScene added[] = {
        {"cloth", "sheet held at its corners, ten bodies fall on it", kLoads, buildCloth, -8.5},
        {"cloth_attach", "sheet between two pins and a box", 0, buildClothAttach},
        {"capsule", "light sheet over a fixed capsule", 0, buildCapsule},
        {"sheet_on_sheet", "sheet falls on a sheet held at its corners", kSoftPairs, buildSheetOnSheet},
        {"cutting", "sheet held at its corners is cut twice", 0, buildCutting},
        {"flyers", "fifty light sheets glide", kFlight, buildFlyers},
        {"flags", "five flags in the wind", kFlight | kDriven, buildFlags},
        {"cloth_on_mesh", "sheet and a ball fall on a wavy mesh", kWavyGround, buildClothOnMesh},
        {"fast_ball", "ball hits a sheet at 40 m/s", kLoads, buildFastBall, -8.5}};
    scenes.insert(scenes.end(), std::begin(added), std::end(added));
}
}  // namespace drape::bench
