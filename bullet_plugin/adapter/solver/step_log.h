// Reports in the log what a step of one solver found wrong with its bodies: nodes that are not valid, cloth that meets
// cloth, and a thickness of cloth with cloth out of proportion.
//
// Each problem is told once while it lasts. Cost: nothing in a good step without cloth that meets cloth.
#pragma once

#include <map>
#include <utility>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_plugin/adapter/wiring/told_problems.h"

namespace drape
{
class PluginState;

class StepLog
{
public:
    using Bodies = btAlignedObjectArray<btSoftBody*>;

    explicit StepLog(PluginState& state) : m_state(state) {}

    // Ends a step of the bodies. meetCloth: some of them may collide with themselves or each other.
    void endStep(const Bodies& bodies, bool meetCloth);

private:
    void tellInvalid(const Bodies& bodies);
    void tellMeetings();
    void tellThicknesses(const Bodies& bodies);

    PluginState& m_state;
    ToldProblems<BodyKey> m_invalid;  // bodies with invalid nodes; a null key if the body is unknown
    ToldProblems<std::pair<BodyKey, BodyKey>> m_meeting;  // cloth that meets cloth
    std::map<BodyKey, btScalar> m_thicknesses;            // m, checked
};
}  // namespace drape
