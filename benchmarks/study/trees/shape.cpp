// The shape of nodes: two or four children, leaves alone or in bundles; and with another DRAPE_DOP of the build,
// volumes of 6, 14 or 26 sides. What a cloth's step meets in them, how long it takes, and the refit.
#include <algorithm>
#include <stdexcept>

#include "benchmarks/study/trees/tree_input.h"
#include "benchmarks/support/machine.h"
#include "benchmarks/support/result_hash.h"
#include "bullet_plugin/core/broad_phase/broad_phase.h"
#include "bullet_plugin/core/bvh/refit.h"
#include "bullet_plugin/core/bvh/tree_quality.h"
#include "bullet_plugin/core/bvh/wide_nodes.h"
#include "bullet_plugin/core/narrow_phase/narrow_phase.h"
#include "kernels/lib/dop.h"

namespace drape::bench
{
namespace
{
// A tree in one shape, as both back ends refit and walk it.
struct Shape
{
    Shape(const Tree& tree, std::uint32_t degree, std::uint32_t bundle)
        : m_layout(makeBvhLayout(reshape(tree, degree, bundle), 0)),
          m_nodes(makeBvhNodes(m_layout)),
          m_order(tree.m_order)
    {
    }
    Hierarchy hierarchy() const { return {m_nodes, m_layout.root(), m_order}; }

    BvhLayout m_layout;
    std::vector<BvhNode> m_nodes;
    const std::vector<std::uint32_t>& m_order;
};

struct Found
{
    std::size_t m_tests = 0;
    std::vector<Candidate> m_candidates;

    std::string hash()
    {
        sortCandidates(m_candidates);
        return hashText(hashOf(m_candidates));
    }
};

void walk(const Shape& shape, const ClothQueries& cloth, Found& found)
{
    std::vector<std::uint32_t> stack;
    found = Found();
    for (const BvhNode& query : cloth.m_nodes)
    {
        stack.assign(1, shape.m_layout.root());
        while (!stack.empty())
        {
            const BvhNode& node = shape.m_nodes[stack.back()];
            stack.pop_back();
            ++found.m_tests;
            if (!nodesOverlap(&query, &node)) continue;
            if (node.m_count == 0) found.m_candidates.push_back({query.m_first, shape.m_order[node.m_first]});
            for (std::uint32_t child = 0; child < node.m_count; ++child)
                stack.push_back(node.m_first + child);
        }
    }
}

// Refits and walks a shape on a device: kernel times, and the candidates of the last walk.
class DeviceShape
{
public:
    DeviceShape(Device& device, TreeInput& input, const Shape& shape, const ClothQueries& cloth)
        : m_device(device), m_input(input), m_shape(shape)
    {
        const std::vector<float> zero(1, 0.0f);
        std::vector<std::uint32_t> order(cloth.m_nodes.size());
        for (std::uint32_t i = 0; i < order.size(); ++i)
            order[i] = i;
        m_refit.create(device, studyPrograms(device)("refit"));
        m_refit.makeLevels(device, shape.m_layout, m_levels);
        m_walk.create(device, Traversal::Leaves, studyPrograms(device));
        m_walk.setTopology(device, {cloth.m_nodes, 0, order}, shape.hierarchy());
        m_nodes.assign(device, shape.m_nodes);
        m_order.assign(device, shape.m_order);
        m_clothNodes.assign(device, cloth.m_nodes);
        m_clothOrder.assign(device, order);
        m_clothTriangles.assign(device, cloth.m_triangles);
        m_zero.assign(device, zero);
        m_counters.reserve(device, 1);
        input.upload(device);
        device.wait();
    }

    double refit()
    {
        m_device.profiler()->take();
        m_counters.fill(m_device, 0, 1);
        m_refit.enqueue(m_device, m_shape.m_layout, m_levels, m_nodes, m_order, m_input.m_triangleBuffer,
                        m_input.m_positionBuffer, m_input.m_positionBuffer, m_zero, m_counters);
        return finish();
    }

    // room: for candidates.
    double walk(std::size_t room)
    {
        m_device.profiler()->take();
        m_candidates.reserve(m_device, room);
        m_counters.fill(m_device, 0, 1);
        m_walk.enqueue(m_device, {{m_clothNodes, m_clothOrder, m_clothTriangles},
                                  {m_nodes, m_order, m_input.m_triangleBuffer},
                                  m_zero,
                                  1,
                                  m_candidates,
                                  m_counters});
        return finish();
    }

    std::string hash()
    {
        StepCounters counters = {};
        m_counters.read(m_device, &counters, 1);
        m_device.wait();
        Found found;
        found.m_candidates.resize(std::min<std::size_t>(counters.m_candidates, m_candidates.capacity()));
        m_candidates.read(m_device, found.m_candidates.data(), found.m_candidates.size());
        m_device.wait();
        return found.hash();
    }

private:
    double finish()
    {
        m_device.wait();
        if (m_device.failed()) throw std::runtime_error(m_device.error().text());
        return totalMs(m_device.profiler()->take());
    }

    Device& m_device;
    TreeInput& m_input;
    const Shape& m_shape;
    RefitStage m_refit;
    RefitStage::Levels m_levels;
    BroadPhaseStage m_walk;
    Buffer<BvhNode> m_nodes, m_clothNodes;
    Buffer<cl_uint> m_order, m_clothOrder;
    Buffer<Triangle> m_clothTriangles;
    Buffer<float> m_zero;
    Buffer<Candidate> m_candidates;
    Buffer<StepCounters> m_counters;
};

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
    row["height"] = measureTree(shape.m_nodes, shape.m_layout.root()).m_height;
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
    std::size_t ignored = 0;
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
    {
        refitOnHost(shape.m_nodes, shape.m_layout, shape.m_order, input.m_triangles, input.m_positions.data(),
                    input.m_positions.data(), noRadius, ignored);
    };
    fillTimes(
        row, options, [&] { return timed(refit); }, [&] { return timed([&] { walk(shape, cloth, found); }); });
    row["visits"] = found.m_tests;
    row["candidates"] = found.m_candidates.size();
    row["hash"] = found.hash();
    if (expected.empty()) expected = row["hash"];
    judgeRow(row, expected);
    table.add(row);
    if (!device) return;
    DeviceShape onDevice(*device, input, shape, cloth);
    onDevice.refit();
    const std::size_t room = found.m_candidates.size();
    onDevice.walk(room);
    row = described;
    row["backend"] = "opencl";
    fillDevice(row, device->info());
    row["threads"] = 0;
    fillTimes(
        row, options, [&] { return onDevice.refit(); }, [&] { return onDevice.walk(room); });
    row["visits"] = found.m_tests;
    row["hash"] = onDevice.hash();
    judgeRow(row, expected);
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
