// Ropes, and other links without faces, for the tests of links that collide.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "bullet_plugin/adapter/mirrors/solid_links.h"
#include "oracle/crossings.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"

namespace drape::test
{
// Returns the body's faces, then its colliding links as triangles that have their second node twice.
inline TriangleMesh meshWithLinks(const btSoftBody& body)
{
    TriangleMesh mesh = meshOf(body);
    SolidLinks links;
    links.read(body, mesh.m_triangles);
    for (std::size_t i = 0; i < links.nodes().size(); i += 2)
        mesh.m_triangles.insert(mesh.m_triangles.end(), {links.nodes()[i], links.nodes()[i + 1], links.nodes()[i + 1]});
    return mesh;
}

// A body with the independent check of its nodes, faces and links against one obstacle at rest.
class CheckedBody
{
public:
    CheckedBody(const TriangleMesh& obstacle, const btSoftBody& body)
        : m_body(body), m_meter(obstacle, meshWithLinks(body)), m_crossings(obstacle, positionsOf(body))
    {
    }

    // Fails the test where a step ended with anything on the wrong side, or intersecting, or a node went through.
    void look(int step)
    {
        const std::vector<float> positions = positionsOf(m_body);
        const StepMeasure measure = m_meter.measure(positions.data());
        m_crossings.follow(positions);
        m_hash = hashOf(m_body, m_hash);
        m_leastGap = std::min(m_leastGap, measure.m_gapMin);
        EXPECT_EQ(measure.m_invalidNodes, 0u) << "step " << step;
        EXPECT_EQ(measure.nodesBelow(), 0u) << "step " << step;
        EXPECT_EQ(measure.m_intersectingPairs, 0u) << "step " << step;
        EXPECT_EQ(m_crossings.nodes(), 0u) << "step " << step;
    }

    double m_leastGap = 1e300;  // m, of all steps
    std::uint64_t m_hash = kHashStart;

private:
    const btSoftBody& m_body;
    PenetrationMeter m_meter;
    Crossings m_crossings;
};

// Sets the margin, iterations and friction of these tests' bodies.
inline void style(btSoftBody& body, btScalar mass)
{
    body.setTotalMass(mass);
    body.getCollisionShape()->setMargin(kMargin);
    body.m_cfg.piterations = 4;
    body.m_cfg.kDP = btScalar(0.02);
    body.m_cfg.kDF = btScalar(0.6);
}

// Makes a rope of `links` links between two points, 0.1 kg a metre.
inline std::unique_ptr<btSoftBody> makeRope(btSoftBodyWorldInfo& info, const btVector3& from, const btVector3& to,
                                            int links, int fixedEnds = 0)
{
    std::unique_ptr<btSoftBody> rope(btSoftBodyHelpers::CreateRope(info, from, to, links - 1, fixedEnds));
    style(*rope, btScalar(0.1) * (to - from).length());
    return rope;
}

// A world with one obstacle at rest and bodies that it does not own.
class RopeWorld
{
public:
    RopeWorld(const TriangleMesh& obstacle, const Settings& settings)
        : m_obstacle(obstacle), m_plugin(settings), m_shape(obstacle), m_world(&m_plugin)
    {
        m_object = &m_world.addObstacle(m_shape.shape());
    }
    ~RopeWorld()
    {
        for (const auto& body : m_bodies)
            m_world.world().removeSoftBody(body.get());
    }

    btSoftBodyWorldInfo& info() { return m_world.world().getWorldInfo(); }
    btSoftBody& add(std::unique_ptr<btSoftBody> body)
    {
        m_bodies.push_back(std::move(body));
        m_world.world().addSoftBody(m_bodies.back().get());
        m_checks.emplace_back(m_obstacle, *m_bodies.back());
        return *m_bodies.back();
    }
    // Steps, and checks every body after each step. Stops at the first failure.
    void run(int steps)
    {
        for (int i = 0; i < steps && !testing::Test::HasFailure(); ++i)
        {
            m_world.step();
            m_status |= m_plugin.statistics().m_status;
            m_mostContacts = std::max(m_mostContacts, m_plugin.statistics().m_contacts);
            for (CheckedBody& check : m_checks)
                check.look(m_step);
            ++m_step;
        }
        EXPECT_EQ(m_status, std::uint32_t(kStepGood));
    }
    std::uint64_t hash() const
    {
        std::uint64_t hash = kHashStart;
        for (const CheckedBody& check : m_checks)
            hash = (hash ^ check.m_hash) * 0x100000001b3ull;
        return hash;
    }
    double leastGap() const
    {
        double least = 1e300;
        for (const CheckedBody& check : m_checks)
            least = std::min(least, check.m_leastGap);
        return least;
    }
    std::size_t contactsOfKind(int nodes) const  // counts contacts with so many nodes
    {
        const std::vector<ContactInfo> contacts = m_plugin.contacts();
        return std::size_t(std::count_if(contacts.begin(), contacts.end(),
                                         [nodes](const ContactInfo& contact) {
                                             return nodes == int(std::count_if(contact.m_nodes, contact.m_nodes + 3,
                                                                               [](int node) { return node >= 0; }));
                                         }));
    }

    TriangleMesh m_obstacle;
    Plugin m_plugin;
    MeshShape m_shape;
    DropWorld m_world;
    btCollisionObject* m_object;
    std::size_t m_mostContacts = 0;
    std::uint32_t m_status = 0;

private:
    std::vector<std::unique_ptr<btSoftBody>> m_bodies;
    std::vector<CheckedBody> m_checks;
    int m_step = 0;
};
}  // namespace drape::test
