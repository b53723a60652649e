#include "tests/worlds/world_builder.h"

#include <algorithm>
#include <cmath>

namespace drape::test
{
WorldBuilder::WorldBuilder(World& world, std::uint64_t randomSeed, std::uint32_t modifiers)
    : m_world(world), m_random(randomSeed), m_modifiers(modifiers)
{
    if (has(kMargin))
    {
        world.m_clothMargin = m_random.logWithin(1e-4, .1);
        world.m_obstacleMargin = m_random.chance(.3) ? 0 : m_random.logWithin(1e-4, .1);
    }
    if (has(kTime))
    {
        world.m_stepping = static_cast<Stepping>(1 + m_random.below(3));
        world.m_fixedDt = world.m_stepping == Stepping::FixedSteps ? 1. / 240 : 1. / 120;
        world.m_mostSubsteps = 8;
    }
    if (has(kFriction)) m_friction = m_random.chance(.5) ? 0 : 1;
}

btTransform WorldBuilder::randomPose(const Range& angle, const Range& x, const Range& y, const Range& z)
{
    const double placeZ = m_random.within(z), placeY = m_random.within(y), placeX = m_random.within(x);
    const double turn = m_random.within(angle);
    return turned(m_random.direction(), turn, placeX, placeY, placeZ);
}

std::function<btTransform(double)> WorldBuilder::randomMotion(const btTransform& pose, const btTransform& offset)
{
    const btVector3 axis = m_random.direction();
    const double swing = m_random.within(.5, 6), amplitude = m_random.within(0, .3), speed = m_random.within(-3, 3);
    const double rocking = m_random.within(.5, 8);
    const btVector3 way = m_random.direction();
    const bool rocks = m_random.chance(.5);
    return [=](double time)
    {
        const double angle = rocks ? .4 * std::sin(rocking * time) : speed * time;
        btTransform now(btQuaternion(axis, btScalar(angle)),
                        pose.getOrigin() + way * btScalar(amplitude * std::sin(swing * time)));
        now.setBasis(now.getBasis() * pose.getBasis());
        return now * offset;
    };
}

WorldObstacle& WorldBuilder::addObstacle(const TriangleMesh& mesh, const btTransform& pose, bool mayMove)
{
    TriangleMesh unscaled = mesh;
    double factors[3] = {1, 1, 1};
    if (has(kScaled))
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const double size = m_random.logWithin(.2, 5);
            factors[axis] = size * (m_random.chance(.3) ? -1 : 1);
            for (std::size_t i = axis; i < unscaled.m_positions.size(); i += 3)
                unscaled.m_positions[i] = static_cast<float>(unscaled.m_positions[i] / factors[axis]);
        }
    const btVector3 scaling{btScalar(factors[0]), btScalar(factors[1]), btScalar(factors[2])};
    ObstacleSpec spec;
    spec.m_scaling = has(kScaled) ? &scaling : nullptr;
    spec.m_kinematic = has(kKinematic) && mayMove && m_obstaclesMayMove;
    spec.m_friction = m_friction;
    if (has(kCompound)) spec.m_compoundDepth = 1 + m_random.below(4);
    btTransform inCompounds = btTransform::getIdentity();
    for (int level = 1; level < spec.m_compoundDepth; ++level)
        inCompounds = compoundPose(level) * inCompounds;
    const btTransform offset = inCompounds.inverse();
    spec.m_pose = pose * offset;
    WorldObstacle& obstacle = m_world.addObstacle(unscaled, spec);
    if (spec.m_kinematic) obstacle.m_motion = randomMotion(pose, offset);
    return obstacle;
}

void WorldBuilder::addFloor(double height, double width)
{
    addObstacle(boxMesh(width, .2, width), shifted(0, height, 0), false);
}

WorldObstacle& WorldBuilder::addMoving(const TriangleMesh& mesh, const std::function<btTransform(double)>& motion)
{
    ObstacleSpec spec;
    spec.m_kinematic = true;
    spec.m_friction = m_friction;
    spec.m_pose = motion(0);
    WorldObstacle& obstacle = m_world.addObstacle(mesh, spec);
    obstacle.m_motion = motion;
    return obstacle;
}

btSoftBody& WorldBuilder::drop(const DropSpec& spec)
{
    const double size = spec.m_size;
    int nodesX = spec.m_nodes, nodesZ = spec.m_nodes;
    if (spec.m_nodes == 0)
    {
        nodesX = 6 + m_random.below(has(kFineCloth) ? 34 : 14);
        nodesZ = std::max(3, static_cast<int>(nodesX * m_random.within(.4, 1.2)));
    }
    const bool bending = m_random.chance(.7);
    const btTransform pose = randomPose({-.4, .4}, {-.2, .2}, spec.m_height, {-.2, .2});
    WorldCloth& cloth =
        m_world.addGrid({nodesX, nodesZ, size, size * static_cast<double>(nodesZ) / nodesX, pose, bending});
    style(*cloth.m_body, spec.m_mayFly);
    if (!has(kMultiple)) return *cloth.m_body;
    const int more = 1 + m_random.below(3);
    for (int i = 0; i < more; ++i)
    {
        const int nodes = 4 + m_random.below(8);
        const btTransform above = randomPose({-.3, .3}, {-.4, .4}, spec.m_height + .35 * (i + 1), {-.4, .4});
        const double sizeZ = size * m_random.within(.2, .8), sizeX = size * m_random.within(.2, .8);
        style(*m_world.addGrid({nodes, nodes, sizeX, sizeZ, above}).m_body, spec.m_mayFly);
    }
    return *cloth.m_body;
}

