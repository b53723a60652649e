// Finds from the files of a machine's OpenCL drivers that it has no GPU.
#include "bullet_plugin/core/device/driver_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "tests/support/environment.h"

namespace drape::test
{
namespace
{
bool exists(const std::string&)
{
    return true;
}

bool isMissing(const std::string&)
{
    return false;
}

// The variables that change where the loader looks, all unset.
struct LoaderVariables
{
    ScopedVariable m_vendors{"OCL_ICD_VENDORS", nullptr}, m_path{"OPENCL_VENDOR_PATH", nullptr},
        m_files{"OCL_ICD_FILENAMES", nullptr}, m_pocl{"POCL_DEVICES", nullptr};
};
}  // namespace

TEST(DriverFiles, DriversOfACpuShowNoGpu)
{
    const LoaderVariables none;
    EXPECT_NE(whyNoGpu({{}, false}, exists), "");
    for (const char* library : {"libpocl.so.2.10.0", "/opt/intel/lib/libintelocl.so"})
        EXPECT_NE(whyNoGpu({{library}, false}, exists).find(library), std::string::npos);
}

TEST(DriverFiles, AGpusDriverNeedsItsDevice)
{
    const LoaderVariables none;
    for (const char* library : {"libnvidia-opencl.so.1", "libamdocl64.so", "/usr/lib/intel-opencl/libigdrcl.so",
                                "libMesaOpenCL.so.1", "libRusticlOpenCL.so.1"})
    {
        EXPECT_EQ(whyNoGpu({{"libpocl.so.2", library}, false}, exists), "") << library;
        EXPECT_NE(whyNoGpu({{"libpocl.so.2", library}, false}, isMissing), "") << library;
    }
    const auto hasNvidia = [](const std::string& path) { return path == "/dev/nvidiactl"; };
    EXPECT_EQ(whyNoGpu({{"libnvidia-opencl.so.1"}, false}, hasNvidia), "");
    EXPECT_NE(whyNoGpu({{"libamdocl64.so"}, false}, hasNvidia), "");
}

TEST(DriverFiles, WhatIsUnknownMayBeAGpu)
{
    const LoaderVariables none;
    EXPECT_EQ(whyNoGpu({{"libmaliopencl.so"}, false}, isMissing), "");
    EXPECT_EQ(whyNoGpu({{}, true}, isMissing), "");
    const ScopedVariable cuda("POCL_DEVICES", "cpu CUDA");
    EXPECT_EQ(whyNoGpu({{"libpocl.so.2"}, false}, isMissing), "");
}

TEST(DriverFiles, VariablesNameFoldersFilesAndLibraries)
{
    const LoaderVariables none;
    const TemporaryFolder folder;
    std::ofstream(folder.path() + "/one.icd") << "libone.so\n";
    std::ofstream(folder.path() + "/two.icd") << "  /opt/libtwo.so.1  \n";
    std::ofstream(folder.path() + "/readme.txt") << "libthree.so\n";
    const auto librariesOf = [](const char* vendors)
    {
        const ScopedVariable variable("OCL_ICD_VENDORS", vendors);
        const DriverFiles found = findDriverFiles();
        EXPECT_FALSE(found.m_mayHaveOthers);
        std::vector<std::string> libraries = found.m_libraries;
        std::sort(libraries.begin(), libraries.end());
        return libraries;
    };
    using Names = std::vector<std::string>;
    EXPECT_EQ(librariesOf(folder.path().c_str()), (Names{"/opt/libtwo.so.1", "libone.so"}));
    EXPECT_EQ(librariesOf((folder.path() + "/one.icd").c_str()), Names{"libone.so"});
    EXPECT_EQ(librariesOf("libfour.so"), Names{"libfour.so"});
    EXPECT_EQ(librariesOf("/nonexistent"), Names{});
    const ScopedVariable files("OCL_ICD_FILENAMES", "libfive.so:libsix.so");
    EXPECT_EQ(librariesOf("/nonexistent"), (Names{"libfive.so", "libsix.so"}));
}
}  // namespace drape::test
