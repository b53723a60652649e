// Volumes of 6, 14, 18 and 26 sides: what a tree of them costs to build, to refit and to keep, what a cloth's step
// meets in it, and whole steps. The sides are the build's (DRAPE_DOP): a program a degree, whose contacts must be the
// same.
#include <numeric>
#include <stdexcept>

#include "study/programs/descent.h"
#include "study/programs/trees/tree_walk.h"
#include "study/programs/trees/tree_work.h"
#include "benchmarks/support/machine.h"
#include "scenes/models.h"
#include "benchmarks/support/peer_scene.h"
#include "benchmarks/support/result_hash.h"
#include "benchmarks/support/step_method.h"
#include "study/trees/tree_quality.h"

namespace drape::bench
{
namespace
{
Row degreeRow(const std::string& model, std::size_t triangles, const std::string& what)
{
    constexpr int kSides = 2 * DRAPE_DOP_DIRECTIONS;
    Row row = treeRow("degree", model, triangles, std::to_string(kSides) + "-DOP, " + what);
    row["dop"] = kSides;
    return row;
}

// Other sides' contacts are judged by those of the product's, which without a reference are the first result's.
class Judge
{
public:
    Judge(const StudyOptions& options, const std::string& model) : m_expected(options.expectedHash("degree", model)) {}

