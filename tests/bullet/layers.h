// Sheets of cloth above one another, for the tests of cloth with cloth.
#pragma once

#include <algorithm>
#include <vector>

#include "oracle/self_intersections.h"
#include "tests/bullet/drop_world.h"

namespace drape::test
{
// Sheets above one another in a world of their own.
struct Layers
{
    Layers(const Settings& settings, int count, float distance, bool collide = true, int mask = -1)
        : m_plugin(settings), m_world(&m_plugin)
    {
        for (int k = 0; k < count; ++k)
        {
            ClothSpec spec;
            spec.m_nodes = 13;
            spec.m_centre = btVector3(0.01f * btScalar(k), 0.6f + distance * btScalar(k), 0.013f * btScalar(k));
            spec.m_damping = 0;
            m_cloths.push_back(&m_world.addCloth(spec, 1, mask));
            if (collide) m_plugin.setSelfCollision(*m_cloths.back(), true);
        }
    }

    std::vector<float> positions() const
    {
        std::vector<float> all;
        for (const btSoftBody* cloth : m_cloths)
        {
            const std::vector<float> own = positionsOf(*cloth);
            all.insert(all.end(), own.begin(), own.end());
        }
        return all;
    }
    TriangleMesh joined() const
    {
        TriangleMesh mesh;
        mesh.m_positions = positions();
        std::int32_t first = 0;
        for (const btSoftBody* cloth : m_cloths)
        {
            for (const std::int32_t node : meshOf(*cloth).m_triangles)
                mesh.m_triangles.push_back(first + node);
            first += cloth->m_nodes.size();
        }
        return mesh;
    }
    // Counts the pairs of triangles that intersect.
    std::size_t meeting() const { return SelfIntersections(joined()).find(positions()).size(); }
    // Runs steps. Returns the most pairs of triangles that intersect after any of them.
    std::size_t run(int steps)
    {
        SelfIntersections check(joined());
        std::size_t most = 0;
        for (int i = 0; i < steps; ++i)
        {
            m_world.step();
            m_status |= m_plugin.statistics().m_status;
            most = std::max(most, check.find(positions()).size());
        }
        return most;
    }
    btVector3 momentum() const
    {
        btVector3 sum(0, 0, 0);
        for (const btSoftBody* cloth : m_cloths)
            for (int i = 0; i < cloth->m_nodes.size(); ++i)
                sum += cloth->m_nodes[i].m_v / cloth->m_nodes[i].m_im;
        return sum;
    }
    void turnGravityOff()
    {
        m_world.world().setGravity(btVector3(0, 0, 0));
        m_world.world().getWorldInfo().m_gravity.setZero();
    }

    Plugin m_plugin;
    DropWorld m_world;
    std::vector<btSoftBody*> m_cloths;
    std::uint32_t m_status = 0;
};

inline void pin(btSoftBody& cloth)
{
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        cloth.setMass(i, 0);
}

// The app moves all nodes.
inline void move(btSoftBody& cloth, const btVector3& by)
{
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        cloth.m_nodes[i].m_x += by;
}
}  // namespace drape::test
