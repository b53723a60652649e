#include "rigid_rows.h"

#include <algorithm>

#include "bullet_plugin/core/solver/host/substeps.h"

namespace drape
{
namespace
{
// Calls call(row) for all rows of both lists.
template <class Call>
void forRows(const std::vector<RigidAnchor>& anchors, const std::vector<RigidContact>& contacts, const Call& call)
{
    std::for_each(anchors.begin(), anchors.end(), call);
    std::for_each(contacts.begin(), contacts.end(), call);
}

// Returns what a row has pushed in a substep, kg m.
Vec3 pushOf(const RigidPlane& plane, const RigidRowState& state)
{
    return vec3AddScaled(state.m_held, plane.m_normal, state.m_multiplier);
}

bool yields(const RigidBody& body)
{
    return body.m_inverseMass.x > 0 && body.m_inverseMass.y > 0 && body.m_inverseMass.z > 0;
}
}  // namespace

void RigidRows::clear()
{
    m_given = {};
    m_contacts.clear();
    m_anchors.clear();
    m_contactStates.clear();
    m_contactImpulses.clear();
    m_anchorStates.clear();
    m_features.clear();
    m_near.clear();
}

// Takes the first row's body as the reference of what the rows give.
void RigidRows::refer(std::uint32_t body)
{
    if (empty()) m_given.m_reference = (*m_bodies)[body].m_centre;
}

void RigidRows::add(const RigidContact& contact)
{
    refer(contact.m_body);
    m_contacts.push_back(contact);
    m_contactStates.push_back({});
    m_contactImpulses.push_back(vec3(0, 0, 0));
}

void RigidRows::add(const RigidAnchor& anchor)
{
    refer(anchor.m_body);
    m_anchors.push_back(anchor);
    m_anchorStates.push_back({});
}

void RigidRows::add(const RigidFeature& feature, float bodyTime)
{
    refer(feature.m_body);
    m_bodyTime = bodyTime;
    const bool isBlocked = std::any_of(feature.m_isBlocked, feature.m_isBlocked + feature.m_count,
                                       [](bool nodeIsBlocked) { return nodeIsBlocked; });
    m_features.push_back({feature, isBlocked, 0, 0, 0, vec3(0, 0, 0), {}, {}});
}

bool RigidRows::bodiesYield() const
{
    bool all = true;
    forRows(m_anchors, m_contacts, [&](const auto& row) { all = all && yields((*m_bodies)[row.m_body]); });
    return all && std::all_of(m_features.begin(), m_features.end(),
                              [&](const FeatureRow& row) { return yields((*m_bodies)[row.m_feature.m_body]); });
}

std::size_t RigidRows::movingRows() const
{
    std::size_t rows = 0;
    forRows(m_anchors, m_contacts, [&](const auto& row) { rows += (*m_bodies)[row.m_body].m_moves; });
    return rows + m_features.size();
}

// Returns by how much the body's velocity at the step's end exceeds that of its motion in the substep, m/s.
Vec3 RigidRows::lagOf(std::uint32_t index) const
{
    const RigidBody& body = m_featureStep.m_bodies[index];
    return vec3Sub(vec3Scale(body.m_acceleration, m_featureStep.m_left - m_featureStep.m_time), body.m_displaced);
}

Vec3 RigidRows::displacementOf(const FeatureRow& row) const
{
    const RigidFeature& feature = row.m_feature;
    const RigidBody* const body = m_featureStep.m_bodies + feature.m_body;
    const Vec3 carried = rigidCarried(&m_featureStep, body, feature.m_arm, &row.m_state);
    Vec3 displacement = vec3Sub(vec3Scale(lagOf(feature.m_body), m_featureStep.m_time), carried);
    for (std::uint32_t k = 0; k < feature.m_count; ++k)
        displacement = vec3AddScaled(displacement, m_nodes->displacement(feature.m_nodes[k]), feature.m_weights[k]);
    return displacement;
}

// Returns how far the contact's point is nearer to the body than what holds its blocked nodes moves it, m.
float RigidRows::surplusOf(const FeatureRow& row) const
{
    const RigidFeature& feature = row.m_feature;
    float surplus = 0;
    for (std::uint32_t k = 0; k < feature.m_count; ++k)
    {
        if (!feature.m_isBlocked[k]) continue;
        const float nearer = -vec3Dot(feature.m_plane.m_normal, m_nodes->displacement(feature.m_nodes[k]));
        const float advance = m_featureStep.m_passed * feature.m_advance[k];
        surplus += feature.m_weights[k] * std::max(0.0f, nearer - advance);
    }
    return surplus;
}

float RigidRows::inverseMassOf(const RigidFeature& feature, std::uint32_t k) const
{
    return feature.m_isBlocked[k] ? 0.0f : m_nodes->inverseMass(feature.m_nodes[k]);
}

// Returns the mobility of the body along the contact's normal, 1/kg.
float RigidRows::bodyMobility(const RigidFeature& feature) const
{
    return rigidMobility(&m_featureStep, m_featureStep.m_bodies + feature.m_body, feature.m_arm,
                         feature.m_plane.m_normal);
}

void RigidRows::begin(SolverNodes& nodes, const Substeps& substeps, int substep)
{
    const float time = substeps.substepTime(), passed = float(substep + 1) / float(substeps.count());
    const std::uint32_t count = std::uint32_t(substeps.count()), done = std::uint32_t(substep);
    m_nodes = &nodes;
    m_stepTime = substeps.time();
    m_substep = {nodes.nodes(),
                 nodes.states(),
                 nodes.paths(),
                 m_bodies->data(),
                 &m_given,
                 time,
                 1 / substeps.correctionTime(),
                 passed,
                 rigidLeft(time, count, done)};
    m_featureStep = m_substep;
    m_featureStep.m_time = m_bodyTime / float(count);
    m_featureStep.m_left = rigidLeft(m_featureStep.m_time, count, done);
    for (RigidRowState& state : m_contactStates)
        rigidBeginRow(&state);
    m_near.clear();
    for (std::size_t i = 0; i < m_features.size(); ++i)
    {
        FeatureRow& row = m_features[i];
        const RigidFeature& feature = row.m_feature;
        row.m_inverseMass = row.m_wholeMass = 0;
        for (std::uint32_t k = 0; k < feature.m_count; ++k)
        {
            const float squared = feature.m_weights[k] * feature.m_weights[k];
            row.m_inverseMass += squared * inverseMassOf(feature, k);
            row.m_wholeMass += squared * m_nodes->inverseMass(feature.m_nodes[k]);
        }
        rigidBeginRow(&row.m_state);
        rigidBeginRow(&row.m_surplus);
        const float violation = rigidViolation(&feature.m_plane, displacementOf(row), passed);
        if (mobilityOf(row) > 0 && violation > -feature.m_reach) m_near.push_back(std::uint32_t(i));
    }
}

void RigidRows::project()
{
    for (std::size_t i = 0; i < m_anchors.size(); ++i)
        rigidProjectAnchor(&m_substep, &m_anchors[i], &m_anchorStates[i]);
    for (std::size_t i = 0; i < m_contacts.size(); ++i)
        rigidProjectContact(&m_substep, &m_contacts[i], &m_contactStates[i]);
}

// Moves the feature's nodes, and the body the other way. by: kg m. movesBlocked: blocked nodes, too.
void RigidRows::push(const RigidFeature& feature, Vec3 by, bool movesBlocked)
{
    for (std::uint32_t k = 0; k < feature.m_count; ++k)
        if (movesBlocked || !feature.m_isBlocked[k])
            rigidShiftNode(&m_featureStep, feature.m_nodes[k], vec3Scale(by, feature.m_weights[k]));
    RigidBody* const body = m_featureStep.m_bodies + feature.m_body;
    if (!body->m_moves) return;
    if (!body->m_isPushed)
    {
        // From where Bullet takes it to where an even gain of speed does.
        const float lag = 0.5f * m_bodyTime * (m_bodyTime - m_featureStep.m_time);
        body->m_shift = vec3AddScaled(body->m_shift, body->m_acceleration, -lag);
        body->m_isPushed = 1;
    }
    rigidGive(&m_featureStep, body, feature.m_arm, vec3Scale(by, -m_featureStep.m_perCorrection));
}

void RigidRows::projectFeatures(float relaxation)
{
    for (const std::uint32_t index : m_near)
    {
        FeatureRow& row = m_features[index];
        const RigidPlane& plane = row.m_feature.m_plane;
        Vec3 displacement = displacementOf(row), by;
        if (row.m_isBlocked) displacement = vec3AddScaled(displacement, plane.m_normal, surplusOf(row));
        if (rigidContactPush(&plane, displacement, m_featureStep.m_passed, mobilityOf(row), relaxation, &row.m_state,
                             &by))
            push(row.m_feature, by, false);
        if (row.m_isBlocked) pushSurplus(row, relaxation);
    }
}

// Lets the body and a blocked feature push each other for what its nodes moved by themselves. They have the mass that
// they have then: links and other cloth moved them, and light nodes throw no heavy body.
void RigidRows::pushSurplus(FeatureRow& row, float relaxation)
{
    const RigidPlane& plane = row.m_feature.m_plane;
    Vec3 displacement = displacementOf(row), by;
    const float beyond = rigidViolation(&plane, displacement, m_featureStep.m_passed) - surplusOf(row);
    displacement = vec3AddScaled(displacement, plane.m_normal, std::max(0.0f, beyond));
    const float mobility = row.m_wholeMass + bodyMobility(row.m_feature);
    if (rigidContactPush(&plane, displacement, m_featureStep.m_passed, mobility, relaxation, &row.m_surplus, &by))
        push(row.m_feature, by, true);
}

void RigidRows::limitSpeeds()
{
    m_featureStep.m_left = 0;  // the step is over
    const float unitTime = m_featureStep.m_time * m_featureStep.m_perCorrection;
    for (FeatureRow& row : m_features)
    {
        const RigidFeature& feature = row.m_feature;
        const RigidPlane& plane = feature.m_plane;
        RigidBody* const body = m_featureStep.m_bodies + feature.m_body;
        if (!(plane.m_gap < 0) || !(plane.m_recover > 0) || !(mobilityOf(row) > 0)) continue;
        float speed = -vec3Dot(rigidVelocity(body, feature.m_arm), plane.m_normal);
        for (std::uint32_t k = 0; k < feature.m_count; ++k)
            speed += feature.m_weights[k] * vec3Dot(m_nodes->velocity(feature.m_nodes[k]), plane.m_normal);
        const float excess = std::min(speed, plane.m_recover / m_stepTime);
        if (!(excess > 0)) continue;
        // A push's mobility, less the time that it acts.
        const float mobility = row.m_inverseMass + (mobilityOf(row) - row.m_inverseMass) / unitTime;
        const Vec3 impulse = vec3Scale(plane.m_normal, std::min(excess / mobility, row.m_pushed));
        row.m_impulse = vec3Sub(row.m_impulse, impulse);
        for (std::uint32_t k = 0; k < feature.m_count; ++k)
        {
            const float share = feature.m_weights[k] * inverseMassOf(feature, k);
            m_nodes->addVelocity(feature.m_nodes[k], vec3Scale(impulse, -share));
        }
        if (body->m_moves) rigidGive(&m_featureStep, body, feature.m_arm, impulse);
    }
}

void RigidRows::end()
{
    for (std::size_t i = 0; i < m_anchors.size(); ++i)
        rigidEndRow(&m_substep, m_anchors[i].m_body, m_anchors[i].m_arm, &m_anchorStates[i]);
    for (std::size_t i = 0; i < m_contacts.size(); ++i)
    {
        rigidEndRow(&m_substep, m_contacts[i].m_body, m_contacts[i].m_arm, &m_contactStates[i]);
        m_contactImpulses[i] = vec3AddScaled(m_contactImpulses[i], pushOf(m_contacts[i].m_plane, m_contactStates[i]),
                                             m_substep.m_perCorrection);
    }
    for (FeatureRow& row : m_features)
    {
        const std::uint32_t body = row.m_feature.m_body;
        rigidEndRow(&m_featureStep, body, row.m_feature.m_arm, &row.m_state);
        row.m_state.m_carried = vec3AddScaled(row.m_state.m_carried, lagOf(body), -m_featureStep.m_time);
        row.m_pushed += row.m_state.m_multiplier * m_featureStep.m_perCorrection;
        for (const RigidRowState* state : {&row.m_state, &row.m_surplus})
            row.m_impulse =
                vec3AddScaled(row.m_impulse, pushOf(row.m_feature.m_plane, *state), m_featureStep.m_perCorrection);
    }
}

void RigidRows::takeOver(const RigidGiven& given, const RigidBody* bodies)
{
    m_given = given;
    forRows(m_anchors, m_contacts,
            [&](const auto& row)
            {
                if (bodies[row.m_body].m_moves) (*m_bodies)[row.m_body] = bodies[row.m_body];
            });
}
}  // namespace drape
