// A mesh and a device as the tree builders take them, and the ways of building that are compared.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "study/programs/study.h"
#include "benchmarks/support/step_scene.h"
#include "study/kernel_programs.h"
#include "study/trees/tree_builder.h"
#include "bullet_plugin/core/device/profiler.h"
#include "scenes/mesh.h"

namespace drape::bench
{
struct TreeVariant
{
    std::string m_name;
    TreeMethods m_methods;
    std::string m_rule;  // variants of one rule make the same tree
};

// The thesis's construction with its optimisations one after the other, and today's builders. quick: one of each
// builder, since PoCL compiles the thesis's kernels again for each of their group sizes.
std::vector<TreeVariant> treeVariants(bool quick);
// The last variant of each rule: of the thesis's, the one with all optimisations.
std::vector<TreeVariant> treeRules(bool quick);

// A profiled device as the options name it; null for the host. Throws where it was asked for and is not there.
std::unique_ptr<Device> openStudyDevice(const StudyOptions& options);

struct TreeInput
{
    explicit TreeInput(const TriangleMesh& mesh);

    std::size_t triangleCount() const { return m_triangles.size(); }
    // To the device, enqueued.
    void upload(Device& device);

    std::vector<Triangle> m_triangles;
    std::vector<float> m_positions;  // m, x y z per vertex
    std::vector<float> m_moved;      // positions for refits: refitPositions()
    Buffer<Triangle> m_triangleBuffer;
    Buffer<float> m_positionBuffer;
};

// The triangles of the thesis's cloth, draped over a model, as leaves: each one's volume over a step, as far as it
// looks.
struct ClothQueries
{
    StepScene m_scene;  // the step is its first
    std::vector<BvhNode> m_nodes;
    std::vector<Triangle> m_triangles;
};
ClothQueries clothQueries(const TriangleMesh& obstacle);

// Hashes order and nodes: links and volumes, bit for bit.
std::string treeHash(const Tree& tree);
// Returns whether every triangle is in one leaf and every volume is exactly that of its triangles: whyInvalid(), which
// a line on standard error then says. moved: of the triangles where refits find them.
bool isValid(const Tree& tree, const TreeInput& input, bool moved = false);
// The expected hash beside that of a wrong tree.
constexpr const char* kNoValidTree = "that of a valid tree";

// A row's input columns.
Row treeRow(const char* part, const std::string& model, std::size_t triangles, const std::string& variant);
}  // namespace drape::bench