void WorldBuilder::style(btSoftBody& body, bool mayFly)
{
    if (has(kStiff))
    {
        body.m_materials[0]->m_kLST = btScalar(m_random.chance(.5) ? 1 : m_random.logWithin(.01, 1));
        body.m_cfg.piterations = 1 + m_random.below(30);
    }
    styleMasses(body);
    styleForces(body);
    styleIterations(body);
    if (has(kFreeNodes) && body.m_nodes.size() > 4) addFreeNodes(body);
    if (has(kPins)) pin(body);
    if (has(kFast) && mayFly) throwCloth(body);
}

// The iterations are drawn between the modifiers of masses; the seeds keep this order.
void WorldBuilder::styleMasses(btSoftBody& body)
{
    const int count = body.m_nodes.size();
    if (has(kMasses))
    {
        const int how = m_random.below(3);
        for (int i = 0; i < count; ++i)
            body.setMass(i, btScalar(how == 0     ? m_random.logWithin(1e-6, 1e3)
                                     : how == 1   ? 1e-6
                                     : i % 7 == 0 ? 1e3
                                                  : 1e-3));
    }
    if (has(kDriftIterations)) body.m_cfg.diterations = 1 + m_random.below(3);
    if (has(kVelocityIterations)) body.m_cfg.viterations = 1 + m_random.below(5);
    if (has(kLight))
        for (int i = 0; i < count; ++i)
            body.setMass(i, btScalar(1e-6));
    const Modifier ratios[3] = {kRatio10, kRatio100, kRatio1000};
    for (int power = 1; power <= 3; ++power)
        if (has(ratios[power - 1]))
            for (int i = 0; i < count; ++i)
                body.setMass(i, btScalar((m_random.chance(.1) ? std::pow(10., power) : 1) / count));
}

void WorldBuilder::styleForces(btSoftBody& body)
{
    if (has(kAero))
    {
        body.m_cfg.aeromodel = static_cast<btSoftBody::eAeroModel::_>(m_random.below(6));
        body.m_cfg.kLF = btScalar(m_random.within(0, .1));
        body.m_cfg.kDG = btScalar(m_random.within(0, .05));
        const btScalar speed = btScalar(m_random.within(0, 20));
        body.setWindVelocity(m_random.direction() * speed);
    }
    if (has(kFriction)) body.m_cfg.kDF = btScalar(m_random.chance(.5) ? 0 : 1);
    if (!has(kDamping)) return;
    body.m_cfg.kDP = btScalar(m_random.within(0, .3));
    body.m_cfg.timescale = btScalar(m_random.chance(.5) ? 1 : m_random.within(.2, 2));
    body.m_cfg.kVCF = btScalar(m_random.within(.5, 1.5));
}

void WorldBuilder::styleIterations(btSoftBody& body)
{
    if (!has(kIterations)) return;
    switch (m_random.below(4))
    {
        case 0:
            body.m_cfg.viterations = 1 + m_random.below(5);
            break;
        case 1:
            body.m_cfg.diterations = 1 + m_random.below(3);
            break;
        case 2:
            body.m_cfg.piterations = 1;
            break;
        default:
            body.m_cfg.piterations = 0;
    }
    body.m_cfg.kSRHR_CL = btScalar(.3);
}

void WorldBuilder::addFreeNodes(btSoftBody& body)
{
    const int count = body.m_nodes.size(), more = 3 + m_random.below(6);
    for (int i = 0; i < more; ++i)
    {
        const int at = m_random.below(count);
        const btVector3 place = body.m_nodes[at].m_x + btVector3(0, btScalar(.05 + .02 * i), 0);
        const btScalar mass = 1 / body.m_nodes[at].m_im;  // infinite where nothing moves the node
        body.appendNode(place, mass > 1e5f ? btScalar(1e-3) : mass);
        body.appendLink(at, body.m_nodes.size() - 1);
    }
}

void WorldBuilder::pin(btSoftBody& body)
{
    const int counts[3] = {1, 2, 4}, count = counts[m_random.below(3)];
    for (int i = 0; i < count; ++i)
        body.setMass(m_random.below(body.m_nodes.size()), 0);
}

void WorldBuilder::throwCloth(btSoftBody& body)
{
    btVector3 way = m_random.direction();
    way.setY(-btFabs(way.y()));
    const double speed = m_random.logWithin(3, 200);
    for (int i = 0; i < body.m_nodes.size(); ++i)
        body.m_nodes[i].m_v = way * btScalar(speed);
    if (!m_random.chance(.3)) return;
    for (int i = 0; i < body.m_nodes.size(); ++i)
        body.m_nodes[i].m_v += m_random.direction() * btScalar(speed * .3);
}
}  // namespace drape::test
