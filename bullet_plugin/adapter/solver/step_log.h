// Reports in the log what a step of one solver found wrong with its bodies: nodes that are not valid, cloth that meets
// cloth, and a thickness of cloth with cloth out of proportion.
//
// Each problem is told once while it lasts. Bodies are told apart by address and by their proxies' number, since
// another body may get an address. Cost: nothing in a good step without cloth that meets cloth.
#pragma once

#include <cstdint>
#include <map>
#include <utility>

#include "BulletSoftBody/btSoftBody.h"

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
    using BodyKey = std::pair<const btSoftBody*, int>;  // the second is the number of its proxy
    using PairKey = std::pair<BodyKey, BodyKey>;

    static BodyKey keyOf(const btSoftBody& body);
    void tellInvalid(const Bodies& bodies);
    void tellMeetings();
    void tellThicknesses(const Bodies& bodies);

    PluginState& m_state;
    std::uint64_t m_step = 0;
    std::map<BodyKey, std::uint64_t> m_invalid;  // last step with invalid nodes
    std::uint64_t m_unnamed = 0;                 // last step with such nodes of an unknown body
    std::map<PairKey, std::uint64_t> m_meeting;  // last step in which the two met
    std::map<BodyKey, btScalar> m_thicknesses;   // m, checked
};
}  // namespace drape
