// Friction of Drape's contacts is Bullet's: the cloth's kDF times the obstacle's coefficient; and contacts put no
// energy in.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"

namespace drape::test
{
namespace
{
constexpr double kGravity = 9.81;  // m/s²

// A cloth on a flat box under inclined gravity, which is equivalent to a slope.
struct Slope
{
    Plugin m_plugin;
    DropWorld m_world;
    MeshShape m_shape;
    btSoftBody* m_cloth = nullptr;

    Slope(const Settings& settings, bool springs)
        : m_plugin(settings), m_world(&m_plugin), m_shape(makeBox(6.0f, 0.4f, 6.0f))
    {
        m_world.addObstacle(m_shape.shape());
        ClothSpec spec;
        spec.m_nodes = 9;
        spec.m_size = 0.6f;
        spec.m_springs = springs;
        spec.m_damping = 0;
        spec.m_centre = btVector3(btScalar(0.013), btScalar(0.2 + kThickness), btScalar(0.007));
        m_cloth = &m_world.addCloth(spec);
    }

    void lean(double angle)
    {
        const btVector3 gravity(btScalar(kGravity * std::sin(angle)), btScalar(-kGravity * std::cos(angle)), 0);
        m_world.world().setGravity(gravity);
        m_world.world().getWorldInfo().m_gravity = gravity;
    }

    // Lets the cloth lie on the box at another distance, m.
    void setThickness(btScalar thickness)
    {
        m_shape.shape().setMargin(thickness / 2);
        m_cloth->getCollisionShape()->setMargin(thickness / 2);
        m_cloth->translate(btVector3(0, thickness - btScalar(kThickness), 0));
    }

    double friction() const { return static_cast<double>(m_cloth->m_cfg.kDF); }  // times the obstacle's 1

    // Returns the distance down the slope (m) of the node that moved farthest, or least far.
    double farthest(const std::vector<float>& before, bool least) const
    {
        double found = least ? 1e9 : -1e9;
        for (int i = 0; i < m_cloth->m_nodes.size(); ++i)
        {
            const double way = static_cast<double>(m_cloth->m_nodes[i].m_x.x()) -
                               static_cast<double>(before[3 * static_cast<std::size_t>(i)]);
            found = least ? std::min(found, way) : std::max(found, way);
        }
        return found;
    }
};

// Returns the kinetic and potential energy of the nodes, J.
double energyOf(const btSoftBody& body)
{
    double energy = 0;
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        const btSoftBody::Node& node = body.m_nodes[i];
        const double mass = 1 / static_cast<double>(node.m_im);
        energy += mass * (0.5 * static_cast<double>(node.m_v.length2()) + kGravity * static_cast<double>(node.m_x.y()));
    }
    return energy;
}

struct Fall
{
    const char* m_shape;
    btScalar m_height;  // m, above the obstacle's middle
};

class Energy : public testing::TestWithParam<Fall>
{
};
}  // namespace

class Friction : public BackendTest
{
};

TEST_P(Friction, SticksBelowTheAngle)
{
    for (const bool springs : {false, true})
    {
        Slope slope(GetParam().m_settings, springs);
        slope.lean(0.97 * std::atan(slope.friction()));
        const std::vector<float> before = positionsOf(*slope.m_cloth);
        slope.m_world.step(60);
        EXPECT_LT(slope.farthest(before, false), 1e-4) << "springs " << springs;
    }
}

// The cloth slides above the angle, like a block, with the acceleration g (sin - friction cos).
TEST_P(Friction, SlidesAboveTheAngle)
{
    for (const bool springs : {false, true})
    {
        Slope slope(GetParam().m_settings, springs);
        const double angle = 1.2 * std::atan(slope.friction()), time = 60 * static_cast<double>(kDt);
        slope.lean(angle);
        const std::vector<float> before = positionsOf(*slope.m_cloth);
        slope.m_world.step(60);
        const double way = 0.5 * kGravity * (std::sin(angle) - slope.friction() * std::cos(angle)) * time * time;
        EXPECT_NEAR(slope.farthest(before, true), way, 0.05 * way) << "springs " << springs;
        EXPECT_NEAR(slope.farthest(before, false), way, 0.05 * way) << "springs " << springs;
    }
}

// The way that gravity takes a node in a step, 2.7 mm, is longer than most of these thicknesses.
TEST_P(Friction, ThinClothSlidesAsFarAsThickCloth)
{
    const double angle = 0.05, time = 30 * static_cast<double>(kDt);
    for (const btScalar thickness : {btScalar(0.02), btScalar(0.002), btScalar(0.001), btScalar(0.0005)})
    {
        for (const btScalar speed : {btScalar(0), btScalar(1)})
        {
            for (const btScalar friction : {btScalar(0), btScalar(0.02)})
            {
                Slope slope(GetParam().m_settings, true);
                slope.setThickness(thickness);
                slope.m_cloth->m_cfg.kDF = friction;
                slope.m_world.step(2);
                slope.m_cloth->setVelocity(btVector3(speed, 0, 0));
                slope.lean(angle);
                const std::vector<float> before = positionsOf(*slope.m_cloth);
                slope.m_world.step(30);
                const double held = static_cast<double>(friction) * std::cos(angle);
                const double way =
                    static_cast<double>(speed) * time + 0.5 * kGravity * (std::sin(angle) - held) * time * time;
                SCOPED_TRACE(testing::Message() << thickness << " m, " << speed << " m/s, friction " << friction);
                EXPECT_NEAR(slope.farthest(before, true), way, 0.05 * way);
                EXPECT_NEAR(slope.farthest(before, false), way, 0.05 * way);
            }
        }
    }
}

