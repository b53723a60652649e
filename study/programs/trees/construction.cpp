// Construction: tables 4.2 and 4.3, figures 4.2 to 4.5.
#include <algorithm>
#include <stdexcept>

#include "study/programs/trees/tree_work.h"
#include "benchmarks/support/machine.h"
#include "study/trees/tree_quality.h"

namespace drape::bench
{
// The first build lets buffers grow and drivers compile; it is not counted.
Samples buildOnOneThread(const TreeInput& input, const TreeMethods& methods, const StudyOptions& options, Tree& tree)
{
    return repeat(1, std::size_t(options.m_repeats), options.m_seconds,
                  [&]
                  {
                      const Clock::time_point start = Clock::now();
                      tree = buildTreeOnHost(methods, input.m_triangles, input.m_positions.data(), 1);
                      return millisecondsSince(start);
                  });
}

Builds buildOnDevice(Device& device, TreeInput& input, const TreeMethods& methods, const StudyOptions& options)
{
    TreeBuilderStage stage;
    stage.create(device, studyPrograms(device), methods);
    DeviceTree tree;
    const auto once = [&]
    {
        device.profiler()->take();
        const Clock::time_point start = Clock::now();
        input.upload(device);
        stage.enqueue(device, input.m_triangleBuffer, input.m_positionBuffer, cl_uint(input.triangleCount()), 1, tree);
        device.wait();
        return millisecondsSince(start);
    };
    once();
    Builds builds;
    builds.m_host = repeat(2, std::size_t(options.m_repeats), options.m_seconds,
                           [&]
                           {
                               const double ms = once();
                               builds.m_launches.push_back(device.profiler()->take());
                               builds.m_kernels.add(totalMs(builds.m_launches.back()));
                               return ms;
                           });
    builds.m_levels = stage.topDownLevels();
    builds.m_hash = treeHash(tree.download(device));
    if (device.failed()) throw std::runtime_error(device.error().text());
    return builds;
}

namespace
{
// Share of the compaction in the kernels' time (figure 4.5).
void addCompaction(const Builds& builds, Row row, Table& table)
{
    Samples shares;
    for (const std::vector<KernelTime>& launches : builds.m_launches)
    {
        double compaction = 0;
        for (const KernelTime& launch : launches)
            compaction += launch.m_kernel.rfind("topDownCompact", 0) == 0 ? launch.m_ms : 0;
        shares.add(compaction / totalMs(launches));
    }
    row["part"] = "compaction";
    row["share"] = shares.median();
    table.add(row);
}

// Time per level (figures 4.2 to 4.4): a level's launches follow one another, and the stage says how many each had.
void addLevels(const Builds& builds, const Row& input, Table& table)
{
    std::size_t counted = 0, first = 0;
    for (const TopDownLevel& level : builds.m_levels)
        counted += level.m_launches;
    for (std::size_t depth = 0; depth < builds.m_levels.size(); ++depth)
    {
        const TopDownLevel& level = builds.m_levels[depth];
        Samples times;
        for (const std::vector<KernelTime>& launches : builds.m_launches)
        {
            double sum = 0;
            for (std::size_t i = first; i < std::min(first + level.m_launches, launches.size()); ++i)
                sum += launches[i].m_ms;
            times.add(sum);
        }
        first += level.m_launches;
        Row row = input;
        row["part"] = "levels";
        row["level"] = depth;
        row["nodes"] = level.m_nodes;
        row["small_nodes"] = level.m_smallNodes;
        row["group_size"] = level.m_groupSize;
        row["large_nodes"] = level.m_largeNodes;
        times.fill(row, "kernel_");
        table.add(row);
    }
}

// Time per kernel, all its launches of a build together.
void addKernels(const Builds& builds, const Row& input, Table& table)
{
    std::map<std::string, Samples> times;
    for (const std::vector<KernelTime>& launches : builds.m_launches)
    {
        std::map<std::string, double> sums;
        for (const KernelTime& launch : launches)
            sums[launch.m_kernel] += launch.m_ms;
        for (const auto& sum : sums)
            times[sum.first].add(sum.second);
    }
    for (const auto& kernel : times)
    {
        Row row = input;
        row["part"] = "construction_kernels";
        row["kernel"] = kernel.first;
        kernel.second.fill(row, "kernel_");
        table.add(row);
    }
}

// A row a rule, void where its tree is not a valid one.
std::map<std::string, Row> buildOnHost(const std::string& model, const TreeInput& input, const StudyOptions& options)
{
    std::map<std::string, Row> rows;
    for (const TreeVariant& rule : treeRules(options.m_quick))
    {
        Tree tree;
        const Samples times = buildOnOneThread(input, rule.m_methods, options, tree);
        Row row = treeRow("construction", model, input.triangleCount(), "host, " + rule.m_rule);
        row["backend"] = "host";
        row["device"] = "host";
        row["threads"] = 1;
        times.fill(row);
        row["hash"] = treeHash(tree);
        judgeRow(row, isValid(tree, input) ? treeHash(tree) : kNoValidTree);
        rows[rule.m_rule] = row;
    }
    return rows;
}

// A device's builds of one variant; false where its tree is not the host's, or the host's no valid one.
bool addBuilds(const Builds& builds, const TreeVariant& variant, Row row, const Row& host, Table& table)
{
    row["hash"] = builds.m_hash;
    row["valid"] = "yes";  // if the next one is
    Row times = row;
    builds.m_host.fill(times);
    builds.m_kernels.fill(times, "kernel_");
    judgeRow(times, host["valid"] == "yes" ? std::string(host["hash"]) : kNoValidTree);
    table.add(times);
    if (times["valid"] == "no") return false;
    if (builds.m_levels.empty())
    {
        addKernels(builds, row, table);
        return true;
    }
    addLevels(builds, row, table);
    if (variant.m_name == "thesis: all optimisations") addCompaction(builds, row, table);
    return true;
}

// Every variant on the device. A host's row is void, too, where the tree of none of its rule's variants is the host's.
void addDeviceRows(Device& device, TreeInput& input, const std::string& model, std::map<std::string, Row>& host,
                   const StudyOptions& options, Table& table)
{
    std::map<std::string, bool> agreed;
    for (const TreeVariant& variant : treeVariants(options.m_quick))
    {
        if (options.tooLate(model + ", " + variant.m_name)) continue;
        const Builds builds = buildOnDevice(device, input, variant.m_methods, options);
        Row row = treeRow("construction", model, input.triangleCount(), variant.m_name);
        row["backend"] = "opencl";
        fillDevice(row, device.info());
        row["threads"] = 0;
        const bool same = addBuilds(builds, variant, row, host.at(variant.m_rule), table);
        agreed[variant.m_rule] = agreed[variant.m_rule] || same;
    }
    for (const auto& rule : agreed)
    {
        if (!rule.second) judgeRow(host.at(rule.first), "that of the device's tree");
    }
}
}  // namespace

void studyConstruction(const StudyOptions& options, Table& table)
{
    const std::unique_ptr<Device> device = openStudyDevice(options);
    const auto measure = [&](const std::string& model, const TriangleMesh& mesh)
    {
        TreeInput input(mesh);
        std::map<std::string, Row> host = buildOnHost(model, input, options);
        Table onDevice;
        if (device) addDeviceRows(*device, input, model, host, options, onDevice);
        for (const TreeVariant& rule : treeRules(options.m_quick))
            table.add(host.at(rule.m_rule));
        for (const Row& row : onDevice.rows())
            table.add(row);
    };
    forEachModel(options, measure);
}
}  // namespace drape::bench
