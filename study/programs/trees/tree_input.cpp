#include "study/programs/trees/tree_input.h"

#include <iostream>
#include <stdexcept>

#include "benchmarks/support/result_hash.h"
#include "benchmarks/support/step_method.h"
#include "study/trees/tree_quality.h"
#include "bullet_plugin/core/device/device_choice.h"
#include "bullet_plugin/core/scene/topology.h"
#include "kernels/lib/geometry/dop.h"

namespace drape::bench
{
namespace
{
TreeVariant topDown(const std::string& name, bool adaptive, bool small, bool large, bool median)
{
    TreeVariant variant;
    variant.m_name = name;
    variant.m_methods.m_builder = TreeBuilder::TopDown;
    variant.m_methods.m_topDown.m_adaptiveGroups = adaptive;
    variant.m_methods.m_topDown.m_smallSplits = small;
    variant.m_methods.m_topDown.m_largeNodes = large;
    variant.m_methods.m_topDown.m_medianSplit = median;
    variant.m_rule = median ? "top-down median" : "top-down";
    return variant;
}

TreeVariant builder(const std::string& name, TreeBuilder which, std::uint32_t bits)
{
    TreeVariant variant;
    variant.m_name = name;
    variant.m_methods.m_builder = which;
    variant.m_methods.m_mortonBits = bits;
    variant.m_rule = name;
    return variant;
}
}  // namespace

std::vector<TreeVariant> treeVariants(bool quick)
{
    if (quick)
        return {topDown("thesis: normal", false, false, false, false),
                builder("radix, 30 bits", TreeBuilder::Radix, 30), builder("ploc", TreeBuilder::Ploc, 30)};
    return {topDown("thesis: normal", false, false, false, false),
            topDown("thesis: adaptive groups", true, false, false, false),
            topDown("thesis: and small splits", true, true, false, false),
            topDown("thesis: all optimisations", true, true, true, false),
            topDown("thesis: all, median split", true, true, true, true),
            builder("balanced", TreeBuilder::Balanced, 30),
            builder("radix, 30 bits", TreeBuilder::Radix, 30),
            builder("radix, 63 bits", TreeBuilder::Radix, 63),
            builder("ploc", TreeBuilder::Ploc, 30)};
}

std::vector<TreeVariant> treeRules(bool quick)
{
    std::vector<TreeVariant> rules;
    for (const TreeVariant& variant : treeVariants(quick))
    {
        if (!rules.empty() && rules.back().m_rule == variant.m_rule) rules.pop_back();
        rules.push_back(variant);
    }
    return rules;
}

std::unique_ptr<Device> openStudyDevice(const StudyOptions& options)
{
    Error error;
    const DeviceChoice choice = chooseDevice(options.settings(), error);
    if (error.failed()) throw std::runtime_error(error.text());
    if (choice.m_onHost) return nullptr;
    std::unique_ptr<Device> device = Device::open(choice.m_index, error, true);
    if (!device) throw std::runtime_error(error.text());
    return device;
}

TreeInput::TreeInput(const TriangleMesh& mesh)
    : m_triangles(buildTopology(mesh.m_triangles.data(), mesh.triangleCount(), mesh.vertexCount()).m_triangles),
      m_positions(mesh.m_positions),
      m_moved(refitPositions(mesh.m_positions))
{
}

void TreeInput::upload(Device& device)
{
    m_triangleBuffer.assign(device, m_triangles);
    m_positionBuffer.assign(device, m_positions);
}

ClothQueries clothQueries(const TriangleMesh& obstacle)
{
    SceneSpec spec;
    spec.m_cells = 32;
    spec.m_size = 2.4;
    spec.m_thickness = kThickness;
    ClothQueries queries;
    queries.m_scene = makeStepScene(spec, obstacle);
    const StepScene& scene = queries.m_scene;
    queries.m_triangles = TreeInput(scene.m_cloths.front()).m_triangles;
    queries.m_nodes.resize(queries.m_triangles.size());
    for (std::size_t i = 0; i < queries.m_nodes.size(); ++i)
    {
        Dop dop;
        triangleVolume(&dop, &queries.m_triangles[i], scene.start(0), scene.end(0), contactReach(scene));
        dopStore(&queries.m_nodes[i], &dop);
        queries.m_nodes[i].m_first = std::uint32_t(i);
    }
    return queries;
}

std::string treeHash(const Tree& tree)
{
    return hashText(hashOf(tree.m_nodes, hashOf(tree.m_order)));
}

bool isValid(const Tree& tree, const TreeInput& input, bool moved)
{
    const float* positions = (moved ? input.m_moved : input.m_positions).data();
    const std::string reason = whyInvalid(tree.m_nodes, 0, tree.m_order, input.m_triangles, positions, {0.0f});
    if (!reason.empty()) std::cerr << "study: not a valid tree: " << reason << std::endl;
    return reason.empty();
}

Row treeRow(const char* part, const std::string& model, std::size_t triangles, const std::string& variant)
{
    Row row;
    row["part"] = part;
    row["model"] = model;
    row["triangles"] = triangles;
    row["variant"] = variant;
    return row;
}
}  // namespace drape::bench
