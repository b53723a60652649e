// Tests the command lines of Drape's programs: they name the user's mistake, suggest what is meant, and have --version.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/tools/tool.h"
#include "tools/common/suggestion.h"

namespace drape::test
{
namespace
{
using Words = std::vector<std::string>;

// Runs each program that takes options, by the environment variable that names it.
class Arguments : public ToolTest, public testing::WithParamInterface<const char*>
{
protected:
    const char* programVariable() const override { return GetParam(); }
    bool is(const char* variable) const { return GetParam() == std::string(variable); }
};
}  // namespace

TEST(Suggestion, IsTheNearestWord)
{
    const Words options = {"--obstacle", "--obstacle-size", "--cloth", "--cloth-size",
                           "--steps",    "--thickness",     "--dt"};
    const std::pair<const char*, const char*> cases[] = {
        {"--stpes", "--steps"},        {"--step", "--steps"},      {"-steps", "--steps"},
        {"steps", "--steps"},          {"--STEPS", "--steps"},     {"--obstacle_size", "--obstacle-size"},
        {"--obstcale", "--obstacle"},  {"--thick", "--thickness"}, {"--clothsize", "--cloth-size"},
        {"--tickness", "--thickness"}, {"--clot", "--cloth"},      {"--td", "--dt"}};
    for (const auto& [typed, meant] : cases)
        EXPECT_EQ(nearestWord(typed, options), meant) << typed;
}

TEST(Suggestion, IsEmptyIfNothingIsNear)
{
    const Words options = {"--steps", "--dt", "--json"};
    for (const char* typed : {"--colour", "--no-such-option", "", "-", "--", "--x", "3", "--frobnicate"})
        EXPECT_EQ(nearestWord(typed, options), "") << typed;
    EXPECT_EQ(nearestWord(std::string(1000000, 'a'), {"a", std::string(1000000, 'b')}), "");
    EXPECT_EQ(nearestWord("steps", {}), "");
}

TEST_P(Arguments, VersionIsToldAndNothingRuns)
{
    const ToolRun result = run({"--version"});
    EXPECT_EQ(result.m_exitCode, 0);
    EXPECT_EQ(result.m_err, "");
    EXPECT_EQ(result.m_out.find('\n'), result.m_out.size() - 1) << "one line: " << result.m_out;
    EXPECT_NE(result.m_out.find(" (Drape) " DRAPE_TEST_VERSION "\n"), std::string::npos) << result.m_out;
    EXPECT_NE(run({"--help"}).m_out.find("--version"), std::string::npos);
    expectFullOutputTold({"--version"});
}

TEST_P(Arguments, AnUnknownOptionIsToldWithTheOneThatIsMeant)
{
    expectRefused(run({"--bakcend", "host"}), {"no option --bakcend", "did you mean --backend?"});
    expectRefused(run({"--bakcend=host"}), {"no option --bakcend;", "did you mean --backend?"});
    expectRefused(run({"-backend", "host"}), {"no option -backend", "did you mean --backend?"});
    const ToolRun other = run({"--frobnicate"});
    expectRefused(other, {"no option --frobnicate"});
    EXPECT_EQ(other.m_err.find("did you mean"), std::string::npos) << other.m_err;
}

TEST_P(Arguments, AnUnknownValueIsToldWithTheOneThatIsMeantAndAllThereAre)
{
    expectRefused(run({"--backend", "hsot"}), {"--backend", "'hsot'", "did you mean host?", "opencl"});
    const ToolRun other = run({"--backend", "abacus"});
    expectRefused(other, {"--backend", "'abacus'", "host", "opencl"});
    EXPECT_EQ(other.m_err.find("did you mean"), std::string::npos) << other.m_err;
}

TEST_P(Arguments, AnOptionThatIsTakenForAValueIsTheMistakeThatIsTold)
{
    expectRefused(run({"--backend", "--help"}), {"--backend needs a value", "option --help follows"});
    expectRefused(run({"--backend", "--versoin"}), {"--backend needs a value", "--versoin", "did you mean --version?"});
    expectRefused(run({"--backend"}), {"--backend"});
}

INSTANTIATE_TEST_SUITE_P(Programs, Arguments, testing::Values("DRAPE_CLOTH_DROP", "DRAPE_CHECK", "DRAPE_WORLDS"),
                         [](const testing::TestParamInfo<const char*>& test) { return std::string(test.param); });

using ClothDropArguments = ToolTest;

TEST_F(ClothDropArguments, AnOptionInPlaceOfAFileIsTheMistakeThatIsTold)
{
    expectRefused(run({"--csv", "--steps", "3"}), {"--csv needs a value (FILE)", "option --steps follows"});
    expectRefused(run({"--csv", "--quiet"}), {"--csv needs a value", "option --quiet follows"});
    expectRefused(run({"--csv=", "--steps", "3"}), {"--csv= has no value"});
    expectRefused(run({"--csv=", "steps.csv"}), {"--csv= has no value"});
    expectRefused(run({"--json", "--csv=a.csv"}), {"--json needs a value", "option --csv follows"});
    expectRefused(run({"--csv", "--setps", "3"}), {"--csv needs a value", "--setps", "did you mean --steps?"});
    expectRefused(run({"--picture", "-h"}), {"--picture needs a value", "option -h follows"});
    expectRefused(run({"steps", "3"}), {"'steps'", "did you mean --steps?"});
    expectRefused(run({"--steps", "3", "4"}), {"'4'", "belongs to no option"});
    // The equals sign still allows such a name.
    ASSERT_EQ(runSmall({"--steps", "1", "--csv=" + path("--steps")}).m_exitCode, 0);
    EXPECT_FALSE(readAll(path("--steps")).empty());
}

TEST_F(ClothDropArguments, AFileWhoseNameBeginsWithDashesReachesTheRunsInChildren)
{
    write("--mesh.obj", "v -1 0 -1\nv 1 0 -1\nv 0 0 1\nf 1 2 3\n");
    const std::string folder = std::filesystem::current_path();
    std::filesystem::current_path(path(""));
    const ToolRun result = run({"--obstacle=--mesh.obj", "--cloth", "3x3", "--steps", "2", "--backend", "host",
                                "--compare", "--compare-cap", "9", "--quiet"});
    std::filesystem::current_path(folder);
    EXPECT_EQ(result.m_exitCode, 0) << result.m_err;
}

TEST_F(ClothDropArguments, MistakesOfValuesAreToldInPlainSentences)
{
    expectRefused(run({"--threads", "many"}), {"--threads", "'many' must be a whole number from 0 to 64"});
    expectRefused(run({"--threads", "99"}), {"'99' must be a whole number from 0 to 64"});
    expectRefused(run({"--steps", "1.5"}), {"--steps cannot take the value '1.5'"});
    expectRefused(run({"--steps", "3", "--steps", "4"}), {"--steps may be given only once"});
    expectRefused(run({"--steps"}), {"--steps needs a value"});
}

TEST_F(ClothDropArguments, ABulletModeWithoutBulletIsRefused)
{
    expectRefused(runSmall({"--bullet-mode", "vfss"}), {"--bullet-mode needs --backend bullet"});
    expectRefused(runSmall({"--bullet-mode", "vfss", "--compare"}), {"--compare-vfss"});
}

TEST_F(ClothDropArguments, HiddenOptionsAreNotSuggested)
{
    const ToolRun result = run({"--stream-step"});
    expectRefused(result, {"no option --stream-step"});
    EXPECT_EQ(result.m_err.find("did you mean"), std::string::npos) << result.m_err;
}

TEST_F(ClothDropArguments, AMistypedShapeIsToldWithTheOneThatIsMeant)
{
    expectRefused(runSmall({"--obstacle", "shpere"}), {"no such file", "did you mean sphere?"});
    expectRefused(runSmall({"--obstacle", "cathedral"}), {"no such file", "shapes are sphere, bowl"});
    const ToolRun file = runSmall({"--obstacle", path("nowhere.obj")});
    expectRefused(file, {"no such file"});
    EXPECT_EQ(file.m_err.find("shapes"), std::string::npos) << file.m_err;
}

TEST_F(ClothDropArguments, AThicknessOutOfProportionIsWarnedOf)
{
    const auto warning = [this](const Words& arguments)
    {
        const ToolRun result = runSmall(arguments);
        EXPECT_EQ(result.m_exitCode, 0) << result.m_err;
        return result.m_err.substr(0, result.m_err.find('\n'));
    };
    const std::string thick = warning({"--thickness", "20"});
    for (const char* words : {"warning", "--thickness is 20 m", "obstacle is 2 m", "0.02"})
        EXPECT_NE(thick.find(words), std::string::npos) << words << ": " << thick;
    EXPECT_NE(warning({"--thickness", "0.3", "--obstacle-size", "1"}).find("--thickness is 0.3 m"), std::string::npos);
    EXPECT_NE(warning({"--thickness", "0.001", "--obstacle-size", "5000"}).find("float32"), std::string::npos);
    EXPECT_EQ(warning({"--thickness", "0.25"}), "") << "as Bullet's own margins are";
    EXPECT_EQ(warning({"--thickness", "20", "--obstacle-size", "200", "--cloth-size", "200"}), "");
}

class CheckArguments : public ToolTest
{
protected:
    const char* programVariable() const override { return "DRAPE_CHECK"; }
};

TEST_F(CheckArguments, CommandsAndTheirOptionsAreKnownApart)
{
    expectRefused(run({"pair", "a.obj"}), {"no command pair", "did you mean pairs?"});
    expectRefused(run({"frobnicate"}), {"no command frobnicate"});
    expectRefused(run({"pairs", "a.obj", "--thicknes", "1"}), {"no option --thicknes", "did you mean --thickness?"});
    expectRefused(run({"pairs", "a.obj", "--jsno", "1"}), {"no option --jsno", "did you mean --json?"});
    expectRefused(run({"--json", "--thickness", "1", "pairs", "a.obj"}),
                  {"--json needs a value", "option --thickness"});
    expectRefused(run({"pairs", "a.obj", "--json", "--thickness", "1"}),
                  {"--json needs a value", "--thickness follows"});
    expectRefused(run({"--thickness", "1", "pairs", "a.obj"}), {"--thickness", "command pairs", "after it"});
    expectRefused(run({"ccd", "a.bin", "--thickness", "1"}), {"--thickness", "command pairs", "not of ccd"});
    expectRefused(run({"ccd", "a.bin", "triangles", "b.bin"}), {"command triangles follows ccd"});
    expectRefused(run({"triangles", "a.bin", "--mode", "exakt"}), {"--mode", "did you mean exact?", "fast"});
    expectRefused(run({"pairs", "a.obj", "b.obj", "c.obj"}), {"'c.obj'", "belongs to no option"});
    expectRefused(run({"pairs"}), {"A is missing"});
}

TEST_F(CheckArguments, HelpListsTheExitCodesThatExist)
{
    const std::string help = run({"--help"}).m_out;
    EXPECT_NE(help.find("--candidate-limit"), std::string::npos) << help;
    EXPECT_EQ(help.find("hash"), std::string::npos) << help;
}

class WorldsArguments : public ToolTest
{
protected:
    const char* programVariable() const override { return "DRAPE_WORLDS"; }
};

TEST_F(WorldsArguments, UnknownKindsAndModifiersAreToldWithThoseThatAreMeant)
{
    expectRefused(run({"--kind", "tniy"}), {"--kind", "did you mean tiny?"});
    expectRefused(run({"--modifiers", "stiff,masess"}), {"--modifiers", "'masess'", "did you mean masses?"});
}
}  // namespace drape::test
