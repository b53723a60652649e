// drape_check: asks Drape collision questions outside a simulation, and where the truth is known counts its errors.
#include <iostream>

#include "scenes/atomic_file.h"
#include "tools/common/arguments.h"
#include "tools/common/device_option.h"
#include "tools/drape_check/commands.h"

namespace drape
{
namespace
{
bool writeJson(const Options& options, const nlohmann::ordered_json& answer, std::string& error)
{
    const std::string json = answer.dump(2) + "\n";
    if (options.m_json == "-")
        std::cout << json;
    else if (!options.m_json.empty() && !writeFileAtomically(options.m_json, json, error))
        return false;
    return flushOutput(error);
}

bool writeAnswer(const Options& options, const nlohmann::ordered_json& answer, std::string& error)
{
    if (!writeJson(options, answer, error)) return false;
    if (!options.m_quiet && options.m_json != "-")
    {
        for (const auto& item : answer.items())
            std::cout << item.key() << " "
                      << (item.value().is_string() ? item.value().get<std::string>() : item.value().dump()) << "\n";
    }
    return flushOutput(error);
}

int run(const Options& options)
{
    std::string error;
    if (options.m_listDevices) return printDevices(error) ? kExitGood : fail("drape_check", kExitFailed, error);
    for (const std::string& input : {options.m_first, options.m_second})
        if (!options.m_json.empty() && options.m_json != "-" && !input.empty() && areOneFile(options.m_json, input))
            return fail("drape_check", kExitBadInput, "--json would write over " + input);
    if (!couldWrite(options.m_json, error)) return fail("drape_check", kExitBadInput, error);
    nlohmann::ordered_json answer;
    int exitCode = kExitFailed;
    if (runCommand(options, answer, error, exitCode))
        return writeAnswer(options, answer, error) ? kExitGood : fail("drape_check", kExitFailed, error);
    std::string writeError;
    if (answer.contains(kLimitReached) && !writeJson(options, answer, writeError))
        return fail("drape_check", kExitFailed, writeError);
    return fail("drape_check", exitCode, error);
}
}  // namespace
}  // namespace drape

int main(int argc, char** argv)
{
    return drape::runProgram("drape_check", argc, argv, drape::parseOptions, drape::run);
}
