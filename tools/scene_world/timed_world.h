// A world of Bullet's that measures how long collision detection takes.
#pragma once

#include <chrono>

#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>

namespace drape
{
class TimedWorld : public btSoftRigidDynamicsWorld
{
public:
    using btSoftRigidDynamicsWorld::btSoftRigidDynamicsWorld;
    void performDiscreteCollisionDetection() override
    {
        const auto start = std::chrono::steady_clock::now();
        btSoftRigidDynamicsWorld::performDiscreteCollisionDetection();
        m_collisionMs = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    }
    // Returns the time of the last step's collision detection.
    double collisionMs() const { return m_collisionMs; }

private:
    double m_collisionMs = 0;
};
}  // namespace drape
