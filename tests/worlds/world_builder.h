// Builds random worlds from a seed and modifiers: the steps that the kinds of worlds share.
//
// Numbers are drawn in a fixed order, which is part of what a seed means: another order makes other
// worlds of the seeds that were reported. A function that draws several numbers gives their order.
#pragma once

#include "tests/worlds/modifiers.h"
#include "tests/worlds/world.h"
#include "tests/worlds/world_meshes.h"

namespace drape::test
{
struct DropSpec
{
    double m_size;         // m, along x; z by the number of nodes
    double m_height;       // m, of the cloth's middle
    int m_nodes = 0;       // along either side; 0: random
    bool m_mayFly = true;  // kFast may throw it
};

class WorldBuilder
{
public:
    WorldBuilder(World& world, std::uint64_t randomSeed, std::uint32_t modifiers);

    bool has(Modifier modifier) const { return (m_modifiers & modifier) != 0; }
    WorldRandom& random() { return m_random; }
    World& world() { return m_world; }
    double friction() const { return m_friction; }
    double thickness() const { return m_world.m_clothMargin + m_world.m_obstacleMargin; }
    // Room between an obstacle's top and the cloth above it, m.
    double lift() const { return 2.2 * thickness(); }
    // Obstacles that are added from now on rest also with kKinematic.
    void keepObstacles() { m_obstaclesMayMove = false; }

    // Adds an obstacle at rest and applies the modifiers that concern obstacles.
    WorldObstacle& addObstacle(const TriangleMesh& mesh, const btTransform& pose = btTransform::getIdentity(),
                               bool mayMove = true);
    // Adds a wide floor whose middle is at that height.
    void addFloor(double height, double width);
    // Adds a kinematic obstacle with a motion of its own, which starts at motion(0). Modifiers do not change it.
    WorldObstacle& addMoving(const TriangleMesh& mesh, const std::function<btTransform(double)>& motion);

    // Adds a random cloth at a random angle, and more cloths with kMultiple; returns the first one.
    btSoftBody& drop(const DropSpec& spec);
    // Applies the modifiers that concern cloths.
    void style(btSoftBody& body, bool mayFly = true);
    // Draws z, y, x, the angle and the axis of a pose, in this order.
    btTransform randomPose(const Range& angle, const Range& x, const Range& y, const Range& z);

private:
    void styleMasses(btSoftBody& body);
    void styleForces(btSoftBody& body);
    void styleIterations(btSoftBody& body);
    void addFreeNodes(btSoftBody& body);
    void pin(btSoftBody& body);
    void throwCloth(btSoftBody& body);
    std::function<btTransform(double)> randomMotion(const btTransform& pose, const btTransform& offset);

    World& m_world;
    WorldRandom m_random;
    std::uint32_t m_modifiers;
    double m_friction = .5;
    bool m_obstaclesMayMove = true;
};
}  // namespace drape::test
