// Every traversal as a cloth comes down and at rest.
#include "study/programs/descent.h"

namespace drape::bench
{
namespace
{
// The host's front is the reference, so it is first. Its other traversals are last: they take longest, and what the
// time left does not suffice for should be theirs.
std::vector<StepVariant> variants(const StudyOptions& options)
{
    std::vector<StepVariant> all;
    const auto add = [&all](const std::string& name, const Settings& settings, Traversal traversal)
    {
        all.push_back({name, settings, Methods()});
        all.back().m_methods->m_traversal = traversal;
    };
    Settings host, device = options.settings();
    host.m_backend = Backend::Host;
    device.m_profileKernels = true;
    add("host, thesis: front", host, Traversal::Front);
    if (options.m_backend != "host")
    {
        all.push_back({"default", device});
        add("thesis: front", device, Traversal::Front);
        add("as front, from fixed pairs", device, Traversal::Full);
        add("grid", device, Traversal::Grid);
        add("thesis: simple", device, Traversal::Single);
    }
    add("host, as front, from the roots", host, Traversal::Full);
    add("host, grid", host, Traversal::Grid);
    add("host, thesis: simple", host, Traversal::Single);
    return all;
}
}  // namespace

void studyTraversals(const StudyOptions& options, Table& table)
{
    for (const SceneSpec& spec : studyScenes(options))
    {
        TriangleMesh obstacle;
        if (!loadModel(spec.m_model, options, obstacle)) continue;
        const DescentScene scene(spec, obstacle, options.m_quick);
        std::vector<StepOutcome> reference;
        for (const StepVariant& variant : variants(options))
        {
            if (options.tooLate(spec.m_name + ", " + variant.m_name)) continue;
            DescentRun run(scene, variant);
            run.warmUp();
            const Clock::time_point begin = Clock::now();
            for (int pass = 0; pass < options.m_repeats; ++pass)
            {
                if (pass == 0 || millisecondsSince(begin) < 1000 * options.m_seconds) run.pass();
            }
            run.countTests();
            if (reference.empty()) reference = run.outcomes();
            run.addRows("traversal", reference, table);
        }
    }
}
}  // namespace drape::bench
