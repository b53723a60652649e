// soft_demo: the scenes of Bullet's SoftDemo with Bullet alone and with Drape, side by side.
//
// Both worlds of a scene run in turns, step by step. An independent measurement (outcome.h) judges Drape's outcome:
// same, better or worse than Bullet's.
#include <algorithm>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <drape/drape.h>

#include "benchmarks/soft_demo/demo_table.h"
#include "benchmarks/soft_demo/outcome.h"
#include "benchmarks/support/arguments.h"
#include "benchmarks/support/result_hash.h"
#include "benchmarks/support/samples.h"
#include "tools/common/program.h"

namespace drape::bench
{
namespace
{
constexpr const char* kProgram = "soft_demo";

struct DemoOptions : CommonOptions
{
    std::vector<std::string> m_scenes;
    int m_steps = 600;
    unsigned m_threads = 0;
    std::string m_markdown;
    bool m_check = false, m_times = false;
};

// One of the two runs of a scene.
struct DemoRun
{
    DemoRun(Plugin* plugin, const DemoScene& scene, int steps) : m_world(plugin)
    {
        if ((scene.m_flags & kWavyGround) != 0)
            m_world.addWavyGround();
        else
            m_world.addFlatGround();
        scene.m_build(m_world);
        m_meter = std::make_unique<OutcomeMeter>(m_world, scene, steps);
    }

    void step()
    {
        m_times.add(m_world.step());
        m_meter->add();
    }

    DemoWorld m_world;
    std::unique_ptr<OutcomeMeter> m_meter;
    Samples m_times;
};

Row rowOf(const DemoScene& scene, const char* method, const DemoOptions& options, DemoRun& run, const Outcome& outcome)
{
    Row row;
    row["scene"] = scene.m_name;
    row["method"] = method;
    row["steps"] = options.m_steps;
    run.m_times.fill(row);
    for (std::size_t i = 0; i < outcome.size(); ++i)
        if (outcome[i]) row[ruleOf(Measure(i)).m_name] = *outcome[i];
    row["soft_bodies"] = run.m_world.softBodies().size();
    row["hash"] = hashText(hashOf(run.m_meter->positions(), kEmptyHash));
    return row;
}

// Fills how many soft bodies Drape leaves to Bullet, with the first one's reason.
void fillLeftToBullet(Row& row, const Plugin& plugin, const DemoWorld& world)
{
    std::size_t links = 0, contacts = 0;
    std::string reason;
    for (const auto& body : world.softBodies())
    {
        const std::string ofLinks = plugin.whyBulletSolves(*body);
        const std::string ofContacts = plugin.whyStock(body.get(), &world.ground());
        links += !ofLinks.empty();
        contacts += !ofContacts.empty();
        if (reason.empty()) reason = ofLinks.empty() ? ofContacts : ofLinks;
    }
    row["links_left_to_bullet"] = links;
    row["contacts_left_to_bullet"] = contacts;
    row["left_because"] = reason;
}

void measure(const DemoScene& scene, const DemoOptions& options, Table& table)
{
    Settings settings = options.settings();
    settings.m_threads = options.m_threads;
    settings.m_log = nullptr;
    Plugin plugin(settings);
    DemoRun stock(nullptr, scene, options.m_steps), drape(&plugin, scene, options.m_steps);
    std::uint32_t status = 0;
    for (int step = 0; step < options.m_steps; ++step)
    {
        stock.step();
        drape.step();
        status |= plugin.statistics().m_status;
    }
    const Outcome stockOutcome = stock.m_meter->finish(), outcome = drape.m_meter->finish();
    table.add(rowOf(scene, "stock", options, stock, stockOutcome));
    Row row = rowOf(scene, "drape", options, drape, outcome);
    const Verdict verdict = judge(outcome, stockOutcome);
    row["verdict"] = verdict.m_word;
    row["verdict_because"] = verdict.m_reason;
    row["same_bits"] = row["hash"] == table.rows().back()["hash"];
    row["status"] = status;
    fillLeftToBullet(row, plugin, drape.m_world);
    table.add(row);
}

// Returns the scenes whose outcome is worse, with the measures that say so; empty if there are none.
std::string worseScenes(const Table& table)
{
    std::string worse;
    for (const Row& row : table.rows())
        if (row.contains("verdict") && row["verdict"] == "worse")
            worse += (worse.empty() ? "" : "; ") + row["scene"].get<std::string>() + " (" +
                     row["verdict_because"].get<std::string>() + ")";
    return worse;
}

int run(int argc, char** argv)
{
    CLI::App app("Runs the scenes of Bullet's SoftDemo with Bullet alone and with Drape.", kProgram);
    DemoOptions options;
    options.m_backend = "host";
    addCommonOptions(app, options);
    app.add_option("--scene", options.m_scenes, "all by default; --list names them");
    app.add_option("--steps", options.m_steps, "steps of 1/60 s; --quick: 60 at most")
        ->check(CLI::Validator(wholeNumber(10, 1000000), ""));
    app.add_option("--threads", options.m_threads, "see cloth_drop")->check(CLI::Validator(wholeNumber(0, 64), ""));
    app.add_option("--markdown", options.m_markdown,
                   "write a table of Bullet's and Drape's values; - is standard output")
        ->type_name("FILE");
    app.add_flag("--times", options.m_times, "add times to that table");
    app.add_flag("--check", options.m_check, "fail if Drape's outcome is worse than Bullet's in a scene");
    std::vector<std::string> names;
    for (const DemoScene& scene : demoScenes())
        names.push_back(scene.m_name);
    int exitCode = kExitGood;
    const auto problem = [&] { return unknownName("--scene", options.m_scenes, names); };
    if (!parseArguments(app, argc, argv, problem, exitCode)) return exitCode;
    if (options.m_quick) options.m_steps = std::min(options.m_steps, 60);
    Table table;
    for (const DemoScene& scene : demoScenes())
    {
        if (options.m_list) std::cout << scene.m_name << ": " << scene.m_title << "\n";
        const auto& chosen = options.m_scenes;
        if (options.m_list ||
            (!chosen.empty() && std::find(chosen.begin(), chosen.end(), scene.m_name) == chosen.end()))
            continue;
        std::cerr << kProgram << ": " << scene.m_name << std::endl;
        measure(scene, options, table);
    }
    if (options.m_list) return kExitGood;
    std::string error;
    if (!writeText(options.m_markdown, demoTable(table, options.m_times), error))
        return fail(kProgram, kExitFailed, error);
    const bool isWritten = !options.m_markdown.empty() && options.m_csv.empty() && options.m_json.empty();
    const int code = isWritten ? kExitGood : finishTable(kProgram, table, options);
    const std::string worse = worseScenes(table);
    if (code != kExitGood || !options.m_check || worse.empty()) return code;
    return fail(kProgram, kExitFailed, "Drape's outcome is worse than Bullet's: " + worse);
}
}  // namespace
}  // namespace drape::bench

int main(int argc, char** argv)
{
    return drape::runGuarded("soft_demo", [&] { return drape::bench::run(argc, argv); });
}
