// Plugin::setOneSided: cloth inside a closed mesh is held by its walls, or comes out of it.
#include <gtest/gtest.h>

#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"

namespace drape::test
{
namespace
{
// Height of a cloth's middle node after it was let go inside a box of 2 m around the origin.
float heightAfterFall(bool oneSided, bool kinematic)
{
    Plugin plugin(hostSettings());
    MeshShape box(makeBox(2, 2, 2));
    plugin.setOneSided(&box.shape(), oneSided);
    DropWorld world(&plugin);
    if (kinematic)
        world.addKinematic(box.shape());
    else
        world.addObstacle(box.shape());
    ClothSpec spec;
    spec.m_centre = btVector3(0, btScalar(-0.5), 0);
    const btSoftBody& cloth = world.addCloth(spec);
    world.step(90);
    return static_cast<float>(cloth.m_nodes[cloth.m_nodes.size() / 2].m_x.y());
}
}  // namespace

TEST(Sides, clothInsideOfABoxStaysThereOrFallsOut)
{
    for (const bool kinematic : {false, true})
    {
        EXPECT_NEAR(heightAfterFall(false, kinematic), -1 + kThickness, 0.01f);
        EXPECT_LT(heightAfterFall(true, kinematic), -2);
    }
}

TEST(Sides, aOneSidedBoxHoldsClothThatComesFromOutside)
{
    Plugin plugin(hostSettings());
    MeshShape box(makeBox(2, 2, 2));
    DropWorld world(&plugin);
    world.addObstacle(box.shape());
    ClothSpec spec;
    spec.m_centre = btVector3(0, btScalar(1.1), 0);
    const btSoftBody& cloth = world.addCloth(spec);
    world.step(30);
    plugin.setOneSided(&box.shape(), true);  // while it lies there
    world.step(60);
    const btScalar resting = cloth.m_nodes[cloth.m_nodes.size() / 2].m_x.y();
    EXPECT_NEAR(resting, 1 + kThickness, 0.01f);
    EXPECT_GT(plugin.statistics().m_contacts, 0u);
}
}  // namespace drape::test
