#include "drape/soft_body_solver.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_plugin/adapter/closing_pass.h"
#include "bullet_plugin/adapter/collision_step.h"
#include "bullet_plugin/adapter/contact_writer.h"
#include "bullet_plugin/adapter/plugin_state.h"
#include "kernels/shared/contact.h"

namespace drape
{
namespace
{
class Stopwatch
{
public:
    // Milliseconds since the last call or the start.
    double lapMs()
    {
        const Clock::time_point now = Clock::now();
        const double ms = std::chrono::duration<double, std::milli>(now - m_last).count();
        m_last = now;
        return ms;
    }

private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point m_last = Clock::now();
};

bool finite(const btVector3& v)
{
    return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z());
}

// Widens the bounds, which the broad phase reads next, to the whole motion of the step plus the reach of a contact.
// Bullet's own bounds come from the node tree of the step before and lag behind fast cloth, which then has no pair when
// it needs one.
void coverMotion(btSoftBody& body, btScalar reach)
{
    btVector3 low(SIMD_INFINITY, SIMD_INFINITY, SIMD_INFINITY), high = -low;
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        const btSoftBody::Node& node = body.m_nodes[i];
        if (!finite(node.m_x) || !finite(node.m_q)) continue;
        low.setMin(node.m_x);
        low.setMin(node.m_q);
        high.setMax(node.m_x);
        high.setMax(node.m_q);
    }
    if (low.x() > high.x()) return;
    const btVector3 margin(reach, reach, reach);
    body.m_bounds[0].setMin(low - margin);
    body.m_bounds[1].setMax(high + margin);
}

int countSoft(const std::vector<BodyContacts>& bodies)
{
    int count = 0;
    for (const BodyContacts& body : bodies)
        for (const StepContact& contact : body.m_contacts)
            if (contact.m_kind != DRAPE_NODE_FACE && contact.violated()) ++count;
    return count;
}

void writeContacts(ContactWriter& writer, std::vector<BodyContacts>& bodies)
{
    writer.reset(countSoft(bodies));
    for (BodyContacts& body : bodies)
    {
        body.m_softContactsBefore = body.m_body->m_scontacts.size();
        writer.write(*body.m_body, body.m_contacts);
    }
}
}  // namespace

SoftBodySolver::SoftBodySolver(Plugin& plugin) : m_state(plugin.state())
{
    m_state->addSolver(this);
}

SoftBodySolver::~SoftBodySolver()
{
    m_state->removeSolver(this);
}

void SoftBodySolver::predictMotion(btScalar dt)
{
    m_state->dropNotes(this);  // of a dispatch that no solve followed
    btDefaultSoftBodySolver::predictMotion(dt);
    if (!m_state->ready()) return;
    // The mesh's own bounds hold its margin; the activation distance beyond the thickness is shared out alike.
    const btScalar reach = 1 + btScalar(m_state->settings().m_activation);
    for (int i = 0; i < m_softBodySet.size(); ++i)
        if (m_softBodySet[i]->isActive())
            coverMotion(*m_softBodySet[i], reach * m_softBodySet[i]->getCollisionShape()->getMargin());
}

void SoftBodySolver::solveConstraints(btScalar dt)
{
    CollisionStep step(*m_state);
    ContactWriter writer;
    const bool ready = m_state->ready();
    StepStatistics& statistics = m_state->m_statistics;
    try
    {
        if (ready)
        {
            Stopwatch watch;
            step.begin(m_state->takeNotes(this));
            const double beginMs = watch.lapMs();
            step.finish();
            watch.lapMs();
            writeContacts(writer, step.bodies());
            statistics.m_writeMs = watch.lapMs();
            statistics.m_uploadMs = std::max(statistics.m_uploadMs, beginMs);  // mirrors and copying included
        }
    }
    catch (const std::exception& exception)
    {
        step.bodies().clear();
        m_state->fail("drape::SoftBodySolver::solveConstraints", exception.what());
    }

    btDefaultSoftBodySolver::solveConstraints(dt);

    if (!ready) return;
    Stopwatch watch;
    for (BodyContacts& body : step.bodies())
    {
        ContactWriter::removeSoftContacts(*body.m_body, body.m_softContactsBefore);
        closeContacts(*body.m_body, body.m_contacts, body.m_limit);
    }
    statistics.m_finishMs = watch.lapMs();
}
}  // namespace drape
