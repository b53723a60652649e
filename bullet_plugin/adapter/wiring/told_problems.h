// Remembers the problems in the log, so that each is reported once while it lasts.
//
// A body's key is its address and its proxy's number, since a new body may get the address of a deleted one. A body
// that is added to the world again counts as another one, unless the broad phase uses numbers again, as btAxisSweep3
// does. Cost: nothing in a step without problems.
#pragma once

#include <cstdint>
#include <iterator>
#include <map>
#include <utility>

#include "BulletCollision/BroadphaseCollision/btBroadphaseProxy.h"
#include "BulletCollision/CollisionDispatch/btCollisionObject.h"

namespace drape
{
using BodyKey = std::pair<const btCollisionObject*, int>;  // the second is the number of its proxy

inline BodyKey keyOf(const btCollisionObject& body)
{
    return {&body, body.getBroadphaseHandle() ? body.getBroadphaseHandle()->m_uniqueId : 0};
}

template <class Key>
class ToldProblems
{
public:
    // Notes that the current step has the problem. Returns whether the log does not have it yet.
    bool isNew(const Key& key)
    {
        const auto [last, added] = m_lastSteps.insert({key, m_step});
        last->second = m_step;
        return added;
    }

    // Ends the step, and forgets the problems that no step has had for some time.
    void endStep()
    {
        for (auto entry = m_lastSteps.begin(); entry != m_lastSteps.end();)
            entry = entry->second + kKeepSteps < m_step ? m_lastSteps.erase(entry) : std::next(entry);
        ++m_step;
    }

private:
    // Steps without a problem after which it counts as a new one: two seconds at 60 steps a second.
    static constexpr std::uint64_t kKeepSteps = 120;

    std::uint64_t m_step = 0;
    std::map<Key, std::uint64_t> m_lastSteps;
};
}  // namespace drape
