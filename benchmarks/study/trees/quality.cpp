// Quality of the builders' trees: cost, volume, and what a cloth's step meets in them, against the time to build them.
#include <iostream>

#include "benchmarks/study/trees/tree_input.h"
#include "bullet_plugin/core/bvh/tree_quality.h"
#include "kernels/lib/dop.h"

namespace drape::bench
{
namespace
{
// Volume tests when every triangle of the thesis's cloth, draped over the model, looks for its candidates from the
// root. Also counts the candidates, which must be the same for every tree.
struct Visits
{
    std::size_t m_tests = 0, m_candidates = 0;
};

Visits countVisits(const Tree& tree, const std::vector<BvhNode>& queries)
{
    Visits visits;
    std::vector<std::uint32_t> stack;
    for (const BvhNode& query : queries)
    {
        stack.assign(1, 0u);
        while (!stack.empty())
        {
            const BvhNode& node = tree.m_nodes[stack.back()];
            stack.pop_back();
            ++visits.m_tests;
            if (!nodesOverlap(&query, &node)) continue;
            if (node.m_count == 0) ++visits.m_candidates;
            for (std::uint32_t child = 0; child < node.m_count; ++child)
                stack.push_back(node.m_first + child);
        }
    }
    return visits;
}

// The construction part's row of this variant, for its times; the host's where there is no device.
const Row* timesOf(const Table& table, const std::string& model, const TreeVariant& variant)
{
    const Row* found = nullptr;
    for (const Row& row : table.rows())
    {
        if (row["part"] != "construction" || row["model"] != model || !row.contains("median_ms")) continue;
        if (row["variant"] == "host, " + variant.m_rule) found = &row;
        if (row["variant"] == variant.m_name) return &row;
    }
    return found;
}
}  // namespace

void studyQuality(const StudyOptions& options, Table& table)
{
    const auto measure = [&](const std::string& model, const TriangleMesh& mesh)
    {
        if (!options.m_quick && model != "bunny" && model != "dragon" && model != "spot") return;
        const TreeInput input(mesh);
        const std::vector<BvhNode> queries = clothQueries(mesh).m_nodes;
        std::size_t candidates = 0;
        for (const TreeVariant& rule : treeRules(options.m_quick))
        {
            const Tree tree = buildTreeOnHost(rule.m_methods, input.m_triangles, input.m_positions.data(), 1);
            const TreeQuality quality = measureTree(tree.m_nodes, 0);
            const Visits visits = countVisits(tree, queries);
            if (candidates == 0) candidates = visits.m_candidates;
            Row row = treeRow("quality", model, input.triangleCount(), rule.m_rule);
            row["cost"] = quality.m_cost;
            row["volume_m3"] = quality.m_volume;
            row["height"] = quality.m_height;
            row["visits"] = visits.m_tests;
            row["candidates"] = visits.m_candidates;
            const Row* times = timesOf(table, model, rule);
            for (const char* column : {"median_ms", "kernel_median_ms"})
            {
                if (times && times->contains(column)) row[column] = (*times)[column];
            }
            row["hash"] = std::to_string(visits.m_candidates);
            judgeRow(row, std::to_string(candidates));
            table.add(row);
        }
    };
    forEachModel(options, measure);
}
}  // namespace drape::bench
