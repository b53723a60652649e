#include "benchmarks/support/arguments.h"

#include <algorithm>

#include <CLI/CLI.hpp>

#include "benchmarks/support/machine.h"
#include "tools/common/suggestion.h"

namespace drape::bench
{
Settings CommonOptions::settings() const
{
    Settings settings;
    settings.m_device = m_device;
    settings.m_crossover = 0;  // a method runs on the back end of its name, however small the scene
    settings.m_backend = m_backend == "host" ? Backend::Host : Backend::OpenCl;
    // Without a device, the automatic choice runs on the host or names what is missing.
    if (m_backend == "auto" && !whyNoDevice(settings).empty()) settings.m_backend = Backend::Auto;
    return settings;
}

void addCommonOptions(CLI::App& app, CommonOptions& options)
{
    app.option_defaults()->always_capture_default();
    app.add_option("--device", options.m_device, "part of an OpenCL device's or platform's name")->type_name("TEXT");
    acceptOnly(app.add_option("--backend", options.m_backend, "auto: a GPU, else any OpenCL device, else the host"),
               {"auto", "opencl", "host"});
    app.add_option("--models", options.m_models, "folder of bunny_69k.obj, dragon_871k.ply, spot_6k.obj")
        ->type_name("DIR");
    app.add_option("--csv", options.m_csv, "write the rows as CSV; - is standard output")->type_name("FILE");
    app.add_option("--json", options.m_json, "write machine and rows as JSON; - is standard output")->type_name("FILE");
    app.add_option("--commit", options.m_commit, "commit that is measured, for the results");
    app.add_flag("--quick", options.m_quick, "measure small inputs only, for some seconds");
    app.add_flag("--list", options.m_list, "list all measurements and exit");
    app.add_option("--repeats", options.m_repeats,
                   "largest number of repetitions of a measurement; the study repeats at least 5 times if one takes "
                   "less than 50 ms")
        ->check(CLI::Validator(wholeNumber(1, 1000000000), ""));
    app.add_option("--seconds", options.m_seconds, "time limit for the repetitions of one measurement, s")
        ->check(CLI::Validator(numberAbove(0, false, "more than 0"), ""));
    app.add_option("--minutes", options.m_minutes,
                   "time limit for all measurements, min; those that do not fit are listed and left out")
        ->check(CLI::Validator(numberAbove(0, false, "more than 0"), ""));
}

std::string unknownName(const char* option, const std::vector<std::string>& names,
                        const std::vector<std::string>& known)
{
    for (const std::string& name : names)
        if (std::find(known.begin(), known.end(), name) == known.end())
            return std::string(option) + ": " + unknownWord(name, known);
    return "";
}

int finishTable(const std::string& program, const Table& table, const CommonOptions& options)
{
    std::string error;
    const bool nowhere = options.m_csv.empty() && options.m_json.empty();
    if (!writeText(nowhere ? "-" : options.m_csv, table.csv(), error) ||
        !writeText(options.m_json, table.json(describeMachine(options.m_commit)), error))
        return fail(program, kExitFailed, error);
    if (table.anyVoid()) return fail(program, kExitOtherHash, "rows are void: their results differ from the reference");
    return table.anyLeftOut() ? kExitFailed : kExitGood;
}
}  // namespace drape::bench
