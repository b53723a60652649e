// Pairs of triangles by Möller's test, as in the thesis, and by the certified one: figure 4.9.
#include <algorithm>
#include <stdexcept>

#include "study/programs/study.h"
#include "study/programs/trees/tree_input.h"
#include "benchmarks/support/machine.h"
#include "benchmarks/support/result_hash.h"
#include "bullet_plugin/core/device/bound_kernel.h"
#include "kernels/lib/queries/triangle_pair.h"
#include "kernels/queries/queries_bindings.h"
#include "study/kernels/lib/moller.h"
#include "scenes/random.h"

namespace drape::kernels
{
DRAPE_BIND(mollerTriangles, DRAPE_QUERY_TRIANGLES)
}  // namespace drape::kernels

namespace drape::bench
{
namespace
{
constexpr std::size_t kGroup = 64;

// Triangles of the mesh and a near one each, moved by up to the first one's size, so that a good part of them meets.
std::vector<TriangleQuery> pairsOf(const TriangleMesh& mesh, std::size_t count)
{
    Random random(4900);
    std::vector<TriangleQuery> pairs(count);
    const auto corner = [&](std::size_t triangle, int i)
    { return mesh.m_positions.data() + 3 * std::size_t(mesh.m_triangles[3 * triangle + std::size_t(i)]); };
    for (std::size_t p = 0; p < count; ++p)
    {
        const std::size_t first = p % mesh.triangleCount();
        const std::size_t second = (first + 1 + p / mesh.triangleCount()) % mesh.triangleCount();
        for (int axis = 0; axis < 3; ++axis)
        {
            const float size = corner(first, 1)[axis] - corner(first, 0)[axis];
            const float shift =
                corner(first, 0)[axis] - corner(second, 0)[axis] + static_cast<float>(random.within(-1, 1)) * size;
            for (int i = 0; i < 3; ++i)
            {
                pairs[p].m_a[3 * i + axis] = corner(first, i)[axis];
                pairs[p].m_b[3 * i + axis] = corner(second, i)[axis] + shift;
            }
        }
    }
    return pairs;
}

struct Test
{
    std::string m_name;
    bool m_moller;
};
const Test kTests[] = {{"Möller", true}, {"certified", false}};

void addRow(const Test& test, std::size_t pairs, const std::vector<cl_uint>& answers, const Samples& times,
            const Samples& kernels, const DeviceInfo* device, const std::string& expected, Table& table)
{
    Row row = treeRow("triangle_tests", "bunny", 0, test.m_name);
    row.erase("triangles");
    row["backend"] = device ? "opencl" : "host";
    if (device)
        fillDevice(row, *device);
    else
        row["device"] = "host";
    row["threads"] = device ? 0 : 1;
    row["pairs"] = pairs;
    row["hits"] = answers.size() - static_cast<std::size_t>(std::count(answers.begin(), answers.end(), 0u));
    row["hash"] = hashText(hashOf(answers));
    times.fill(row);
    kernels.fill(row, "kernel_");
    judgeRow(row, expected);
    table.add(row);
}

cl_uint answerOf(const TriangleQuery& pair, const Test& test)
{
    FeatureTriangle a, b;
    for (std::uint32_t i = 0; i < 3; ++i)
    {
        a.m_p[i] = vec3Load(pair.m_a, i);
        b.m_p[i] = vec3Load(pair.m_b, i);
    }
    return cl_uint(test.m_moller ? mollerIntersect(a, b) != 0
                                 : (trianglePairTest(a.m_p, b.m_p, -1.0f) & DRAPE_PAIR_MEETS) != 0);
}

std::vector<cl_uint> onHost(const StudyOptions& options, const std::vector<TriangleQuery>& pairs, const Test& test,
                            Samples& times)
{
    std::vector<cl_uint> answers(pairs.size());
    times = repeat(2, std::size_t(options.m_repeats), options.m_seconds,
                   [&]
                   {
                       const Clock::time_point start = Clock::now();
                       for (std::size_t i = 0; i < pairs.size(); ++i)
                           answers[i] = answerOf(pairs[i], test);
                       return millisecondsSince(start);
                   });
    return answers;
}

class DeviceTriangles
{
public:
    DeviceTriangles(Device& device, const Test& test) : m_device(device), m_usesMoller(test.m_moller)
    {
        const ProgramLoader load = studyPrograms(device);
        if (m_usesMoller)
            m_moller.create(device, load("moller"));
        else
            m_certified.create(device, load("queries/queries"));
    }

    // Pairs to the device, answers back. Host-to-host ms; kernelMs: of the launch.
    double run(const std::vector<TriangleQuery>& pairs, std::vector<cl_uint>& answers, double& kernelMs)
    {
        m_queries.reserve(m_device, pairs.size());
        m_answers.reserve(m_device, pairs.size());
        answers.resize(pairs.size());
        m_device.wait();
        m_device.profiler()->take();
        const Clock::time_point start = Clock::now();
        m_queries.write(m_device, pairs.data(), pairs.size());
        const cl_uint count = cl_uint(pairs.size());
        if (m_usesMoller)
            m_moller.launch(m_device, count, kGroup, count, m_queries, m_answers);
        else
            m_certified.launch(m_device, count, kGroup, count, m_queries, m_answers);
        m_answers.read(m_device, answers.data(), answers.size());
        m_device.wait();
        const double ms = millisecondsSince(start);
        kernelMs = totalMs(m_device.profiler()->take());
        if (m_device.failed()) throw std::runtime_error(m_device.error().text());
        return ms;
    }

private:
    Device& m_device;
    bool m_usesMoller;
    BoundKernel<kernels::mollerTriangles> m_moller;
    BoundKernel<kernels::queryTriangles> m_certified;
    Buffer<TriangleQuery> m_queries;
    Buffer<cl_uint> m_answers;
};
}  // namespace

void studyTriangleTests(const StudyOptions& options, Table& table)
{
    TriangleMesh mesh;
    if (!options.wants("bunny") || options.tooLate("triangle tests")) return;
    if (!loadModel(options.m_quick ? "sphere_1k" : "bunny", options, mesh)) return;
    const std::unique_ptr<Device> device = openStudyDevice(options);
    for (const std::size_t count : {1000u, 10000u, 100000u, 1000000u})
    {
        if (options.m_quick && count > 1000) break;
        const std::vector<TriangleQuery> pairs = pairsOf(mesh, count);
        for (const Test& test : kTests)
        {
            Samples times;
            std::vector<cl_uint> answers = onHost(options, pairs, test, times);
            const std::string expected = hashText(hashOf(answers));
            addRow(test, count, answers, times, Samples(), nullptr, expected, table);
            if (!device) continue;
            DeviceTriangles stage(*device, test);
            double kernelMs = 0;
            stage.run(pairs, answers, kernelMs);  // some drivers compile at the first launch
            Samples kernels;
            times = repeat(2, std::size_t(options.m_repeats), options.m_seconds,
                           [&]
                           {
                               const double ms = stage.run(pairs, answers, kernelMs);
                               kernels.add(kernelMs);
                               return ms;
                           });
            addRow(test, count, answers, times, kernels, &device->info(), expected, table);
        }
    }
}
}  // namespace drape::bench