namespace
{
constexpr double kInclineFriction = 0.4;

// Returns how far (m) the nodes of a cloth of 33 x 33 slide down an inclined mesh in 600 steps, or in 60 above the
// friction angle: the least and the most. share: of the friction angle. The cloth starts at rest on the mesh.
std::pair<double, double> slideOnIncline(const Settings& settings, double share)
{
    Plugin plugin(settings);
    DropWorld world(&plugin);
    MeshShape shape(makeBox(12.0f, 0.4f, 6.0f));
    ClothSpec spec;
    spec.m_nodes = 33;
    spec.m_damping = 0;
    spec.m_centre = btVector3(btScalar(-4), btScalar(0.2 + kThickness), 0);
    btSoftBody& cloth = world.addCloth(spec);
    cloth.m_cfg.kDF = btScalar(kInclineFriction);
    const double angle = share * std::atan(kInclineFriction);
    const btTransform turn(btQuaternion(btVector3(0, 0, 1), btScalar(-angle)));
    world.addObstacle(shape.shape(), turn);
    cloth.transform(turn);
    const std::vector<float> before = positionsOf(cloth);
    world.step(share < 1 ? 600 : 60);
    const std::vector<float> after = positionsOf(cloth);
    double least = 1e9, most = -1e9;
    for (std::size_t i = 0; i < before.size(); i += 3)
    {
        const double way = (static_cast<double>(after[i]) - static_cast<double>(before[i])) / std::cos(angle);
        least = std::min(least, way);
        most = std::max(most, way);
    }
    return {least, most};
}
}  // namespace

TEST(Incline, ClothHoldsStillBelowTheAngle)
{
    const auto [least, most] = slideOnIncline(hostSettings(), 0.95);
    EXPECT_GT(least, -1e-4);
    EXPECT_LT(most, 1e-4);
}

TEST(Incline, ClothSlidesLikeABlockAboveTheAngle)
{
    const double friction = kInclineFriction, angle = 1.2 * std::atan(friction), time = 60 * static_cast<double>(kDt);
    const double way = 0.5 * kGravity * (std::sin(angle) - friction * std::cos(angle)) * time * time;
    const auto [least, most] = slideOnIncline(hostSettings(), 1.2);
    EXPECT_NEAR(least, way, 0.05 * way);
    EXPECT_NEAR(most, way, 0.05 * way);
}

INSTANTIATE_TEST_SUITE_P(Backend, Friction, testing::ValuesIn(allBackends()), backendName);

// Nodes without springs or damping: kinetic and potential energy are all there is, and free fall by Bullet's steps only
// loses some. What grows comes from contacts. All that they may do is bring a node that came too near back to its
// place, without speed, by a tenth of the thickness a step.
TEST_P(Energy, NeverGrowsByContacts)
{
    Plugin plugin(hostSettings());
    DropWorld world(&plugin);
    TriangleMesh mesh;
    ASSERT_TRUE(makeShape(GetParam().m_shape, mesh));
    MeshShape shape(mesh);
    world.addObstacle(shape.shape());
    ClothSpec spec;
    spec.m_springs = false;
    spec.m_damping = 0;
    spec.m_centre = btVector3(btScalar(0.03), GetParam().m_height, btScalar(0.02));
    btSoftBody& cloth = world.addCloth(spec);
    double last = energyOf(cloth), grown = 0;
    std::size_t inContact = 0;
    for (int step = 0; step < 150; ++step)
    {
        world.step();
        const double energy = energyOf(cloth);
        grown = std::max(grown, energy - last);
        last = energy;
        inContact += plugin.statistics().m_contacts > 0;
    }
    EXPECT_GT(inContact, 30u);
    EXPECT_LT(grown, kGravity * 0.1 * kThickness / cloth.m_nodes.size()) << "J in a step, of 1 kg";
}

INSTANTIATE_TEST_SUITE_P(Falls, Energy,
                         testing::Values(Fall{"sphere", btScalar(1.1)}, Fall{"box", btScalar(0.6)},
                                         Fall{"stairs", btScalar(1.2)}, Fall{"torus", btScalar(0.5)}),
                         [](const testing::TestParamInfo<Fall>& test) { return std::string(test.param.m_shape); });
}  // namespace drape::test
