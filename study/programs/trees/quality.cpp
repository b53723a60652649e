// Quality of the builders' trees: cost, volume, and what a cloth's step meets in them, against the time to build them.
#include "study/programs/trees/tree_walk.h"
#include "study/programs/trees/tree_work.h"
#include "study/trees/tree_quality.h"

namespace drape::bench
{
namespace
{
// The construction part's row of this variant, for its times.
const Row* timesOf(const Table& table, const std::string& model, const std::string& variant)
{
    for (const Row& row : table.rows())
    {
        if (row["part"] == "construction" && row["model"] == model && row["variant"] == variant &&
            row.contains("median_ms"))
            return &row;
    }
    return nullptr;
}

// Times to build: those of the part "construction" where that was measured before, else measured here; the host's where
// there is no device. Returns treeHash() of what was built.
std::string fillBuildTimes(Row& row, const TreeVariant& variant, Device* device, TreeInput& input,
                           const StudyOptions& options, const Table& table)
{
    const std::string model = row["model"];
    if (const Row* times = timesOf(table, model, device ? variant.m_name : "host, " + variant.m_rule))
    {
        for (const char* column : {"median_ms", "kernel_median_ms"})
        {
            if (times->contains(column)) row[column] = (*times)[column];
        }
        return (*times)["hash"];
    }
    if (device)
    {
        const Builds builds = buildOnDevice(*device, input, variant.m_methods, options);
        row["median_ms"] = builds.m_host.median();
        row["kernel_median_ms"] = builds.m_kernels.median();
        return builds.m_hash;
    }
    Tree tree;
    row["median_ms"] = buildOnOneThread(input, variant.m_methods, options, tree).median();
    return treeHash(tree);
}
}  // namespace

void studyQuality(const StudyOptions& options, Table& table)
{
    const std::unique_ptr<Device> device = openStudyDevice(options);
    const auto measure = [&](const std::string& model, const TriangleMesh& mesh)
    {
        TreeInput input(mesh);
        const ClothQueries cloth = clothQueries(mesh);
        std::string expected;  // the first one's: all trees have the same leaves
        for (const TreeVariant& rule : treeRules(options.m_quick))
        {
            if (options.tooLate(model + ", " + rule.m_rule)) continue;
            const Tree tree = buildTreeOnHost(rule.m_methods, input.m_triangles, input.m_positions.data(), 1);
            const TreeQuality quality = measureTree(tree.m_nodes, 0);
            Found found;
            walkOnHost({tree.m_nodes, 0, tree.m_order}, cloth, found);
            Row row = treeRow("quality", model, input.triangleCount(), rule.m_rule);
            row["cost"] = quality.m_cost;
            row["volume_m3"] = quality.m_volume;
            row["height"] = quality.m_height;
            row["visits"] = found.m_tests;
            row["candidates"] = found.m_candidates.size();
            row["backend"] = device ? "opencl" : "host";
            // The tree that was walked must be the one that the times are of, and a right one.
            const std::string built = fillBuildTimes(row, rule, device.get(), input, options, table);
            const bool right = built == treeHash(tree) && isValid(tree, input);
            row["hash"] = found.hash();
            if (expected.empty() && right) expected = row["hash"];
            judgeRow(row, right ? expected : kNoValidTree);
            table.add(row);
        }
    };
    forEachModel(options, measure);
}
}  // namespace drape::bench
