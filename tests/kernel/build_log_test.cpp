// Every kernel file of the product compiles on the test device without a warning in its build log.
#include <gtest/gtest.h>

#include <cctype>
#include <set>
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
// Files that one kind of device alone compiles; the stages load the others on both.
const std::set<std::string> kGpuFiles = {"broad_phase/patch_cull_pairs", "broad_phase/patch_traversal_gpu",
                                         "cloth_cloth/self_pack", "cloth_cloth/self_traversal_gpu",
                                         "ordering/ordering_small"};
const std::set<std::string> kCpuFiles = {"broad_phase/patch_cull", "cloth_cloth/self_contact_simd",
                                         "cloth_cloth/self_cull", "cloth_cloth/self_pack_simd",
                                         "narrow_phase/narrow_phase_simd"};

// Returns the names in "kernels/<name>.cl" that the device compiles.
std::vector<std::string> kernelFiles(const Device& device)
{
    const std::string folder = "kernels/", ending = ".cl";
    const std::set<std::string>& others = device.isGpu() ? kCpuFiles : kGpuFiles;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < kEmbeddedFileCount; ++i)
    {
        const std::string path = kEmbeddedFiles[i].m_path;
        if (path.compare(0, folder.size(), folder) != 0 || path.size() < ending.size()) continue;
        if (path.compare(path.size() - ending.size(), ending.size(), ending) != 0) continue;
        const std::string name = path.substr(folder.size(), path.size() - folder.size() - ending.size());
        if (others.count(name) == 0) names.push_back(name);
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
// compiler says of every kernel with a fixed group size that it may be inlined.
bool namesWarning(const std::string& log)
{
    std::istringstream lines(log);
    for (std::string line; std::getline(lines, line);)
    {
        if (line.find("is a kernel, so overriding noinline attribute") != std::string::npos) continue;
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
