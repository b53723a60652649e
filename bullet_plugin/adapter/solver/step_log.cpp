#include "bullet_plugin/adapter/solver/step_log.h"

#include <algorithm>
#include <string>

#include "bullet_plugin/adapter/pairs/margins.h"
#include "bullet_plugin/adapter/vectors.h"
#include "bullet_plugin/adapter/wiring/log_text.h"
#include "bullet_plugin/adapter/wiring/plugin_state.h"

namespace drape
{
namespace
{
int invalidNodesOf(const btSoftBody& body)
{
    int count = 0;
    for (int i = 0; i < body.m_nodes.size(); ++i)
        count += !positionIsValid(vec3Of(body.m_nodes[i].m_x));
    return count;
}
}  // namespace

void StepLog::endStep(const Bodies& bodies, bool meetCloth)
{
    m_state.tellCompiled();
    m_invalid.endStep();
    m_meeting.endStep();
    if (m_state.m_statistics.m_status & kStepInvalidNodes) tellInvalid(bodies);
    if (!meetCloth) return;
    tellMeetings();
    tellThicknesses(bodies);
}

void StepLog::tellInvalid(const Bodies& bodies)
{
    bool anyNamed = false;
    for (int i = 0; i < bodies.size(); ++i)
    {
        const int count = invalidNodesOf(*bodies[i]);
        if (count == 0) continue;
        anyNamed = true;
        if (!m_invalid.isNew(keyOf(*bodies[i]))) continue;
        m_state.log(m_state.nameOf(*bodies[i]) +
                    ": nodes that are not finite or beyond 2^30 m are left out of collision, " + std::to_string(count) +
                    " of " + std::to_string(bodies[i]->m_nodes.size()));
    }
    if (anyNamed || !m_invalid.isNew(BodyKey())) return;
    m_state.log(std::to_string(m_state.m_statistics.m_invalidNodes) +
                " nodes were not finite or beyond 2^30 m in a step, and were left out of it");
}

void StepLog::tellMeetings()
{
    std::map<std::pair<BodyKey, BodyKey>, ClothPairCounts> met;
    for (const FlaggedPair& pair : m_state.m_flagged)
        if (pair.m_otherBody) met[std::minmax(keyOf(*pair.m_body), keyOf(*pair.m_otherBody))].add(pair.m_flag);
    for (const auto& [bodies, counts] : met)
        if (m_meeting.isNew(bodies))
            m_state.log(m_state.namesOf(*bodies.first.first, *bodies.second.first) + ": " + counts.text());
}

// Checks each thickness when it is new.
void StepLog::tellThicknesses(const Bodies& bodies)
{
    std::map<BodyKey, btScalar> thicknesses;
    for (int i = 0; i < bodies.size(); ++i)
    {
        const SelfColliding* const self = m_state.m_selfCollision.find(*bodies[i]);
        if (!self) continue;
        const btScalar thickness = SelfCollision::thicknessOf(*bodies[i], *self);
        const BodyKey key = keyOf(*bodies[i]);
        thicknesses[key] = thickness;
        const auto checked = m_thicknesses.find(key);
        if (checked != m_thicknesses.end() && checked->second == thickness) continue;
        const std::string remark = selfThicknessRemark(*bodies[i], thickness);
        if (!remark.empty()) m_state.log(m_state.nameOf(*bodies[i]) + ": " + remark);
    }
    m_thicknesses.swap(thicknesses);
}
}  // namespace drape
