#include "tests/worlds/modifiers.h"

#include <sstream>

#include "tests/worlds/world_random.h"

namespace drape::test
{
namespace
{
constexpr int kRandomModifiers = 16;
constexpr double kModifierProbability = .18;

bool parseOne(const std::string& word, std::uint32_t& bits)
{
    for (const ModifierName& modifier : modifierNames())
        if (word == modifier.m_name)
        {
            bits = modifier.m_bit;
            return true;
        }
    if (word.empty() || word.size() > 7 || word.find_first_not_of("0123456789") != std::string::npos) return false;
    bits = static_cast<std::uint32_t>(std::stoul(word));
    return bits < 2 * kRatio1000;
}
}  // namespace

const std::vector<ModifierName>& modifierNames()
{
    static const std::vector<ModifierName> names = {{kStiff, "stiff"},
                                                    {kMasses, "masses"},
                                                    {kTime, "time"},
                                                    {kFast, "fast"},
                                                    {kMargin, "margin"},
                                                    {kAero, "aero"},
                                                    {kFriction, "friction"},
                                                    {kFreeNodes, "free_nodes"},
                                                    {kPins, "pins"},
                                                    {kCompound, "compound"},
                                                    {kScaled, "scaled"},
                                                    {kKinematic, "kinematic"},
                                                    {kMultiple, "multiple"},
                                                    {kDamping, "damping"},
                                                    {kIterations, "iterations"},
                                                    {kFineCloth, "fine_cloth"},
                                                    {kDriftIterations, "drift_iterations"},
                                                    {kVelocityIterations, "velocity_iterations"},
                                                    {kLight, "light"},
                                                    {kRatio10, "ratio10"},
                                                    {kRatio100, "ratio100"},
                                                    {kRatio1000, "ratio1000"}};
    return names;
}

std::string modifierText(std::uint32_t modifiers)
{
    std::string text;
    for (const ModifierName& modifier : modifierNames())
        if (modifiers & modifier.m_bit) text += (text.empty() ? "" : ",") + std::string(modifier.m_name);
    return text.empty() ? "none" : text;
}

bool parseModifiers(const std::string& text, std::uint32_t& modifiers)
{
    modifiers = 0;
    if (text == "none") return true;
    std::istringstream words(text);
    std::string word;
    while (std::getline(words, word, ','))
    {
        std::uint32_t bits = 0;
        if (!parseOne(word, bits)) return false;
        modifiers |= bits;
    }
    return true;
}

std::uint32_t randomModifiers(int kind, std::uint64_t seed)
{
    WorldRandom random((seed * 64 + static_cast<std::uint64_t>(kind)) * 7919 + 5);
    std::uint32_t modifiers = 0;
    for (int bit = 0; bit < kRandomModifiers; ++bit)
        if (random.chance(kModifierProbability)) modifiers |= 1u << bit;
    return modifiers;
}
}  // namespace drape::test
