#include <algorithm>
#include <limits>

#include "study/programs/peer_trees.h"
#include "study/programs/study.h"
#include "benchmarks/support/result_hash.h"

namespace drape::bench
{
namespace
{
void addPeerRow(const PeerTree& tree, const char* part, const Samples& samples, const std::string& hash,
                const std::string& model, const TriangleMesh& mesh, Table& table)
{
    if (samples.empty()) return;
    Row row;
    row["part"] = part;
    row["model"] = model;
    row["triangles"] = mesh.triangleCount();
    row["variant"] = tree.m_name;
    row["backend"] = tree.m_name.substr(0, tree.m_name.find('_'));
    row["device"] = "host";
    row["driver"] = tree.m_driver;
    row["threads"] = tree.m_threads;
    samples.fill(row);
    row["hash"] = hash;
    judgeRow(row, boundsHash(mesh));
    table.add(row);
}
}  // namespace

std::string boundsHash(const float* low, const float* high)
{
    return hashText(hashBytes(hashBytes(kEmptyHash, low, 3 * sizeof(float)), high, 3 * sizeof(float)));
}

std::string boundsHash(const TriangleMesh& mesh)
{
    float low[3], high[3];
    for (int axis = 0; axis < 3; ++axis)
    {
        low[axis] = std::numeric_limits<float>::infinity();
        high[axis] = -low[axis];
    }
    for (const std::int32_t vertex : mesh.m_triangles)
    {
        for (int axis = 0; axis < 3; ++axis)
        {
            const float x = mesh.m_positions[3 * static_cast<std::size_t>(vertex) + static_cast<std::size_t>(axis)];
            low[axis] = std::min(low[axis], x);
            high[axis] = std::max(high[axis], x);
        }
    }
    return boundsHash(low, high);
}

void studyPeerTrees(const StudyOptions& options, Table& table)
{
    forEachModel(options,
                 [&](const std::string& model, const TriangleMesh& mesh)
                 {
                     TriangleMesh moved = mesh;
                     moved.m_positions = refitPositions(mesh.m_positions);
                     std::vector<PeerTree> trees =
                         measureEmbreeTrees(mesh, moved, options.m_repeats, options.m_seconds);
                     trees.push_back(measureFclTree(mesh, moved, options.m_repeats, options.m_seconds));
                     for (const PeerTree& tree : trees)
                     {
                         addPeerRow(tree, "construction", tree.m_build, tree.m_buildHash, model, mesh, table);
                         addPeerRow(tree, "refit", tree.m_refit, tree.m_refitHash, model, moved, table);
                     }
                 });
}

const std::vector<Part>& studyParts()
{
    static const std::vector<Part> parts = {
        {"peers", "construction and refit by Embree and FCL, beside tables 4.2 to 4.4", studyPeerTrees},
        {"construction", "every builder: tables 4.2 and 4.3, figures 4.2 to 4.5", studyConstruction},
        {"refit", "every refit: table 4.4 and figure 4.10", studyRefit},
        {"quality", "the trees' quality against the time to build them", studyQuality},
        {"shape", "two or four children, leaves of 1 to 16", studyShapes},
        {"degree", "trees and whole steps in volumes of this program's sides", studyDegrees},
        {"traversal", "every traversal step by step as a cloth comes down: figures 4.6 and 4.8", studyTraversals},
        {"builder", "whole steps of the host over trees of each builder", studyBuilders},
        {"obstacles", "steps in which obstacles come, go and move beside one that rests", studyObstacles},
        {"triangle_tests", "Möller's test beside the certified one: figure 4.9", studyTriangleTests}};
    return parts;
}
}  // namespace drape::bench
