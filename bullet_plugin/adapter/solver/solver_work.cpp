#include "bullet_plugin/adapter/solver/solver_work.h"

#include "bullet_plugin/adapter/mirrors/solid_links.h"
#include "bullet_plugin/adapter/solver/body_jobs.h"
#include "bullet_plugin/core/float_environment.h"

namespace drape
{
namespace
{
// A gap at which a row never acts, m.
constexpr float kFarAway = 1e18f;

// Returns whether one of up to three nodes is anchored to the object; -1: none. A contact would push the object away
// from a node that goes with it, and the anchor would pull it back.
bool isAnchoredTo(const btSoftBody& body, const btCollisionObject& object, const int nodes[3])
{
    for (int i = 0; i < body.m_anchors.size(); ++i)
    {
        const btSoftBody::Anchor& anchor = body.m_anchors[i];
        if (anchor.m_body == &object && std::count(nodes, nodes + 3, nodeIndex(body, anchor.m_node)) > 0) return true;
    }
    return false;
}
}  // namespace

// Returns the number of nodes of a body whose links the core solves in this step; 0 for others.
std::size_t SoftBodySolver::Work::substepNodes(const btSoftBody& body) const
{
    return isSteppedBody(body) && substepsOf(body) ? static_cast<std::size_t>(body.m_nodes.size()) : 0;
}

// Calls call(body, recorded, threads) for all bodies whose links the core solves. recorded: the cloth with the body's
// recorded paths, null without pairs.
template <class Call>
void SoftBodySolver::Work::forSubsteps(const Bodies& bodies, const Call& call)
{
    const auto sizeOf = [&](std::size_t i) { return substepNodes(*bodies[int(i)]); };
    const auto work = [&](std::size_t i, ThreadTeam* threads)
    {
        const btSoftBody& body = *bodies[int(i)];
        BodyContacts* const contacts = contactsOf(body);
        call(body, contacts ? &contacts->m_contacts : nullptr, threads);
    };
    forBodies(static_cast<std::size_t>(bodies.size()), m_threads, sizeOf, work);
}

// Prepares the steps of all bodies whose links the core solves.
void SoftBodySolver::Work::beginSubsteps(const Bodies& bodies)
{
    m_begun = true;
    forSubsteps(bodies, [this](const btSoftBody& body, ClothContacts* recorded, ThreadTeam* threads)
                { substepsOf(body)->begin(body, recorded, m_state.mirrorOf(body), threads); });
}

// Reads the paths of these bodies, unless they are solved.
void SoftBodySolver::Work::readPaths(const Bodies& bodies)
{
    forSubsteps(bodies,
                [this](const btSoftBody& body, ClothContacts* recorded, ThreadTeam* threads)
                {
                    if (!clothOf(body).m_isSolved) substepsOf(body)->readPaths(body, recorded, threads);
                });
}

// Returns the cloth of a body whose links the core solves.
ClothContacts& SoftBodySolver::Work::clothOf(const btSoftBody& body)
{
    BodyContacts* const contacts = contactsOf(body);
    return contacts ? contacts->m_contacts : substepsOf(body)->alone();
}

// Adds rows for the body's contacts with the meshes of dynamic bodies.
void SoftBodySolver::Work::addDynamicRows(SubstepBody& substeps, const BodyContacts& body)
{
    if (body.m_dynamicContacts.empty()) return;
    const ContactSource& source = m_state.m_found.source();
    for (const DynamicContact& dynamic : body.m_dynamicContacts)
    {
        SolverContact contact = body.m_contacts.resolve(source, *dynamic.m_contact);
        if (isAnchoredTo(*body.m_body, *dynamic.m_body.m_object, contact.m_nodes)) contact.m_gaps.m_start = kFarAway;
        substeps.addRow(dynamic.m_body, m_dt, contact, body.m_contacts.m_nodes, m_supported, m_rigidBodies);
    }
}

// Finds the nodes that cannot give way to dynamic bodies.
void SoftBodySolver::Work::findSupported()
{
    m_supported.clear();
    if (!m_step) return;
    const std::vector<BodyContacts>& bodies = m_step->bodies();
    if (std::all_of(bodies.begin(), bodies.end(),
                    [](const BodyContacts& body) { return body.m_dynamicContacts.empty(); }))
        return;
    for (const BodyContacts& body : bodies)
        m_supported.add(body.m_contacts, m_state.m_found.source());
    m_meetings.addLayers(m_supported);
    m_supported.spread();
}

// Reads the paths of the bodies whose links the core solves.
void SoftBodySolver::Work::readSubsteps(const Bodies& bodies)
{
    if (!m_begun)
    {
        m_rigidBodies.clear();
        beginSubsteps(bodies);
    }
    readPaths(bodies);
}

// Hands the bodies whose links the core solves to the solver, unless they are solved. After readSubsteps().
void SoftBodySolver::Work::takeSubsteps(const Bodies& bodies)
{
    m_touched.clear();
    m_free.clear();
    m_ends.clear();
    findSupported();
    for (int i = 0; i < bodies.size(); ++i)
    {
        btSoftBody& body = *bodies[i];
        if (substepNodes(body) == 0) continue;
        const KeptStep* const kept = m_state.m_kept.stepOf(body);
        SubstepBody& substeps = *substepsOf(body);
        ClothContacts& cloth = clothOf(body);
        if (!kept) m_ends.emplace_back(&body, &cloth);
        if (cloth.m_isSolved) continue;
        substeps.addRows(body, cloth.m_nodes, m_rigidBodies);
        if (const BodyContacts* const contacts = contactsOf(body)) addDynamicRows(substeps, *contacts);
        const bool meetsCloth = m_meetings.hasRows(cloth.m_nodes);
        const bool isFree = !contactsOf(body) && !substeps.rigidRows() && !meetsCloth;
        (isFree ? m_free : m_touched)
            .push_back({&cloth, &substeps.substeps(), nullptr, substeps.rigidRows(), kept, meetsCloth});
    }
}

// Hands the bodies with a pair whose links Bullet solves to the solver.
void SoftBodySolver::Work::takeBulletsBodies(const Bodies& bodies)
{
    m_bulletLinks.clear();
    for (int i = 0; i < bodies.size(); ++i)
    {
        btSoftBody& body = *bodies[i];
        BodyContacts* const contacts = contactsOf(body);
        if (!contacts || !isSteppedBody(body) || substepsOf(body)) continue;
        m_bulletLinks.emplace_back(new BulletLinks(body, !contacts->m_contacts.m_features.empty()));
        m_touched.push_back({&contacts->m_contacts, nullptr, m_bulletLinks.back().get(), nullptr, nullptr});
    }
}

// Returns whether the device may solve the step behind the detection, whose contacts then stay there: it is likely to
// solve all bodies with a pair. A path that meets a surface has to end there before.
bool SoftBodySolver::Work::mayFollow() const
{
    if (!m_stage || m_step->neededHost() || !(m_step->hasPairs() || m_state.m_kept.anyBegun())) return false;
    const auto fits = [this](const BodyContacts& body)
    { return substepNodes(*body.m_body) > 0 && !body.m_contacts.m_isFiltered && !body.m_hasDeformedPair; };
    return std::all_of(m_step->bodies().begin(), m_step->bodies().end(), fits);
}

// Brings bodies to the host whose step has begun on the device and for which isNeeded(body) is true, with one wait.
template <class Needed>
void SoftBodySolver::Work::bringToHostWhere(const Bodies& bodies, const Needed& isNeeded)
{
    if (!m_state.m_kept.any()) return;
    std::vector<btSoftBody*> called;
    for (int i = 0; i < bodies.size(); ++i)
    {
        if (!m_state.m_kept.stepOf(*bodies[i]) || !isNeeded(*bodies[i])) continue;
        m_state.m_kept.beginBringing(*bodies[i]);
        called.push_back(bodies[i]);
    }
    for (btSoftBody* body : called)
        bringToHostInStep(*body);
}

// Brings bodies to the host that nothing holds: the host keeps their momentum.
void SoftBodySolver::Work::bringFreeToHost(const Bodies& bodies)
{
    bringToHostWhere(bodies,
                     [this](const btSoftBody& body) { return !contactsOf(body) && !m_state.m_kept.hasPins(body); });
}

void SoftBodySolver::Work::bringAllToHost(const Bodies& bodies)
{
    bringToHostWhere(bodies, [](const btSoftBody&) { return true; });
}

// Brings a body to the host after the step's begin(), which knows whether it is on the device.
void SoftBodySolver::Work::bringToHostInStep(btSoftBody& body)
{
    if (BodyContacts* const contacts = contactsOf(body))
        m_step->bringToHost(*contacts);
    else
        bringToHost(body);
}

// Brings bodies to the host that the device has not solved.
void SoftBodySolver::Work::bringUnsolvedToHost(const Bodies& bodies)
{
    bringToHostWhere(bodies, [this](const btSoftBody& body) { return !clothOf(body).m_isSolved; });
}

// Stores the nodes of kept bodies on the host. Returns the number of bodies whose step began and ended on the device.
std::size_t SoftBodySolver::Work::endKept(const Bodies& bodies)
{
    std::size_t kept = 0;
    for (int i = 0; i < bodies.size(); ++i)
    {
        if (!isSteppedBody(*bodies[i])) continue;
        kept += m_state.m_kept.isOnDevice(*bodies[i]);
        const SubstepBody* const substeps = substepsAt(*bodies[i]);
        m_state.m_kept.endStep(*bodies[i], &m_owner, contactsOf(*bodies[i]) != nullptr, substeps);
    }
    return kept;
}

// Enqueues the step of all bodies behind the detection. Returns false, with nothing enqueued, if that is not possible.
bool SoftBodySolver::Work::submitBehind(const Bodies& bodies, const ContactSource& source)
{
    if (m_step->hasPairs() && !source.onDevice().m_list) return false;
    readSubsteps(bodies);
    takeSubsteps(bodies);
    return m_solver->submitBehind(m_touched, m_free, source, *m_stage);
}

// Runs Bullet's solver for the bodies without contacts. Scenes may have thousands of small bodies: the environment
// changes once for all of them. Returns whether there were any.
bool SoftBodySolver::Work::solveByBullet(const Bodies& bodies)
{
    bool any = false;
    const CallersFloats floats;
    for (int i = 0; i < bodies.size(); ++i)
    {
        if (!isSteppedBody(*bodies[i]) || contactsOf(*bodies[i]) || substepsOf(*bodies[i])) continue;
        any = true;
        m_solved[static_cast<std::size_t>(i)] = 1;
        bodies[i]->solveConstraints();
    }
    return any;
}
}  // namespace drape
