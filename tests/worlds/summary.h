// Counts the results of many worlds, and prints them.
#pragma once

#include <map>
#include <string>

#include "tests/worlds/run_world.h"

namespace drape::test
{
class Summary
{
public:
    void add(const WorldSpec& spec, const WorldResult& result);

    // Counts failed, crashed and timed-out worlds.
    std::size_t failing() const { return m_failing; }
    // Steps whose status reported missing contacts.
    std::size_t reportedSteps() const { return m_reportedSteps; }
    std::size_t startIntersecting() const { return m_startIntersecting; }
    std::size_t worlds() const { return m_worlds; }
    std::string text() const;

private:
    struct Share
    {
        std::size_t m_worlds = 0, m_failing = 0;
    };
    static std::string shares(const char* title, const std::map<std::string, Share>& counts);

    std::size_t m_worlds = 0, m_failing = 0, m_failingAtEnd = 0, m_startIntersecting = 0, m_crashed = 0, m_timedOut = 0;
    std::size_t m_withInvalidNodes = 0, m_heldOnly = 0;
    std::size_t m_steps = 0, m_reportedSteps = 0, m_failingSteps = 0;
    std::map<std::string, Share> m_byKind, m_byModifier;
};

// Returns one line: the options that repeat the world, what happened, and the hash of the trajectory.
std::string resultText(const WorldSpec& spec, const WorldResult& result);
}  // namespace drape::test
