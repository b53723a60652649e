// Every kernel file of the product compiles on the test device without a warning in its build log.
#include <gtest/gtest.h>

#include <cctype>
#include <sstream>
#include <string>
#include <vector>

#include "bullet_plugin/core/device/embedded_kernels.h"
#include "bullet_plugin/core/device/program.h"
#include "bullet_plugin/core/scene/patch_width.h"
#include "tests/support/backends.h"

namespace drape::test
{
namespace
{
bool endsWith(const std::string& text, const std::string& ending)
{
    return text.size() >= ending.size() && text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

// Returns whether the other kind of device alone compiles the file; stages load files without an ending on both.
bool isForOthers(const std::string& name, const Device& device)
{
    return device.isGpu() ? endsWith(name, "_simd") : endsWith(name, "_gpu") || endsWith(name, "_small");
}

// Returns the names in "kernels/<name>.cl" that the device compiles.
std::vector<std::string> kernelFiles(const Device& device)
{
    const std::string folder = "kernels/", ending = ".cl";
    std::vector<std::string> names;
    for (std::size_t i = 0; i < kEmbeddedFileCount; ++i)
    {
        const std::string path = kEmbeddedFiles[i].m_path;
        if (path.compare(0, folder.size(), folder) != 0 || !endsWith(path, ending)) continue;
        const std::string name = path.substr(folder.size(), path.size() - folder.size() - ending.size());
        if (!isForOthers(name, device)) names.push_back(name);
    }
    return names;
}

std::string buildLog(Device& device, const cl::Program& program)
{
    std::string log;
    program.getBuildInfo(device.handle(), CL_PROGRAM_BUILD_LOG, &log);
    return log;
}

// Returns whether a log names a warning. Drivers also log remarks and figures of kernels, which are none. NVIDIA's
// compiler says of every kernel with a fixed group size that it may be inlined. Clang says of every function with wide
// vectors on a CPU without AVX-512 that callers with AVX-512 call it otherwise; a program has no such callers.
bool namesWarning(const std::string& log)
{
    std::istringstream lines(log);
    for (std::string line; std::getline(lines, line);)
    {
        if (line.find("is a kernel, so overriding noinline attribute") != std::string::npos) continue;
        if (line.find("without 'avx512f' enabled changes the ABI") != std::string::npos) continue;
        for (char& letter : line)
            letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
        if (line.find("warning") != std::string::npos) return true;
    }
    return false;
}

class BuildLogTest : public DeviceTest
{
};

TEST_P(BuildLogTest, KernelFilesCompileWithoutAWarning)
{
    const std::vector<std::string> names = kernelFiles(*m_device);
    ASSERT_GE(names.size(), 10u);
    for (const std::string& name : names)
    {
        SCOPED_TRACE(name);
        ProgramBuild build;
        const cl::Program program = buildProgram(*m_device, name, "none", build, patchDefines(*m_device));
        ASSERT_FALSE(m_device->failed()) << m_device->error().text();
        const std::string log = buildLog(*m_device, program);
        EXPECT_FALSE(namesWarning(log)) << log;
    }
}

// The test above relies on a driver that logs warnings, here that of two constants joined by &&.
TEST_P(BuildLogTest, WarningsReachTheLog)
{
    const cl::Program program =
        compileSource(*m_device, "warning", "__kernel void warn(__global int* out) { *out = *out && 4; }\n");
    ASSERT_FALSE(m_device->failed()) << m_device->error().text();
    EXPECT_TRUE(namesWarning(buildLog(*m_device, program))) << buildLog(*m_device, program);
}

INSTANTIATE_TEST_SUITE_P(Devices, BuildLogTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace
}  // namespace drape::test
