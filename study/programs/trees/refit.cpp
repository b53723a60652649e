// Refit: table 4.4 and figure 4.10.
#include <stdexcept>

#include "study/programs/trees/tree_work.h"
#include "benchmarks/support/machine.h"

namespace drape::bench
{
namespace
{
// Refits one tree on a device.
class DeviceRefit
{
public:
    DeviceRefit(Device& device, TreeInput& input, const Tree& tree, RefitMethod method)
        : m_device(device), m_input(input)
    {
        m_stage.create(device, studyPrograms(device));
        m_tree.upload(device, tree);
        m_methods.m_refit = method;
        m_stage.prepare(device, m_tree, m_methods);
        const std::vector<float> noRadius(1, 0.0f);
        m_radius.assign(device, noRadius);
        m_counters.reserve(device, 1);
        m_counters.fill(device, 0, 1);
        m_input.upload(device);
        m_device.wait();
    }

    // New positions to the device, and a refit; waits. Host-to-host ms.
    double run()
    {
        m_device.profiler()->take();
        const Clock::time_point start = Clock::now();
        m_input.m_positionBuffer.write(m_device, m_input.m_moved.data(), m_input.m_moved.size());
        const LeafBuffers leaves = {m_input.m_triangleBuffer, m_input.m_positionBuffer, m_input.m_positionBuffer,
                                    m_radius, m_counters};
        m_stage.enqueue(m_device, m_tree, leaves, m_methods);
        m_device.wait();
        const double ms = millisecondsSince(start);
        m_launches = m_device.profiler()->take();
        if (m_device.failed()) throw std::runtime_error(m_device.error().text());
        return ms;
    }

    const std::vector<KernelTime>& launches() const { return m_launches; }
    std::string hash() { return treeHash(m_tree.download(m_device)); }

private:
    Device& m_device;
    TreeInput& m_input;
    TreeRefitStage m_stage;
    DeviceTree m_tree;
    TreeMethods m_methods;
    Buffer<float> m_radius;
    Buffer<StepCounters> m_counters;
    std::vector<KernelTime> m_launches;
};

}  // namespace

Refits refitOnDevice(Device& device, TreeInput& input, const Tree& tree, RefitMethod method,
                     const StudyOptions& options)
{
    DeviceRefit refit(device, input, tree, method);
    refit.run();  // some drivers compile at the first launch
    Refits refits;
    refits.m_host = repeat(2, std::size_t(options.m_repeats), options.m_seconds,
                           [&]
                           {
                               const double ms = refit.run();
                               refits.m_kernels.add(totalMs(refit.launches()));
                               refits.m_launches.resize(refit.launches().size());
                               for (std::size_t i = 0; i < refits.m_launches.size(); ++i)
                                   refits.m_launches[i].add(refit.launches()[i].m_ms);
                               return ms;
                           });
    for (const KernelTime& launch : refit.launches())
        refits.m_names.push_back(launch.m_kernel);
    refits.m_hash = refit.hash();
    return refits;
}

Refits refitOnOneThread(Tree tree, const TreeInput& input, const StudyOptions& options, bool& valid)
{
    const std::vector<float> noRadius(1, 0.0f);
    const float* moved = input.m_moved.data();
    std::size_t ignored = 0;
    Refits refits;
    refits.m_host = repeat(2, std::size_t(options.m_repeats), options.m_seconds,
                           [&]
                           {
                               const Clock::time_point start = Clock::now();
                               refitTreeOnHost(tree, input.m_triangles, moved, moved, noRadius, ignored);
                               return millisecondsSince(start);
                           });
    refits.m_hash = treeHash(tree);
    valid = isValid(tree, input, true);
    return refits;
}

namespace
{
struct RefitVariant
{
    const char* m_name;
    RefitMethod m_method;
};

// A launch's times: by height where there is one each (figure 4.10), else by kernel.
void addLaunches(const RefitVariant& variant, const Refits& refits, const Row& input, Table& table)
{
    const bool byHeight = variant.m_method == RefitMethod::Levels;
    for (std::size_t launch = 0; launch < refits.m_launches.size(); ++launch)
    {
        Row row = input;
        row["part"] = byHeight ? "refit_levels" : "refit_kernels";
        if (byHeight)
            row["level"] = launch;
        else
            row["kernel"] = refits.m_names[launch];
        refits.m_launches[launch].fill(row, "kernel_");
        table.add(row);
    }
}

void addDeviceRows(Device& device, TreeInput& input, const Tree& tree, const std::string& model,
                   const RefitVariant& variant, const std::string& expected, const StudyOptions& options, Table& table)
{
    const Refits refits = refitOnDevice(device, input, tree, variant.m_method, options);
    Row row = treeRow("refit", model, input.triangleCount(), variant.m_name);
    row["backend"] = "opencl";
    fillDevice(row, device.info());
    row["threads"] = 0;
    row["hash"] = refits.m_hash;
    row["valid"] = "yes";  // if the next one is
    const Row described = row;
    refits.m_host.fill(row);
    refits.m_kernels.fill(row, "kernel_");
    judgeRow(row, expected);
    table.add(row);
    if (row["valid"] == "yes") addLaunches(variant, refits, described, table);
}
}  // namespace

void studyRefit(const StudyOptions& options, Table& table)
{
    const std::unique_ptr<Device> device = openStudyDevice(options);
    const auto measure = [&](const std::string& model, const TriangleMesh& mesh)
    {
        TreeInput input(mesh);
        TreeMethods methods;
        methods.m_builder = TreeBuilder::Balanced;  // a device's default, the same for all
        const Tree tree = buildTreeOnHost(methods, input.m_triangles, input.m_positions.data(), 1);
        bool valid = false;
        const Refits host = refitOnOneThread(tree, input, options, valid);
        Row row = treeRow("refit", model, input.triangleCount(), "host");
        row["backend"] = "host";
        row["device"] = "host";
        row["threads"] = 1;
        row["hash"] = host.m_hash;
        host.m_host.fill(row);
        judgeRow(row, valid ? host.m_hash : kNoValidTree);
        table.add(row);
        if (!device) return;
        for (const RefitVariant& variant :
             {RefitVariant{"thesis: launch per level", RefitMethod::Levels}, {"subtrees", RefitMethod::Subtrees}})
            addDeviceRows(*device, input, tree, model, variant, valid ? host.m_hash : kNoValidTree, options, table);
    };
    forEachModel(options, measure);
}
}  // namespace drape::bench
