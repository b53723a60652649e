#include "tests/worlds/skirts.h"

#include <algorithm>
#include <cmath>

#include <BulletSoftBody/btSoftBodyHelpers.h>

#include "scenes/mesh_builder.h"
#include "scenes/shapes.h"

namespace drape::test
{
namespace
{
constexpr double kPi = 3.14159265358979;
constexpr double kRadius = .3;                           // m, of the body
constexpr double kMargin = .005;                         // m, of cloth and body
constexpr double kMass = .4;                             // kg
constexpr int kRings = 14;                               // rings of the skirt, below the waist
constexpr double kRingHeight = .04, kWaistHeight = .05;  // m
constexpr double kStepsPerSecond = 60;

enum BodyShape
{
    kRound,
    kFlat,  // narrower along z
    kPost   // a cylinder with round ends
};

struct Skirt
{
    int m_segments;
    double m_radiusX, m_radiusZ;  // m, at the waist
    double m_flare;               // m, wider per ring
};

// The motion of the body; at() gives its pose after step number `step`, from 0 on.
struct Motion
{
    int m_firstStep = 0;
    int m_turnSteps = 0;  // half a turn takes so many steps; 0: no turn
    double m_speed = 0;   // m/s along x, for a second
    btTransform at(int step) const
    {
        const double done = step - m_firstStep + 1;
        const double turn = m_turnSteps > 0 ? kPi * std::clamp(done / m_turnSteps, 0., 1.) : 0;
        return turned(btVector3(0, 1, 0), turn, m_speed * std::clamp(done / kStepsPerSecond, 0., 1.));
    }
};

TriangleMesh bodyMesh(BodyShape shape)
{
    TriangleMesh mesh = makeSphere(static_cast<float>(kRadius), 3);
    for (std::size_t i = 0; i < mesh.m_positions.size(); i += 3)
    {
        float* p = &mesh.m_positions[i];
        p[1] *= 2;
        if (shape == kFlat) p[2] *= .8f;
        const float distance = std::hypot(p[0], p[2]);
        if (shape != kPost || std::fabs(p[1]) > .5f || distance < 1e-4f) continue;
        const float factor = static_cast<float>(kRadius) / distance;
        p[0] *= factor;
        p[2] *= factor;
    }
    return mesh;
}

TriangleMesh skirtMesh(const Skirt& skirt)
{
    TriangleMesh mesh;
    for (int ring = 0; ring <= kRings; ++ring)
        for (int i = 0; i < skirt.m_segments; ++i)
        {
            const double angle = 2 * kPi * i / skirt.m_segments;
            addVertex(mesh, (skirt.m_radiusX + skirt.m_flare * ring) * std::cos(angle),
                      kWaistHeight - kRingHeight * ring, (skirt.m_radiusZ + skirt.m_flare * ring) * std::sin(angle));
        }
    for (int ring = 0; ring < kRings; ++ring)
        for (int i = 0; i < skirt.m_segments; ++i)
        {
            const int a = ring * skirt.m_segments, next = (i + 1) % skirt.m_segments, below = a + skirt.m_segments;
            addQuad(mesh, a + i, a + next, below + next, below + i);
        }
    return mesh;
}

std::unique_ptr<btSoftBody> clothOf(World& world, const TriangleMesh& mesh)
{
    const std::vector<btScalar> places(mesh.m_positions.begin(), mesh.m_positions.end());
    std::unique_ptr<btSoftBody> body(
        btSoftBodyHelpers::CreateFromTriMesh(world.bullet().getWorldInfo(), places.data(), mesh.m_triangles.data(),
                                             static_cast<int>(mesh.triangleCount()), false));
    body->getCollisionShape()->setMargin(btScalar(kMargin));
    body->generateBendingConstraints(2);
    body->setTotalMass(btScalar(kMass), false);
    body->m_cfg.piterations = 8;
    return body;
}

void buildSkirt(World& world, BodyShape shape, const Skirt& skirt, const Motion& motion, int frames)
{
    world.m_obstacleMargin = kMargin;
    ObstacleSpec spec;
    spec.m_kinematic = true;
    const auto stepAt = [](double time) { return static_cast<int>(std::lround(time * kStepsPerSecond)) - 1; };
    world.addObstacle(bodyMesh(shape), spec).m_motion = [=](double time) { return motion.at(stepAt(time)); };
    WorldCloth& cloth = world.addCloth(clothOf(world, skirtMesh(skirt)));
    std::vector<btVector3> waist;
    for (int i = 0; i < skirt.m_segments; ++i)
    {
        cloth.m_body->setMass(i, 0);
        waist.push_back(cloth.m_body->m_nodes[i].m_x);
    }
    cloth.m_drive = [=](double time, btSoftBody& body)
    {
        const btTransform before = motion.at(stepAt(time) - 1), after = motion.at(stepAt(time));
        for (int i = 0; i < static_cast<int>(waist.size()); ++i)
        {
            const btVector3 &at = waist[static_cast<std::size_t>(i)], from = before * at;
            body.m_nodes[i].m_x = from;
            body.m_nodes[i].m_v = (after * at - from) * btScalar(kStepsPerSecond);
        }
    };
    world.m_frames = frames;
}

// Takes the next digit off a number whose digits have different bases.
template <std::size_t Count, typename Value>
Value take(std::uint64_t& number, const Value (&choices)[Count])
{
    const Value value = choices[number % Count];
    number /= Count;
    return value;
}

constexpr int kTurnSteps[] = {8, 10, 12, 14, 16, 20};
constexpr double kFlares[] = {0, .003, .01};
constexpr double kClearances[] = {.015, .025};
constexpr int kSegments[] = {20, 28, 40};
constexpr BodyShape kBodies[] = {kRound, kFlat, kPost};

constexpr int kDashTurnSteps[] = {30, 20, 15, 12, 10, 8, 6, 4, 2};
constexpr double kDashSpeeds[] = {1, 3, 5, 8, 12, 20};
constexpr std::size_t kTurns = sizeof kDashTurnSteps / sizeof *kDashTurnSteps;
constexpr std::size_t kDashes = kTurns + sizeof kDashSpeeds / sizeof *kDashSpeeds;
}  // namespace

std::size_t skirtTurnCount()
{
    return 6 * 3 * 2 * 3 * 3;
}

void buildSkirtTurn(World& world, std::uint64_t setting)
{
    const int turnSteps = take(setting, kTurnSteps);
    const double flare = take(setting, kFlares), clearance = take(setting, kClearances);
    const int segments = take(setting, kSegments);
    const BodyShape shape = take(setting, kBodies);
    const double radiusZ = kRadius * (shape == kFlat ? .8 : 1);
    buildSkirt(world, shape, {segments, kRadius + clearance, radiusZ + clearance, flare}, {30, turnSteps, 0}, 200);
}

std::size_t skirtDashCount()
{
    return 2 * kDashes;
}

void buildSkirtDash(World& world, std::uint64_t setting)
{
    const std::size_t way = setting % kDashes;
    Motion motion;
    motion.m_firstStep = 60;
    if (way < kTurns)
        motion.m_turnSteps = kDashTurnSteps[way];
    else
        motion.m_speed = kDashSpeeds[way - kTurns];
    const bool wide = setting >= kDashes;
    buildSkirt(world, kFlat, {28, .32, .26, wide ? .012 : .003}, motion, 360);
}
}  // namespace drape::test
