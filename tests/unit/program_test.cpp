// Programs: assembled sources with line directives, errors that name file, line and log, and the cache in use.
#include "bullet_plugin/core/device/program.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "bullet_plugin/core/device/buffer.h"
#include "bullet_plugin/core/device/embedded_kernels.h"
#include "tests/support/backends.h"
#include "tests/support/environment.h"

namespace drape::test
{
namespace
{
std::size_t countOf(const std::string& text, const std::string& part)
{
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++count;
    return count;
}

// Follows the line directives and checks that every line is the one of its file that it claims to be.
void expectLinesAreWhereTheySay(const std::string& source)
{
    std::string path;
    std::vector<std::string> lines;
    std::size_t number = 0;
    std::istringstream text(source);
    for (std::string line; std::getline(text, line);)
    {
        if (line.compare(0, 6, "#line ") == 0)
        {
            const std::size_t quote = line.find('"');
            path = line.substr(quote + 1, line.rfind('"') - quote - 1);
            number = std::stoul(line.substr(6)) - 1;
            lines.clear();
            for (std::size_t i = 0; i < kEmbeddedFileCount; ++i)
            {
                if (path != kEmbeddedFiles[i].m_path) continue;
                std::istringstream file(kEmbeddedFiles[i].m_text);
                for (std::string fileLine; std::getline(file, fileLine);)
                    lines.push_back(fileLine);
            }
            ASSERT_FALSE(lines.empty()) << path;
            continue;
        }
        if (path.empty()) continue;  // the preamble
        ASSERT_LT(number, lines.size()) << path;
        ASSERT_EQ(line, lines[number]) << path << ':' << number + 1;
        ++number;
    }
}
}  // namespace

TEST(AssembleSource, LineDirectivesAreRight)
{
    std::size_t kernels = 0;
    for (std::size_t i = 0; i < kEmbeddedFileCount; ++i)
    {
        const std::string path = kEmbeddedFiles[i].m_path;
        if (path.size() < 3 || path.compare(path.size() - 3, 3, ".cl") != 0) continue;
        ++kernels;
        SCOPED_TRACE(path);
        const std::string source = assembleSource(path);
        expectLinesAreWhereTheySay(source);
        EXPECT_EQ(countOf(source, "#include \""), 0u);
        EXPECT_EQ(countOf(source, "#error"), 0u);
        EXPECT_LE(countOf(source, "#line 1 \"kernels/shared/types.h\"\n"), 1u) << "each file once";
    }
    EXPECT_GE(kernels, 5u);
}

TEST(AssembleSource, IncludesTextsForAnyWidthOncePerWidth)
{
    const std::string line = "#line 1 \"kernels/lib/any_width/closest.h\"\n";
    EXPECT_EQ(countOf(assembleSource("kernels/narrow_phase/narrow_phase.cl"), line), 1u);
    EXPECT_EQ(countOf(assembleSource("kernels/narrow_phase/narrow_phase_simd.cl"), line), 2u);
}

TEST(AssembleSource, TurnsContractionOffFirst)
{
    EXPECT_EQ(assembleSource("kernels/queries/refit.cl").find("#pragma OPENCL FP_CONTRACT OFF"), 0u);
}

TEST(AssembleSource, UnknownFileIsEmpty)
{
    EXPECT_TRUE(assembleSource("kernels/no_such.cl").empty());
}

TEST(AssembleSource, SeveralFilesIncludeAFileOnce)
{
    const std::string source = assembleSources({"kernels/queries/refit.cl", "kernels/scene/place_obstacles.cl"});
    expectLinesAreWhereTheySay(source);
    EXPECT_EQ(countOf(source, "#line 1 \"kernels/shared/types.h\""), 1u);
    EXPECT_NE(source.find("__kernel void refitLeaves"), std::string::npos);
    EXPECT_NE(source.find("__kernel void placeObstacles"), std::string::npos);
    EXPECT_TRUE(assembleSources({"kernels/queries/refit.cl", "kernels/no_such.cl"}).empty());
}

// Some drivers ignore line directives. A marker in the assembled source, named by its own line, is found in its file.
TEST(TranslateLog, NamesFileAndLineOfEveryKernelLine)
{
    const std::string source = assembleSource("kernels/queries/refit.cl");
    for (const char* text : {"__kernel void refitLeaves", "DRAPE_FUNCTION void dopClear", "__kernel void refitTop"})
    {
        SCOPED_TRACE(text);
        const std::size_t at = source.find(text);
        ASSERT_NE(at, std::string::npos);
        const std::size_t physical = 1 + countOf(source.substr(0, at), "\n");
        const std::size_t directive = source.rfind("#line ", at);
        const std::size_t quote = source.find('"', directive);
        const std::string file = source.substr(quote + 1, source.find('"', quote + 1) - quote - 1);
        const std::size_t line =
            std::stoul(source.substr(directive + 6)) + countOf(source.substr(directive, at - directive), "\n") - 1;
        EXPECT_EQ(translateLog("<kernel>:" + std::to_string(physical) + ":5: error: x", source),
                  file + ":" + std::to_string(line) + ":5: error: x");
    }
    EXPECT_EQ(translateLog("kernels/queries/refit.cl:3: error", source), "kernels/queries/refit.cl:3: error");
    EXPECT_EQ(translateLog("<kernel>: no number", source), "<kernel>: no number");
}

class ProgramTest : public BackendTest
{
};

TEST_P(ProgramTest, BrokenKernelNamesFileLineAndLog)
{
    const std::unique_ptr<Device> device = openDevice(GetParam());
    ASSERT_TRUE(device);
    std::string source = assembleSource("kernels/queries/refit.cl");
    const std::size_t at = source.find("dopStore(nodes + leaf");
    ASSERT_NE(at, std::string::npos);
    // A variable breaks the source; a missing function could pass for one to be linked.
    source.insert(at, "thisIsNoVariable = 7;");
    // Finds the broken line of refit.cl.
    const std::string before = source.substr(source.rfind("#line", at), at - source.rfind("#line", at));
    const std::size_t line = std::stoul(before.substr(6)) + countOf(before, "\n") - 1;

    compileSource(*device, "kernels/queries/refit.cl", source);
    ASSERT_TRUE(device->failed());
    const Error& error = device->error();
    EXPECT_NE(error.m_call.find("kernels/queries/refit.cl"), std::string::npos) << error.text();
    EXPECT_NE(error.m_call.find(std::to_string(CL_BUILD_PROGRAM_FAILURE)), std::string::npos) << error.text();
    EXPECT_NE(error.m_detail.find("thisIsNoVariable"), std::string::npos) << error.text();
    EXPECT_NE(error.m_detail.find("refit.cl:" + std::to_string(line)), std::string::npos) << error.text();
}

TEST_P(ProgramTest, SecondBuildComesFromTheCacheAndADamagedOneIsBuiltAnew)
{
    namespace fs = std::filesystem;
    const TemporaryFolder temporary;
    const std::string& folder = temporary.path();
    const std::unique_ptr<Device> device = openDevice(GetParam());
    ASSERT_TRUE(device);
    ProgramBuild build;
    buildProgram(*device, "broad_phase", folder, build);
    EXPECT_FALSE(build.m_fromCache);
    const bool kept = keepsItsOwn(device->info());
    EXPECT_EQ(fs::is_empty(folder), kept);
    buildProgram(*device, "broad_phase", folder, build);
    EXPECT_EQ(build.m_fromCache, !kept);
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
        fs::resize_file(entry.path(), fs::file_size(entry) / 2);
    buildProgram(*device, "broad_phase", folder, build);
    EXPECT_FALSE(build.m_fromCache);
    EXPECT_FALSE(device->failed()) << device->error().text();
    buildProgram(*device, "broad_phase", "/proc/drape", build);
    EXPECT_FALSE(build.m_fromCache);
    EXPECT_FALSE(device->failed()) << device->error().text();
}

TEST_P(ProgramTest, KernelsAreToldOfACpu)
{
    const std::unique_ptr<Device> device = openDevice(GetParam());
    ASSERT_TRUE(device);
    ProgramBuild build;
    const cl::Program program =
        buildProgram(*device, "ordering/ordering", "none", build, "// a line of the caller's\n");
    ASSERT_FALSE(device->failed()) << device->error().text();
    const std::string source = program.getInfo<CL_PROGRAM_SOURCE>();
    EXPECT_EQ(source.find("#define DRAPE_CPU\n") == std::string::npos, device->isGpu());
    EXPECT_NE(source.find("// a line of the caller's\n"), std::string::npos);
}

TEST_P(ProgramTest, ErrorsAreSticky)
{
    const std::unique_ptr<Device> device = openDevice(GetParam());
    ASSERT_TRUE(device);
    compileSource(*device, "one", "not a kernel");
    ASSERT_TRUE(device->failed());
    const std::string first = device->error().text();
    compileSource(*device, "two", "neither is this");
    EXPECT_EQ(device->error().text(), first);
    Buffer<cl_uint> buffer;
    buffer.reserve(*device, 10);
    EXPECT_EQ(buffer.capacity(), 0u);
}

INSTANTIATE_TEST_SUITE_P(Devices, ProgramTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