    // False where there is nothing to judge a model by.
    bool canJudge() const { return !m_expected.empty() || 2 * DRAPE_DOP_DIRECTIONS == kProductSides; }
    // right: whether what else the row is about is; where it is not, the row is void.
    void judge(Row& row, bool right = true)
    {
        if (m_expected.empty() && right) m_expected = row["hash"];
        judgeRow(row, right ? m_expected : kNoValidTree);
    }

private:
    static constexpr int kProductSides = 18;
    std::string m_expected;
};

// Judge::canJudge(), or a line that names the model.
bool isJudged(const Judge& judge, const std::string& model, Table& table)
{
    if (judge.canJudge()) return true;
    table.leaveOut(model + ": no row of 18 sides to judge its contacts by (--reference)");
    return false;
}

// Contacts of a walk's candidates: those of no degree may be others.
void fillContacts(Row& row, const ClothQueries& cloth, const PeerScene& scene, const Found& found)
{
    std::vector<Contact> contacts;
    scene.narrowPhase(found.m_candidates, cloth.m_scene.start(0), cloth.m_scene.end(0), 1, contacts);
    row["candidates"] = found.m_candidates.size();
    row["contacts"] = contacts.size();
    row["hash"] = hashText(hashOf(contacts));
}

// A tree as the host builds, refits and walks it.
struct HostTree
{
    Tree m_tree;
    Found m_found;
    std::string m_refitHash;
    bool m_valid = false;  // both when built and when refitted
};

Row treeOnHost(HostTree& host, const Row& described, const TreeInput& input, const TreeMethods& methods,
               const ClothQueries& cloth, const StudyOptions& options)
{
    const auto timed = [](auto work)
    {
        const Clock::time_point start = Clock::now();
        work();
        return millisecondsSince(start);
    };
    Row row = described;
    row["backend"] = row["device"] = "host";
    row["threads"] = 1;
    Tree& tree = host.m_tree;
    const auto build = [&] { tree = buildTreeOnHost(methods, input.m_triangles, input.m_positions.data(), 1); };
    const auto walk = [&] { walkOnHost({tree.m_nodes, 0, tree.m_order}, cloth, host.m_found); };
    const std::size_t repeats = std::size_t(options.m_repeats);
    repeat(1, repeats, options.m_seconds, [&] { return timed(build); }).fill(row, "build_");
    const Refits refits = refitOnOneThread(tree, input, options, host.m_valid);
    host.m_valid = isValid(tree, input) && host.m_valid;
    refits.m_host.fill(row, "refit_");
    host.m_refitHash = refits.m_hash;
    repeat(1, repeats, options.m_seconds, [&] { return timed(walk); }).fill(row, "walk_");
    return row;
}

// Returns the bytes of a tree on the device that a step reads: nodes and order.
std::size_t bytesOf(const Tree& tree)
{
    return tree.m_nodes.size() * sizeof(BvhNode) + tree.m_order.size() * sizeof(std::uint32_t);
}

Found walkOnDevice(Device& device, const Tree& tree, const ClothQueries& cloth, std::size_t room, Row& row,
                   const StudyOptions& options)
{
    DeviceTree onDevice;
    onDevice.upload(device, tree);
    DeviceWalk walk(device, {tree.m_nodes, 0, tree.m_order}, cloth, room);
    double kernelMs = 0;
    const auto once = [&] { return walk.run(onDevice.m_nodes, onDevice.m_order, kernelMs); };
    once();  // some drivers compile at the first launch
    Samples kernels;
    const Samples host = repeat(2, std::size_t(options.m_repeats), options.m_seconds,
                                [&]
                                {
                                    const double ms = once();
                                    kernels.add(kernelMs);
                                    return ms;
                                });
    host.fill(row, "walk_");
    kernels.fill(row, "walk_kernel_");
    return walk.found();
}

// Adds the row of the device. It is also void if one of its trees is not the host's.
void addDeviceRow(Device& device, Row row, TreeInput& input, const TreeMethods& methods, const HostTree& host,
                  const ClothQueries& cloth, const PeerScene& scene, Judge& judge, const StudyOptions& options,
                  Table& table)
{
    row["backend"] = "opencl";
    fillDevice(row, device.info());
    row["threads"] = 0;
    const Builds builds = buildOnDevice(device, input, methods, options);
    builds.m_host.fill(row, "build_");
    builds.m_kernels.fill(row, "build_kernel_");
    const Refits refits = refitOnDevice(device, input, host.m_tree, RefitMethod::Subtrees, options);
    refits.m_host.fill(row, "refit_");
    refits.m_kernels.fill(row, "refit_kernel_");
    const Found found = walkOnDevice(device, host.m_tree, cloth, host.m_found.m_candidates.size(), row, options);
    fillContacts(row, cloth, scene, found);
    judge.judge(row, host.m_valid && builds.m_hash == treeHash(host.m_tree) && refits.m_hash == host.m_refitHash);
    table.add(row);
}

void studyTree(const std::string& model, const TriangleMesh& mesh, Device* device, const StudyOptions& options,
               Table& table)
{
    Judge judge(options, model);
    if (!isJudged(judge, model, table)) return;
    TreeInput input(mesh);
    TreeMethods methods;
    methods.m_builder = TreeBuilder::Radix;
    const ClothQueries cloth = clothQueries(mesh);
    const PeerScene scene(cloth.m_scene);
    Row described = degreeRow(model, input.triangleCount(), "radix tree");
    HostTree host;
    Row row = treeOnHost(host, described, input, methods, cloth, options);
    const TreeQuality quality = measureTree(host.m_tree.m_nodes, 0);
    for (Row* each : {&described, &row})
    {
        (*each)["nodes"] = host.m_tree.m_nodes.size();
        (*each)["bytes"] = bytesOf(host.m_tree);
        (*each)["height"] = quality.m_height;
        (*each)["cost"] = quality.m_cost;
        (*each)["visits"] = host.m_found.m_tests;
    }
    fillContacts(row, cloth, scene, host.m_found);
    judge.judge(row, host.m_valid);
    table.add(row);
    if (device) addDeviceRow(*device, described, input, methods, host, cloth, scene, judge, options, table);
}

// The host's front is the reference, so it is first.
std::vector<StepVariant> stepVariants(const StudyOptions& options)
{
    Settings host;
    host.m_backend = Backend::Host;
    std::vector<StepVariant> all = {{"step, host", host, Methods()}};
    if (options.m_backend != "host")
    {
        all.push_back({"step, default", options.settings()});
        all.push_back({"step, front", options.settings(), Methods()});
    }
    return all;
}

// A period of the scene, several times over; means over its steps of the last time.
struct StepRun
{
    std::map<std::string, Samples> m_stages;
    std::size_t m_candidates = 0, m_contacts = 0, m_tests = 0, m_bytes = 0;
    std::string m_hash;  // hash of all steps' contacts
    Row m_device;
};

StepRun runSteps(const StepScene& scene, const StepVariant& variant, int passes, double seconds)
{
    const std::unique_ptr<StepMethod> method = makeMethod(scene, variant);
    StepRun run;
    const Clock::time_point begin = Clock::now();
    // The first pass lets buffers grow.
    for (int pass = 0; pass <= passes && (pass < 2 || millisecondsSince(begin) < 1000 * seconds); ++pass)
    {
        run.m_candidates = run.m_contacts = run.m_tests = 0;
        std::uint64_t hash = kEmptyHash;
        for (int step = 0; step < scene.period(); ++step)
        {
            const StepOutcome outcome = method->step(scene.start(step), scene.end(step));
            run.m_candidates += outcome.m_candidates;
            run.m_contacts += outcome.m_contacts;
            run.m_tests += outcome.m_volumeTests;
            hash = hashBytes(hash, outcome.m_hash.data(), outcome.m_hash.size());
            for (const StageTime& stage : outcome.m_stages)
            {
                if (pass > 0) run.m_stages[stage.m_name].add(stage.m_ms);
            }
        }
        run.m_hash = hashText(hash);
    }
    for (const Row& row : method->extraRows())
        run.m_bytes += row["bytes"].get<std::size_t>();
    for (std::size_t* sum : {&run.m_candidates, &run.m_contacts, &run.m_tests})
        *sum /= std::size_t(scene.period());
    method->describe(run.m_device);
    return run;
}

void addSteps(const StepScene& scene, const StepVariant& variant, Judge& judge, const StudyOptions& options,
              Table& table)
{
    StepRun run = runSteps(scene, variant, options.m_repeats, options.m_seconds);
    const bool onHost = variant.m_settings.m_backend == Backend::Host;
    // A device's tests and kernels cost time of their own to see, so they are measured apart. The host counts anyway.
    StepVariant counting = variant, profiled = variant;
    if (counting.m_methods) counting.m_methods->m_countTests = true;
    profiled.m_settings.m_profileKernels = true;
    if (!onHost) run.m_tests = runSteps(scene, counting, 0, 0).m_tests;
    Row row = degreeRow(scene.m_spec.m_name, scene.m_obstacle.triangleCount(), variant.m_name);
    row["cloth_triangles"] = scene.m_spec.clothTriangles();
    row.update(run.m_device);
    row["candidates"] = run.m_candidates;
    row["contacts"] = run.m_contacts;
    if (run.m_tests > 0) row["visits"] = run.m_tests;
    if (run.m_bytes > 0) row["bytes"] = run.m_bytes;
    run.m_stages.at("step").fill(row, "step_");
    if (!onHost)
    {
        const StepRun kernels = runSteps(scene, profiled, options.m_repeats, options.m_seconds);
        const auto found = kernels.m_stages.find("kernels");  // none where there is no device
        if (found != kernels.m_stages.end()) found->second.fill(row, "step_kernel_");
    }
    row["hash"] = run.m_hash;
    judge.judge(row);
    table.add(row);
}

void studySteps(const SceneSpec& spec, const StudyOptions& options, Table& table)
{
    TriangleMesh obstacle;
    if (!loadModel(spec.m_model, options, obstacle)) return;
    const StepScene scene = makeStepScene(spec, obstacle);
    Judge judge(options, spec.m_name);
    if (!isJudged(judge, spec.m_name, table)) return;
    for (const StepVariant& variant : stepVariants(options))
    {
        if (!options.tooLate(spec.m_name + ", " + variant.m_name)) addSteps(scene, variant, judge, options, table);
    }
}
}  // namespace

void studyDegrees(const StudyOptions& options, Table& table)
{
    const std::unique_ptr<Device> device = openStudyDevice(options);
    forEachModel(options, [&](const std::string& model, const TriangleMesh& mesh)
                 { studyTree(model, mesh, device.get(), options, table); });
    for (const SceneSpec& spec : studyScenes(options))
        studySteps(spec, options, table);
}
}  // namespace drape::bench
