// The list of all kinds of worlds, and how one of them is built: kind, seed and modifiers stand for one world.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tests/worlds/world.h"

namespace drape::test
{
struct WorldSpec
{
    int m_kind = 0;  // index into kindNames()
    std::uint64_t m_seed = 0;
    std::uint32_t m_modifiers = 0;  // modifiers of random kinds; the others have none
};

// The random kinds, the two of tiny worlds, and the grids of skirts, in this order.
const std::vector<std::string>& kindNames();
int randomKindCount();
// Returns -1 for a name that is not known.
int kindByName(const std::string& name);

// The modifiers of worlds of a random kind are these bits, or random ones for each world.
struct ModifierChoice
{
    bool m_random = false;
    std::uint32_t m_bits = 0;
};

// Returns `count` worlds: for one seed after the other, from `seed` on, a world of each kind in `group`. A group is a
// kind's name, "all" for the random kinds but ropes and loads, "tiny" or "skirts". A grid ends with its last setting.
// Returns nothing for a group that is not known.
std::vector<WorldSpec> worldsOf(const std::string& group, std::uint64_t seed, std::size_t count,
                                const ModifierChoice& modifiers);

// Builds the world and starts it.
std::unique_ptr<World> makeWorld(const WorldSpec& spec, WorldBackend backend);
}  // namespace drape::test
