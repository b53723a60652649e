// Runs one world step by step and judges it after every step.
#pragma once

#include <cstdint>

#include "tests/worlds/kinds.h"

namespace drape::test
{
enum class Outcome : std::uint32_t
{
    Good,
    Failed,
    StartsIntersecting,  // not judged
    Crashed,
    TimedOut
};

// Plain data, so that a process can hand it to another one.
struct WorldResult
{
    Outcome m_outcome = Outcome::Good;
    std::int32_t m_steps = 0;          // calls of step() in which something ran
    std::int32_t m_reportedSteps = 0;  // whose status said that something was given up
    std::int32_t m_failingSteps = 0;   // with an intersecting pair or a node through that the status does not report
    std::int32_t m_firstFailing = -1;  // its frame
    std::int32_t m_failsAtEnd = 0;     // 1: the last step is a failing one
    std::int32_t m_pairsMax = 0, m_heldPairsMax = 0, m_throughMax = 0, m_invalidMax = 0;
    std::uint32_t m_status = 0;  // of all steps together
    std::int32_t m_signal = 0;   // with Crashed
    std::uint64_t m_hash = 0;    // of the trajectory: all positions after all steps
};

// Whether a step with this status tells its user that contacts may be missing.
bool reportsMissingContacts(std::uint32_t status);

// verbose: a line a step on standard output.
WorldResult runWorld(const WorldSpec& spec, WorldBackend backend, bool verbose = false);

// What repeats a world, as options of drape_worlds.
std::string repeatText(const WorldSpec& spec);
}  // namespace drape::test
