// Seeded random meshes, cloths and motions. The same seed gives the same case on every machine.
//
// Lengths in metres. A case's name and seed belong into SCOPED_TRACE, so that a failure says how to repeat it.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "scenes/mesh.h"

namespace drape::test
{
// std::mt19937 is the same everywhere; the standard's distributions are not, so numbers are made here.
class Random
{
public:
    explicit Random(std::uint32_t number) : m_engine(number) {}

    float uniform(float low, float high) { return low + (high - low) * (float(m_engine() >> 8) / 16777216.0f); }
    std::uint32_t below(std::uint32_t count) { return std::uint32_t(m_engine()) % count; }

private:
    std::mt19937 m_engine;
};

// One step of one cloth over one obstacle at rest.
struct StepCase
{
    std::string m_name;
    std::uint32_t m_seed;
    TriangleMesh m_cloth;  // positions at the step's start
    TriangleMesh m_obstacle;
    std::vector<float> m_end;  // the cloth's positions at the step's end
    float m_thickness;         // m

    std::string trace() const { return m_name + ", seed " + std::to_string(m_seed); }
};

TriangleMesh shapeNamed(const std::string& name);

// Makes a mesh of one triangle or more: corners in order, none shared.
TriangleMesh looseTriangles(const std::vector<float>& corners);

// Makes loose triangles of half a square metre each, all at one position at height y.
TriangleMesh coincidentTriangles(int count, float y);

// Returns meshes that hierarchies may fail at. All centroids are equal, all corners lie in one point, or triangles lie
// on a line at growing or even distances. A soup has nodes that are NaN, infinite and near the largest float.
// `triangles` is the size of the large ones.
using NamedMesh = std::pair<std::string, TriangleMesh>;
std::vector<NamedMesh> degenerateMeshes(int triangles);

// Lays the cloth's nodes onto the highest surface below or above each of them: at heights of gapLow … gapHigh above it,
// at random. Nodes beside the obstacle keep their height.
void drapeOver(const TriangleMesh& obstacle, TriangleMesh& cloth, float gapLow, float gapHigh, Random& random);

void translate(std::vector<float>& positions, float x, float y, float z);
// Adds a random offset of at most `size` in each coordinate.
void disturb(std::vector<float>& positions, float size, Random& random);

// Makes a cloth of nodes × nodes draped over the shape; the step's start and end are equal.
StepCase drapedCase(const std::string& shape, int nodes, float thickness, std::uint32_t seed);
// Makes the cloth fall and shake through the surface within the step.
StepCase fallingCase(const std::string& shape, int nodes, float thickness, std::uint32_t seed);
// Triangles that share nothing, crossing one another; at rest or moving.
StepCase soupCase(int clothTriangles, int obstacleTriangles, bool moving, std::uint32_t seed);

// Selects the side whose triangles are needles and caps, rotated at random, 10³ to 10⁷ times as long as they are wide
// before their corners are rounded. The other side's triangles are fat.
enum class Thin
{
    Cloth,
    Obstacle,
    Both
};
// Makes loose triangles of up to `size` (m), cloth triangle i near obstacle triangle i. They are at rest, or each moves
// along a line of its own by up to five thicknesses.
StepCase needleCase(Thin thin, int triangles, float size, bool moving, std::uint32_t seed);

// Returns the obstacle's triangles over the box of the cloth grown by `margin`; unused vertices are dropped.
TriangleMesh partNear(const TriangleMesh& obstacle, const std::vector<float>& positions, float margin);
}  // namespace drape::test
