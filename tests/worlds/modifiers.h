// Modifiers of random worlds: named bits, each of which changes the cloths, the obstacles or the time steps of a world.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace drape::test
{
enum Modifier : std::uint32_t
{
    kStiff = 1u << 0,                // stiffness from 0.01 to 1, 1 to 30 iterations
    kMasses = 1u << 1,               // nodes from a milligram to a ton in one cloth
    kTime = 1u << 2,                 // other time steps, also changing ones
    kFast = 1u << 3,                 // cloth starts with 3 to 200 m/s
    kMargin = 1u << 4,               // margins from 0.1 mm to 0.1 m, or none for the obstacles
    kAero = 1u << 5,                 // wind of up to 20 m/s, every aerodynamic model
    kFriction = 1u << 6,             // friction 0 or 1
    kFreeNodes = 1u << 7,            // nodes without faces that hang on a link each
    kPins = 1u << 8,                 // one, two or four nodes without motion
    kCompound = 1u << 9,             // meshes in compounds, up to four deep
    kScaled = 1u << 10,              // scaled shapes, mirrored ones among them
    kKinematic = 1u << 11,           // obstacles that swing and turn
    kMultiple = 1u << 12,            // one to three cloths more
    kDamping = 1u << 13,             // damping, time scale and velocity correction
    kIterations = 1u << 14,          // velocity or drift iterations, one position iteration or none
    kFineCloth = 1u << 15,           // up to 40 nodes a side
    kDriftIterations = 1u << 16,     // one to three drift iterations
    kVelocityIterations = 1u << 17,  // one to five velocity iterations
    kLight = 1u << 18,               // every node weighs a milligram
    // Bit 19 is not used.
    kRatio10 = 1u << 20,   // about one node in ten is ten times as heavy
    kRatio100 = 1u << 21,  // a hundred times as heavy
    kRatio1000 = 1u << 22  // a thousand times as heavy
};

struct ModifierName
{
    Modifier m_bit;
    const char* m_name;
};
const std::vector<ModifierName>& modifierNames();

// Returns the names of the bits, joined by commas, or "none".
std::string modifierText(std::uint32_t modifiers);

// Reads what modifierText() writes, or a number. False when a name is not known.
bool parseModifiers(const std::string& text, std::uint32_t& modifiers);

// Draws modifiers for one world: each of the first sixteen with a probability of 0.18.
std::uint32_t randomModifiers(int kind, std::uint64_t seed);
}  // namespace drape::test
