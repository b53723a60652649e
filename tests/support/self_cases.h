// Meshes that move through themselves in a step, and queries on a back end.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <drape/queries.h>
#include "scenes/mesh.h"

namespace drape::test
{
struct SelfCase
{
    std::string m_name;
    TriangleMesh m_mesh;       // at the step's start
    std::vector<float> m_end;  // positions at its end
};

// Loose triangles that fly through one another.
SelfCase soupSelfCase(int triangles, std::uint32_t seed);
// A cloth of nodes × nodes that crumples: every node goes to a place of its own near a plane.
SelfCase crumpledCase(int nodes, std::uint32_t seed);
// The above at several sizes, a mesh of one, two and no triangles, and one with a bad node at the end.
std::vector<SelfCase> selfCases();

// Null, with a failure recorded, when the back end cannot be had.
std::unique_ptr<Queries> makeQueries(const Settings& settings);
}  // namespace drape::test
