#include "examples/window/simulation.h"

#include <algorithm>

namespace drape::window
{
namespace
{
// Speed towards the mouse per metre of distance, 1/s, and its maximum, m/s.
constexpr btScalar kPull = 12, kFastest = 6;
}  // namespace

void Simulation::start(const ClothScene& scene, bool byBullet)
{
    if (m_byBullet)
        (void)m_world.release();
    else
        m_world.reset();
    m_scene = scene;
    m_byBullet = byBullet;
    m_held = Held();
    m_steps = 0;
    m_history.fill(0);
    if (byBullet)
        m_world = std::make_unique<SceneWorld>(m_scene, BulletCollision::NodesAndFaces);
    else
        m_world = std::make_unique<SceneWorld>(m_scene, m_plugin);
}

void Simulation::pullHeld()
{
    if (!m_held.any()) return;
    btSoftBody& body = m_world->cloth(std::size_t(m_held.m_cloth));
    btSoftBody::Node& node = body.m_nodes[m_held.m_node];
    const btVector3 velocity = (m_held.m_target - node.m_x) * kPull;
    const btScalar speed = velocity.length();
    node.m_v = speed > kFastest ? velocity * (kFastest / speed) : velocity;
    body.activate();
}

void Simulation::step(bool records)
{
    m_plugin.recordContacts(records);
    pullHeld();
    m_stepMs = 0;
    for (int part = 0; part < m_scene.m_stepsPerFrame; ++part)
        m_stepMs += m_world->step(m_scene.m_frameTime / m_scene.m_stepsPerFrame);
    ++m_steps;
    std::rotate(m_history.begin(), m_history.begin() + 1, m_history.end());
    m_history.back() = float(m_stepMs);
}

double Simulation::meanStepMs() const
{
    const int count = std::min(m_steps, int(m_history.size()));
    double sum = 0;
    for (int i = 0; i < count; ++i)
        sum += double(m_history[m_history.size() - 1 - std::size_t(i)]);
    return count > 0 ? sum / count : 0;
}
}  // namespace drape::window
