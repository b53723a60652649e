// Whole steps of the host over trees of each builder.
#include "study/programs/descent.h"

namespace drape::bench
{
namespace
{
// The default's is the reference, so it is first.
std::vector<StepVariant> variants()
{
    std::vector<StepVariant> all;
    for (const auto& [name, builder] : {std::pair<const char*, TreeBuilder>("radix", TreeBuilder::Radix),
                                        {"balanced", TreeBuilder::Balanced},
                                        {"ploc", TreeBuilder::Ploc},
                                        {"top-down", TreeBuilder::TopDown}})
    {
        all.push_back({std::string("host, ") + name, Settings()});
        all.back().m_settings.m_backend = Backend::Host;
        all.back().m_methods.emplace();
        all.back().m_methods->m_tree.m_builder = builder;
    }
    return all;
}

// A pass of each in turn, so that what slows the machine down for a while slows down all of them.
void studyScene(const DescentScene& scene, const StudyOptions& options, Table& table)
{
    std::vector<std::unique_ptr<DescentRun>> runs;
    for (const StepVariant& variant : variants())
    {
        runs.push_back(std::make_unique<DescentRun>(scene, variant));
        runs.back()->warmUp();
    }
    const Clock::time_point begin = Clock::now();
    for (int pass = 0; pass < options.m_repeats; ++pass)
    {
        const bool inTime = millisecondsSince(begin) < 1000 * options.m_seconds * static_cast<double>(runs.size());
        for (const std::unique_ptr<DescentRun>& run : runs)
        {
            if (pass == 0 || inTime) run->pass();
        }
    }
    for (const std::unique_ptr<DescentRun>& run : runs)
        run->addRows("builder", runs.front()->outcomes(), table);
}
}  // namespace

void studyBuilders(const StudyOptions& options, Table& table)
{
    for (const SceneSpec& spec : studyScenes(options))
    {
        TriangleMesh obstacle;
        if (options.tooLate(spec.m_name) || !loadModel(spec.m_model, options, obstacle)) continue;
        studyScene(DescentScene(spec, obstacle, options.m_quick), options, table);
    }
}
}  // namespace drape::bench
