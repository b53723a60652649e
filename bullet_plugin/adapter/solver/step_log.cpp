#include "bullet_plugin/adapter/solver/step_log.h"

#include <algorithm>
#include <cstdio>
#include <iterator>

#include "BulletCollision/BroadphaseCollision/btBroadphaseProxy.h"
#include "bullet_plugin/adapter/pairs/margins.h"
#include "bullet_plugin/adapter/vectors.h"
#include "bullet_plugin/adapter/wiring/log_text.h"
#include "bullet_plugin/adapter/wiring/plugin_state.h"

namespace drape
{
namespace
{
// Steps without a problem after which it counts as a new one: two seconds at 60 steps a second.
constexpr std::uint64_t kKeepSteps = 120;

// Forgets what has not been seen for some time.
template <class Key>
void dropOld(std::map<Key, std::uint64_t>& lastSteps, std::uint64_t step)
{
    for (auto entry = lastSteps.begin(); entry != lastSteps.end();)
        entry = entry->second + kKeepSteps < step ? lastSteps.erase(entry) : std::next(entry);
}

int invalidNodesOf(const btSoftBody& body)
{
    int count = 0;
    for (int i = 0; i < body.m_nodes.size(); ++i)
        count += !positionIsValid(vec3Of(body.m_nodes[i].m_x));
    return count;
}
}  // namespace

StepLog::BodyKey StepLog::keyOf(const btSoftBody& body)
{
    return {&body, body.getBroadphaseHandle() ? body.getBroadphaseHandle()->m_uniqueId : 0};
}

void StepLog::endStep(const Bodies& bodies, bool meetCloth)
{
    ++m_step;
    m_state.tellCompiled();
    dropOld(m_invalid, m_step);
    dropOld(m_meeting, m_step);
    if (m_state.m_statistics.m_status & kStepInvalidNodes) tellInvalid(bodies);
    if (!meetCloth) return;
    tellMeetings();
    tellThicknesses(bodies);
}

void StepLog::tellInvalid(const Bodies& bodies)
{
    char line[256];
    bool anyNamed = false;
    for (int i = 0; i < bodies.size(); ++i)
    {
        const int count = invalidNodesOf(*bodies[i]);
        if (count == 0) continue;
        anyNamed = true;
        std::uint64_t& last = m_invalid[keyOf(*bodies[i])];
        const bool isNew = last == 0;
        last = m_step;
        if (!isNew) continue;
        std::snprintf(line, sizeof(line),
                      "soft body %p: %d of its %d nodes are not finite or beyond 2^30 m, and are left out of collision",
                      static_cast<const void*>(bodies[i]), count, bodies[i]->m_nodes.size());
        m_state.log(line);
    }
    if (anyNamed) return;
    const bool isNew = m_unnamed == 0 || m_unnamed + kKeepSteps < m_step;
    m_unnamed = m_step;
    if (!isNew) return;
    std::snprintf(line, sizeof(line), "%zu nodes were not finite or beyond 2^30 m in a step, and were left out of it",
                  m_state.m_statistics.m_invalidNodes);
    m_state.log(line);
}

void StepLog::tellMeetings()
{
    std::map<PairKey, ClothPairCounts> met;
    for (const FlaggedPair& pair : m_state.m_flagged)
        if (pair.m_otherBody) met[std::minmax(keyOf(*pair.m_body), keyOf(*pair.m_otherBody))].add(pair.m_flag);
    for (const auto& [bodies, counts] : met)
    {
        std::uint64_t& last = m_meeting[bodies];
        const bool isNew = last == 0;
        last = m_step;
        if (isNew) m_state.log(clothPairText(*bodies.first.first, *bodies.second.first, counts));
    }
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
        if (!remark.empty()) m_state.log(nameOf(*bodies[i]) + ": " + remark);
    }
    m_thicknesses.swap(thicknesses);
}
}  // namespace drape
