// The shape of nodes: two or four children, leaves alone or in bundles; and with another DRAPE_DOP of the build,
// volumes of 6, 14 or 26 sides. What a cloth's step meets in them, how long it takes, and the refit.
#include <algorithm>
#include <cstring>
#include <iostream>
#include <stdexcept>

#include "study/programs/trees/tree_walk.h"
#include "benchmarks/support/machine.h"
#include "study/trees/tree_quality.h"
#include "study/trees/wide_nodes.h"

namespace drape::bench
{
namespace
{
// A tree in one shape, as both back ends refit and walk it.
struct Shape
{
    Shape(const Tree& tree, std::uint32_t degree, std::uint32_t bundle)
        : m_nodes(reshape(tree, degree, bundle)), m_depths(depthsOf(m_nodes)), m_order(tree.m_order)
    {
    }
    Hierarchy hierarchy() const { return {m_nodes, 0, m_order}; }

    std::vector<BvhNode> m_nodes;
    std::vector<BvhHeight> m_depths;
    const std::vector<std::uint32_t>& m_order;
};

// Links alone.
std::vector<BvhNode> withoutVolumes(std::vector<BvhNode> nodes)
{
    for (BvhNode& node : nodes)
    {
        std::fill(std::begin(node.m_low), std::end(node.m_low), 0.0f);
        std::fill(std::begin(node.m_high), std::end(node.m_high), 0.0f);
    }
    return nodes;
}

// Refits and walks a shape on a device: kernel times.
class DeviceShape
{
public:
    // room: for candidates.
    DeviceShape(Device& device, TreeInput& input, const Shape& shape, const ClothQueries& cloth, std::size_t room)
        : m_device(device), m_input(input), m_shape(shape), m_walk(device, shape.hierarchy(), cloth, room)
    {
        m_refit.create(device, studyPrograms(device));
        const std::vector<BvhNode> empty = withoutVolumes(shape.m_nodes);  // the host's are refitted already
        m_nodes.assign(device, empty);
        m_order.assign(device, shape.m_order);
        input.upload(device);
        device.wait();
    }

    double refit()
    {
        m_device.profiler()->take();
        m_refit.enqueue(m_device, m_shape.m_depths, m_nodes, m_order, m_input.m_triangleBuffer,
                        m_input.m_positionBuffer);
        m_device.wait();
        if (m_device.failed()) throw std::runtime_error(m_device.error().text());
        return totalMs(m_device.profiler()->take());
    }

    double walk()
    {
        double kernelMs = 0;
        m_walk.run(m_nodes, m_order, kernelMs);
        return kernelMs;
    }

    std::string hash() { return m_walk.found().hash(); }
    // Returns the nodes that the last refit left.
    std::vector<BvhNode> nodes()
    {
        std::vector<BvhNode> nodes(m_shape.m_nodes.size());
        m_nodes.read(m_device, nodes.data(), nodes.size());
        m_device.wait();
        return nodes;
    }

private:
    Device& m_device;
    TreeInput& m_input;
    const Shape& m_shape;
    DeviceWalk m_walk;
    WideRefitStage m_refit;
    Buffer<BvhNode> m_nodes;
    Buffer<cl_uint> m_order;
};

bool sameNodes(const std::vector<BvhNode>& a, const std::vector<BvhNode>& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(BvhNode)) == 0;
}

// Refit and walk as often as the options say. Each takes no argument and returns ms.
template <typename Refit, typename Walk>
void fillTimes(Row& row, const StudyOptions& options, Refit refit, Walk walk)
{
    const Samples refits = repeat(2, std::size_t(options.m_repeats), options.m_seconds, refit);
    refits.fill(row, "refit_");
    repeat(2, std::size_t(options.m_repeats), options.m_seconds, walk).fill(row);
}

Row rowOf(const std::string& model, const TreeInput& input, const Shape& shape, std::uint32_t degree,
          std::uint32_t bundle)
{
    Row row = treeRow("shape", model, input.triangleCount(),
                      std::to_string(degree) + " children, leaves of " + std::to_string(bundle));
    row["dop"] = 2 * DRAPE_DOP_DIRECTIONS;
    row["degree"] = degree;
    row["leaf_size"] = bundle;
    row["nodes"] = shape.m_nodes.size();
    row["height"] = measureTree(shape.m_nodes, 0).m_height;
    return row;
}

void studyShape(const std::string& model, TreeInput& input, const Tree& tree, const ClothQueries& cloth,
                std::pair<std::uint32_t, std::uint32_t> degreeAndBundle, Device* device, std::string& expected,
                const StudyOptions& options, Table& table)
{
    const auto [degree, bundle] = degreeAndBundle;
    Shape shape(tree, degree, bundle);
    const std::vector<float> noRadius(1, 0.0f);
    Found found;
    const Row described = rowOf(model, input, shape, degree, bundle);
    Row row = described;
    row["backend"] = "host";
    row["device"] = "host";
    row["threads"] = 1;
    const auto timed = [](auto work)
    {
        const Clock::time_point start = Clock::now();
        work();
        return millisecondsSince(start);
    };
    const auto refit = [&]
    { refitWideOnHost(shape.m_nodes, shape.m_order, input.m_triangles, input.m_positions.data()); };
    fillTimes(
        row, options, [&] { return timed(refit); },
        [&] { return timed([&] { walkOnHost(shape.hierarchy(), cloth, found); }); });
    row["visits"] = found.m_tests;
    row["candidates"] = found.m_candidates.size();
    row["hash"] = found.hash();
    if (expected.empty()) expected = row["hash"];
    const std::string wrong =
        whyInvalid(shape.m_nodes, 0, shape.m_order, input.m_triangles, input.m_positions.data(), noRadius);
    if (!wrong.empty()) std::cerr << "study: " << model << ", " << row["variant"] << ": " << wrong << "\n";
    judgeRow(row, wrong.empty() ? expected : kNoValidTree);
    table.add(row);
    if (!device) return;
    DeviceShape onDevice(*device, input, shape, cloth, found.m_candidates.size());
    onDevice.refit();
    onDevice.walk();
    row = described;
    row["backend"] = "opencl";
    fillDevice(row, device->info());
    row["threads"] = 0;
    fillTimes(
        row, options, [&] { return onDevice.refit(); }, [&] { return onDevice.walk(); });
    row["visits"] = found.m_tests;
    row["hash"] = onDevice.hash();
    const bool same = wrong.empty() && sameNodes(onDevice.nodes(), shape.m_nodes);
    judgeRow(row, same ? expected : kNoValidTree);
    table.add(row);
}
}  // namespace

void studyShapes(const StudyOptions& options, Table& table)
{
    const std::unique_ptr<Device> device = openStudyDevice(options);
    const auto measure = [&](const std::string& model, const TriangleMesh& mesh)
    {
        TreeInput input(mesh);
        TreeMethods methods;
        methods.m_builder = TreeBuilder::Radix;
        const Tree tree = buildTreeOnHost(methods, input.m_triangles, input.m_positions.data(), 1);
        const ClothQueries cloth = clothQueries(mesh);
        std::string expected;  // the first one's: shapes change no volume of a leaf
        for (const std::uint32_t degree : {2u, 4u})
        {
            for (const std::uint32_t bundle : {1u, 2u, 4u, 8u, 16u})
            {
                if (options.tooLate(model + ", leaves of " + std::to_string(bundle))) continue;
                studyShape(model, input, tree, cloth, {degree, bundle}, device.get(), expected, options, table);
            }
        }
    };
    forEachModel(options, measure);
}
}  // namespace drape::bench
