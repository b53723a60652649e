// A cloth over a kinematic obstacle that a test moves as it likes, for the tests of kinematic bodies.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"

namespace drape::test
{
inline btTransform shiftedBy(const btVector3& shift)
{
    return btTransform(btMatrix3x3::getIdentity(), shift);
}

inline btVector3 meanOf(const btSoftBody& cloth)
{
    btVector3 sum(0, 0, 0);
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        sum += cloth.m_nodes[i].m_x;
    return sum / btScalar(cloth.m_nodes.size());
}

// Returns the cloth in the obstacle's frame.
inline std::vector<float> seenFrom(const btTransform& pose, const btSoftBody& cloth)
{
    std::vector<float> positions;
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
    {
        const btVector3 seen = pose.inverse() * cloth.m_nodes[i].m_x;
        for (int axis = 0; axis < 3; ++axis)
            positions.push_back(static_cast<float>(seen[axis]));
    }
    return positions;
}

// A cloth over a kinematic mesh, with the independent check in the mesh's own frame.
class KinematicScene
{
public:
    KinematicScene(const TriangleMesh& mesh, const btTransform& pose, float size, const btVector3& centre,
                   const Settings& settings)
        : m_plugin(settings),
          m_shape(mesh),
          m_world(&m_plugin),
          m_body(m_world.addKinematic(m_shape.shape(), pose)),
          m_cloth(m_world.addCloth(specOf(size, centre))),
          m_meter(mesh, clothSeen())
    {
    }

    void step(const btTransform& pose)
    {
        m_body.setWorldTransform(pose);
        m_world.step();
        m_most = std::max(m_most, m_plugin.statistics().m_contacts);
    }
    // Steps, and expects that nothing is on the wrong side afterwards.
    void checkedStep(const btTransform& pose)
    {
        step(pose);
        const StepMeasure measure = m_meter.measure(seenFrom(pose, m_cloth).data());
        ASSERT_EQ(measure.nodesBelow(), 0u) << measure.m_penetrationMax;
        ASSERT_EQ(measure.m_intersectingPairs, 0u);
        ASSERT_EQ(measure.m_invalidNodes, 0u);
    }

    Plugin m_plugin;
    MeshShape m_shape;
    DropWorld m_world;
    btRigidBody& m_body;
    btSoftBody& m_cloth;
    PenetrationMeter m_meter;
    std::size_t m_most = 0;  // contacts

private:
    static ClothSpec specOf(float size, const btVector3& centre)
    {
        ClothSpec spec;
        spec.m_size = size;
        spec.m_centre = centre;
        return spec;
    }
    TriangleMesh clothSeen() const
    {
        TriangleMesh mesh = meshOf(m_cloth);
        mesh.m_positions = seenFrom(m_body.getWorldTransform(), m_cloth);
        return mesh;
    }
};

class Kinematic : public BackendTest
{
};
}  // namespace drape::test
