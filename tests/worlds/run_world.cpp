#include "tests/worlds/run_world.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>

#include "tests/worlds/judge.h"
#include "tests/worlds/modifiers.h"

namespace drape::test
{
namespace
{
// Contacts are complete despite these bits: the host ran the same step, or nodes moved a shorter distance.
constexpr std::uint32_t kComplete = kStepDeviceFailed | kStepDeviceFull | kStepMotionHeldBack;

void note(const Findings& findings, int frame, bool reported, WorldResult& result)
{
    ++result.m_steps;
    result.m_reportedSteps += reported ? 1 : 0;
    result.m_pairsMax = std::max(result.m_pairsMax, findings.m_pairs);
    result.m_heldPairsMax = std::max(result.m_heldPairsMax, findings.m_heldPairs);
    result.m_throughMax = std::max(result.m_throughMax, findings.m_through);
    result.m_invalidMax = std::max(result.m_invalidMax, findings.m_invalidNodes);
    const bool fails = !reported && (findings.m_pairs > 0 || findings.m_through > 0);
    result.m_failsAtEnd = fails ? 1 : 0;
    if (!fails) return;
    ++result.m_failingSteps;
    if (result.m_firstFailing < 0) result.m_firstFailing = frame;
}
}  // namespace

bool reportsMissingContacts(std::uint32_t status)
{
    return (status & ~kComplete) != 0;
}

WorldResult runWorld(const WorldSpec& spec, WorldBackend backend, bool verbose)
{
    WorldResult result;
    const std::unique_ptr<World> world = makeWorld(spec, backend);
    Judge judge(*world);
    const Findings start = judge.look(false);
    world->m_betweenSteps = [&] { judge.noteBetween(reportsMissingContacts(world->status())); };
    result.m_hash = World::kHashStart;
    for (int frame = 0; frame < world->m_frames; ++frame)
    {
        if (world->step() == 0) continue;
        const bool reported = reportsMissingContacts(world->status());
        const Findings findings = judge.look(reported);
        result.m_hash = world->hash(result.m_hash);
        result.m_status |= world->status();
        note(findings, frame, reported, result);
        if (verbose)
            std::printf("  frame %d: pairs %d, at held nodes %d, nodes through %d, invalid %d, status %" PRIu32 "\n",
                        frame, findings.m_pairs, findings.m_heldPairs, findings.m_through, findings.m_invalidNodes,
                        world->status());
    }
    if (start.m_pairs + start.m_heldPairs > 0)
        result.m_outcome = Outcome::StartsIntersecting;
    else if (result.m_failingSteps > 0)
        result.m_outcome = Outcome::Failed;
    return result;
}

std::string repeatText(const WorldSpec& spec)
{
    return "--kind " + kindNames()[static_cast<std::size_t>(spec.m_kind)] + " --seed " + std::to_string(spec.m_seed) +
           " --count 1 --modifiers " + modifierText(spec.m_modifiers);
}
}  // namespace drape::test
