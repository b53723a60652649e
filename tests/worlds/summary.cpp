#include "tests/worlds/summary.h"

#include <cinttypes>
#include <cstdio>

#include <drape/drape.h>

#include "tests/worlds/modifiers.h"

namespace drape::test
{
namespace
{
const char* outcomeName(const WorldResult& result)
{
    switch (result.m_outcome)
    {
        case Outcome::Good:
            return "good";
        case Outcome::Failed:
            return result.m_failsAtEnd ? "FAILS, also in the end" : "FAILS";
        case Outcome::StartsIntersecting:
            return "starts intersecting";
        case Outcome::Crashed:
            return "CRASHES";
        case Outcome::TimedOut:
            return "TIMES OUT";
    }
    return "";
}

bool fails(Outcome outcome)
{
    return outcome == Outcome::Failed || outcome == Outcome::Crashed || outcome == Outcome::TimedOut;
}
}  // namespace

void Summary::add(const WorldSpec& spec, const WorldResult& result)
{
    ++m_worlds;
    m_crashed += result.m_outcome == Outcome::Crashed ? 1 : 0;
    m_timedOut += result.m_outcome == Outcome::TimedOut ? 1 : 0;
    m_startIntersecting += result.m_outcome == Outcome::StartsIntersecting ? 1 : 0;
    m_steps += static_cast<std::size_t>(result.m_steps);
    m_reportedSteps += static_cast<std::size_t>(result.m_reportedSteps);
    m_withInvalidNodes += result.m_invalidMax > 0 ? 1 : 0;
    if (result.m_outcome == Outcome::StartsIntersecting) return;
    const bool failing = fails(result.m_outcome);
    m_failing += failing ? 1 : 0;
    m_failingAtEnd += failing && result.m_failsAtEnd ? 1 : 0;
    m_failingSteps += static_cast<std::size_t>(result.m_failingSteps);
    m_heldOnly += !failing && result.m_heldPairsMax > 0 ? 1 : 0;
    const auto count = [failing](Share& share)
    {
        ++share.m_worlds;
        share.m_failing += failing ? 1 : 0;
    };
    count(m_byKind[kindNames()[static_cast<std::size_t>(spec.m_kind)]]);
    if (spec.m_modifiers == 0) count(m_byModifier["none"]);
    for (const ModifierName& modifier : modifierNames())
        if (spec.m_modifiers & modifier.m_bit) count(m_byModifier[modifier.m_name]);
}

std::string Summary::shares(const char* title, const std::map<std::string, Share>& counts)
{
    std::string text;
    for (const auto& [name, share] : counts)
        if (share.m_failing > 0)
            text += (text.empty() ? "" : ", ") + name + " " + std::to_string(share.m_failing) + " of " +
                    std::to_string(share.m_worlds);
    return text.empty() ? "" : std::string(title) + text + "\n";
}

std::string Summary::text() const
{
    char text[600];
    std::snprintf(text, sizeof text,
                  "worlds %zu: failing %zu (in the end %zu, crashed %zu, timed out %zu), not judged as they start "
                  "intersecting %zu\n"
                  "steps %zu: failing %zu, reported as given up %zu\n"
                  "good worlds where only triangles at held nodes intersect %zu, worlds with invalid nodes %zu\n",
                  m_worlds, m_failing, m_failingAtEnd, m_crashed, m_timedOut, m_startIntersecting, m_steps,
                  m_failingSteps, m_reportedSteps, m_heldOnly, m_withInvalidNodes);
    return text + shares("failing by kind: ", m_byKind) + shares("failing by modifier: ", m_byModifier);
}

std::string resultText(const WorldSpec& spec, const WorldResult& result)
{
    char text[400];
    std::snprintf(text, sizeof text,
                  ": %s, first in frame %d, in %d of %d steps, pairs %d, nodes through %d, invalid %d, status '%s'"
                  ", signal %d, hash %016" PRIx64,
                  outcomeName(result), result.m_firstFailing, result.m_failingSteps, result.m_steps, result.m_pairsMax,
                  result.m_throughMax, result.m_invalidMax, statusText(result.m_status).c_str(), result.m_signal,
                  result.m_hash);
    return repeatText(spec) + text;
}
}  // namespace drape::test
