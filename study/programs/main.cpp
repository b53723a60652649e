// study: the thesis's tables and figures on any device, with today's methods and the peers beside its own.
//
// Every row carries a hash of its result; where it is not that of the host's version, the row is void and the program
// ends with 3.
#include <algorithm>
#include <iostream>

#include <CLI/CLI.hpp>

#include "study/programs/study.h"
#include "scenes/models.h"

namespace drape::bench
{
bool StudyOptions::wants(const std::string& model) const
{
    return m_only.empty() || std::find(m_only.begin(), m_only.end(), model) != m_only.end();
}

bool StudyOptions::tooLate(const std::string& what) const
{
    if (millisecondsSince(m_begin) <= 60000 * m_minutes) return false;
    std::cerr << "study: " << what << ": left out: the time is used up" << std::endl;
    return true;
}

std::vector<std::string> studyModels(bool quick)
{
    if (quick) return {"sphere_1k", "terrain_6272"};
    return studyModelNames();
}

std::vector<float> refitPositions(const std::vector<float>& positions)
{
    std::vector<float> moved(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i)
        moved[i] = positions[i] + 0.25f * positions[i - i % 3 + (i + 1) % 3];
    return moved;
}

bool StudyOptions::readReference(std::string& error)
{
    const auto take = [this](const Row& row)
    {
        // Other sides' rows are what is judged.
        if (row.value("valid", "") == "yes" && row.value("dop", 18) == 18)
            m_hashes[row.value("part", "") + ", " + row.value("model", "")] = row.at("hash");
    };
    return m_reference.empty() || readRows(m_reference, take, error);
}

std::string StudyOptions::expectedHash(const std::string& part, const std::string& model) const
{
    const auto found = m_hashes.find(part + ", " + model);
    return found == m_hashes.end() ? std::string() : found->second;
}

bool loadModel(const std::string& model, const StudyOptions& options, TriangleMesh& mesh)
{
    std::string error;
    if (makeModel(model, modelFolders(options.m_models), mesh, error)) return true;
    std::cerr << "study: " << error << std::endl;
    return false;
}

std::vector<SceneSpec> studyScenes(const StudyOptions& options)
{
    std::vector<SceneSpec> specs;
    for (const SceneSpec& spec : sceneSpecs())
    {
        const bool studied =
            options.m_quick ? spec.m_name == "quick_one" : spec.m_name == "thesis" || spec.m_name == "fine";
        if (studied && options.wants(spec.m_name)) specs.push_back(spec);
    }
    return specs;
}

void forEachModel(const StudyOptions& options, const std::function<void(const std::string&, const TriangleMesh&)>& body)
{
    for (const std::string& model : studyModels(options.m_quick))
    {
        TriangleMesh mesh;
        if (!options.wants(model) || options.tooLate(model)) continue;
        if (loadModel(model, options, mesh)) body(model, mesh);
    }
}

namespace
{
std::string nameProblem(const StudyOptions& options)
{
    std::vector<std::string> parts, only = studyModels(false);
    for (const Part& part : studyParts())
        parts.push_back(part.m_name);
    StudyOptions all;
    for (const bool quick : {true, false})
    {
        all.m_quick = quick;
        for (const std::string& model : studyModels(quick))
            if (std::find(only.begin(), only.end(), model) == only.end()) only.push_back(model);
        for (const SceneSpec& spec : studyScenes(all))
            only.push_back(spec.m_name);
    }
    const std::string problem = unknownName("--part", options.m_parts, parts);
    return problem.empty() ? unknownName("--only", options.m_only, only) : problem;
}

int run(int argc, char** argv)
{
    StudyOptions options;
    CLI::App app("The thesis's tables and figures, with today's methods beside its own.", "study");
    addCommonOptions(app, options);
    app.add_option("--part", options.m_parts, "only these parts");
    app.add_option("--only", options.m_only, "only these models and scenes");
    app.add_option("--reference", options.m_reference, "JSON of the part degree in other volumes: contacts must be its")
        ->type_name("FILE")
        ->check(CLI::ExistingFile);
    int exitCode = kExitGood;
    if (!parseArguments(
            app, argc, argv, [&options] { return nameProblem(options); }, exitCode))
        return exitCode;
    std::string error;
    if (!options.readReference(error)) return fail("study", kExitBadInput, error);
    Table table;
    for (const Part& part : studyParts())
    {
        if (options.m_list) std::cout << part.m_name << ": " << part.m_title << "\n";
        const bool wanted = options.m_parts.empty() || std::find(options.m_parts.begin(), options.m_parts.end(),
                                                                 part.m_name) != options.m_parts.end();
        if (options.m_list || !wanted) continue;
        std::cerr << "study: " << part.m_name << std::endl;
        part.m_run(options, table);
    }
    if (options.m_list) return kExitGood;
    if (table.rows().empty() && table.anyLeftOut()) return kExitFailed;
    if (table.rows().empty()) return fail("study", kExitBadInput, "nothing to measure; --only names no model or scene");
    return finishTable("study", table, options);
}
}  // namespace
}  // namespace drape::bench

int main(int argc, char** argv)
{
    return drape::runGuarded("study", [&] { return drape::bench::run(argc, argv); });
}
