// Meshes that move through themselves in a step, and queries on a back end.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <drape/queries.h>
#include "bullet_plugin/core/pipeline/pipeline.h"
#include "scenes/mesh.h"

namespace drape::test
{
struct SelfCase
{
    std::string m_name;
    TriangleMesh m_mesh;       // at the step's start
    std::vector<float> m_end;  // positions at its end
};

// Makes loose triangles that fly through one another.
SelfCase soupSelfCase(int triangles, std::uint32_t seed);
// Makes a cloth of nodes × nodes that crumples: every node moves to a position of its own near a plane.
SelfCase crumpledCase(int nodes, std::uint32_t seed);
// Returns the cases above at several sizes, a mesh of one, two and no triangles, and one with a bad node at the end.
std::vector<SelfCase> selfCases();

// A step of a cloth that collides with itself.
struct SelfStepCase
{
    SelfCase m_motion;
    std::vector<float> m_rest;  // positions at rest, m
    float m_thickness;          // m
};

// Makes a cloth of nodes × nodes folded into layers that lie on one another, a little disturbed, and moved by up to
// `motion` (m) in a direction of each node's own. (nodes - 1) is a multiple of layers.
SelfStepCase foldedCase(int nodes, int layers, float motion, std::uint32_t seed);
// Returns folded, crumpled and torn cloths, one with a bad node, of one triangle and of none.
std::vector<SelfStepCase> selfStepCases();

// Adds the cloth, names it for the step and sets its nodes.
MeshId addSelfCloth(Pipeline& pipeline, const SelfStepCase& step);
// Contacts of a cloth with itself, of a pipeline of its own.
std::vector<Contact> runSelfCase(Pipeline& pipeline, const SelfStepCase& step);

// Null, with a failure recorded, when the back end cannot be had.
std::unique_ptr<Queries> makeQueries(const Settings& settings);
}  // namespace drape::test
