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
    std::int32_t m_reportedSteps = 0;  // steps whose status says that contacts may be missing
    std::int32_t m_failingSteps = 0;   // intersecting pairs or nodes through, not reported
    std::int32_t m_firstFailing = -1;  // frame of the first failing step; -1 without one
    std::int32_t m_failsAtEnd = 0;     // 1: the last step is a failing one
    std::int32_t m_pairsMax = 0, m_heldPairsMax = 0, m_throughMax = 0, m_invalidMax = 0;
    std::uint32_t m_status = 0;  // bits of all steps
    std::int32_t m_signal = 0;   // signal that ended the process; 0 without one
    std::uint64_t m_hash = 0;    // hash of the trajectory: all positions after all steps
};

// Returns whether a step with this status tells its user that contacts may be missing.
bool reportsMissingContacts(std::uint32_t status);

// Prints a line a step on standard output where `verbose` is set.
WorldResult runWorld(const WorldSpec& spec, WorldBackend backend, bool verbose = false);

// Returns the options of drape_worlds that repeat the world.
std::string repeatText(const WorldSpec& spec);
}  // namespace drape::test
