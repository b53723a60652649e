#include "tests/worlds/kinds.h"

#include <algorithm>

#include "tests/worlds/families.h"
#include "tests/worlds/skirts.h"
#include "tests/worlds/tiny_worlds.h"

namespace drape::test
{
namespace
{
struct RandomKind
{
    const char* m_name;
    void (*m_build)(WorldBuilder& builder);
};

// A kind's index is part of its seeds: new kinds go to the end.
constexpr RandomKind kRandomKinds[] = {{"terrain", buildTerrain},
                                       {"blob", buildBlob},
                                       {"boxes", buildBoxes},
                                       {"spikes", buildSpikes},
                                       {"ring", buildRing},
                                       {"funnel", buildFunnel},
                                       {"corner", buildCorner},
                                       {"two_sheets", buildTwoSheets},
                                       {"jaws", buildJaws},
                                       {"fan", buildFan},
                                       {"conveyor", buildConveyor},
                                       {"rod", buildRod},
                                       {"fine_mesh", buildFineMesh},
                                       {"coarse_mesh", buildCoarseMesh},
                                       {"degenerate", buildDegenerate},
                                       {"self_intersecting", buildSelfIntersecting},
                                       {"pressure", buildPressure},
                                       {"moving_pins", buildMovingPins},
                                       {"anchors", buildAnchors},
                                       {"slow_scale", buildSlowScale},
                                       {"crumpled", buildCrumpled},
                                       {"needle_rain", buildNeedleRain},
                                       {"cracks", buildCracks},
                                       {"spin_box", buildSpinBox},
                                       {"wave_floor", buildWaveFloor},
                                       {"slats", buildSlats},
                                       {"drawer", buildDrawer},
                                       {"chimney", buildChimney},
                                       {"ropes", buildRopes},
                                       {"loads", buildLoads}};
constexpr int kRandomKindCount = static_cast<int>(sizeof kRandomKinds / sizeof *kRandomKinds);
// The kinds of the group "all". Ropes and loads are groups of their own, so that a seed keeps its world.
constexpr int kAllCount = kRandomKindCount - 2;
constexpr int kTinyStatic = kRandomKindCount;
constexpr int kTinyKinematic = kTinyStatic + 1;
constexpr int kSkirtTurn = kTinyStatic + 2;
constexpr int kSkirtDash = kTinyStatic + 3;
constexpr std::uint64_t kTimeSeed = 99;

std::size_t settingsOf(int kind)
{
    if (kind == kSkirtTurn) return skirtTurnCount();
    if (kind == kSkirtDash) return skirtDashCount();
    return ~std::size_t(0);
}

// The kinds of a group: the first and one past the last.
bool kindsOf(const std::string& group, int& first, int& last)
{
    first = kindByName(group);
    last = first + 1;
    if (group == "all")
    {
        first = 0;
        last = kAllCount;
    }
    if (group == "tiny")
    {
        first = kTinyStatic;
        last = kTinyKinematic + 1;
    }
    if (group == "skirts")
    {
        first = kSkirtTurn;
        last = kSkirtDash + 1;
    }
    return first >= 0;
}
}  // namespace

const std::vector<std::string>& kindNames()
{
    static const std::vector<std::string> names = []
    {
        std::vector<std::string> all;
        for (const RandomKind& kind : kRandomKinds)
            all.push_back(kind.m_name);
        all.insert(all.end(), {"tiny_static", "tiny_kinematic", "skirt_turn", "skirt_dash"});
        return all;
    }();
    return names;
}

int randomKindCount()
{
    return kRandomKindCount;
}

int kindByName(const std::string& name)
{
    const std::vector<std::string>& names = kindNames();
    const auto at = std::find(names.begin(), names.end(), name);
    return at == names.end() ? -1 : static_cast<int>(at - names.begin());
}

std::vector<WorldSpec> worldsOf(const std::string& group, std::uint64_t seed, std::size_t count,
                                const ModifierChoice& modifiers)
{
    std::vector<WorldSpec> worlds;
    int first = 0, last = 0;
    if (!kindsOf(group, first, last)) return worlds;
    for (bool added = true; added && worlds.size() < count; ++seed)
    {
        added = false;
        for (int kind = first; kind < last && worlds.size() < count; ++kind)
        {
            if (seed >= settingsOf(kind)) continue;
            std::uint32_t bits = 0;
            if (kind < kRandomKindCount) bits = modifiers.m_random ? randomModifiers(kind, seed) : modifiers.m_bits;
            worlds.push_back({kind, seed, bits});
            added = true;
        }
    }
    return worlds;
}

std::unique_ptr<World> makeWorld(const WorldSpec& spec, WorldBackend backend)
{
    auto world = std::make_unique<World>(backend);
    if (spec.m_kind < kRandomKindCount)
    {
        world->m_timeRandom = WorldRandom(spec.m_seed + kTimeSeed);
        WorldBuilder builder(*world, spec.m_seed * 1000 + static_cast<std::uint64_t>(spec.m_kind), spec.m_modifiers);
        kRandomKinds[spec.m_kind].m_build(builder);
    }
    else if (spec.m_kind == kSkirtTurn)
        buildSkirtTurn(*world, spec.m_seed);
    else if (spec.m_kind == kSkirtDash)
        buildSkirtDash(*world, spec.m_seed);
    else
        buildTinyWorld(*world, spec.m_seed, spec.m_kind == kTinyKinematic);
    world->start();
    return world;
}
}  // namespace drape::test
