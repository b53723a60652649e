// A backend's programs: each is built once, and a CPU has files that belong together as one.
#include "bullet_plugin/core/device/program_set.h"

#include <gtest/gtest.h>

#include "tests/support/backends.h"
#include "tests/support/environment.h"

namespace drape::test
{
namespace
{
bool hasKernel(const cl::Program& program, const char* name)
{
    cl_int code = CL_SUCCESS;
    const cl::Kernel kernel(program, name, &code);
    return code == CL_SUCCESS;
}

class ProgramSetTest : public BackendTest
{
};
}  // namespace

TEST_P(ProgramSetTest, FilesThatBelongTogetherAreOneProgramOnACpu)
{
    const std::unique_ptr<Device> device = openDevice(GetParam());
    ASSERT_TRUE(device);
    ProgramSet programs(*device, "none",
                        {{"queries/refit", "scene/place_obstacles"}, {"queries/queries", "queries/refit"}},
                        "// a caller's line\n");
    const cl::Program refit = programs.load("queries/refit"), place = programs.load("scene/place_obstacles"),
                      queries = programs.load("queries/queries");
    ASSERT_FALSE(device->failed()) << device->error().text();
    EXPECT_EQ(refit() == place(), !device->isGpu());
    EXPECT_NE(refit(), queries());
    EXPECT_TRUE(hasKernel(refit, "refitLeaves"));
    EXPECT_TRUE(hasKernel(place, "placeObstacles"));
    EXPECT_TRUE(hasKernel(queries, "queryPairs"));

    const std::string source = refit.getInfo<CL_PROGRAM_SOURCE>(), included = "#line 1 \"kernels/shared/types.h\"";
    const std::size_t first = source.find(included);
    EXPECT_NE(first, std::string::npos);
    EXPECT_EQ(source.find(included, first + 1), std::string::npos) << "a file that both include is there twice";
    EXPECT_NE(source.find("// a caller's line\n"), std::string::npos);
}

TEST_P(ProgramSetTest, AProgramIsBuiltOnce)
{
    const std::unique_ptr<Device> device = openDevice(GetParam());
    ASSERT_TRUE(device);
    ProgramSet programs(*device, "none", {{"queries/refit", "scene/place_obstacles"}});
    EXPECT_EQ(programs.load("scene/place_obstacles")(), programs.loader()("scene/place_obstacles")());
    EXPECT_EQ(programs.load("queries/queries")(), programs.load("queries/queries")());
}

TEST_P(ProgramSetTest, TellsWhetherAllCameFromTheCache)
{
    const TemporaryFolder folder;
    const std::unique_ptr<Device> device = openDevice(GetParam());
    ASSERT_TRUE(device);
    ProgramSet first(*device, folder.path(), {{"queries/refit", "scene/place_obstacles"}});
    EXPECT_TRUE(first.fromCache()) << "of no program";
    first.load("queries/refit");
    EXPECT_FALSE(first.fromCache());

    ProgramSet second(*device, folder.path(), {{"queries/refit", "scene/place_obstacles"}});
    second.load("queries/refit");
    EXPECT_EQ(second.fromCache(), !keepsItsOwn(device->info()));
    second.load("queries/queries");
    second.load("queries/refit");
    EXPECT_FALSE(second.fromCache());
}

TEST_P(ProgramSetTest, ABrokenFileIsNamedWithThoseItIsBuiltWith)
{
    const std::unique_ptr<Device> device = openDevice(GetParam());
    ASSERT_TRUE(device);
    ProgramSet programs(*device, "none", {{"queries/refit", "scene/place_obstacles"}}, "this is no kernel\n");
    programs.load("scene/place_obstacles");
    ASSERT_TRUE(device->failed());
    EXPECT_NE(device->error().m_call.find("kernels/scene/place_obstacles.cl"), std::string::npos)
        << device->error().text();
    EXPECT_EQ(device->error().m_call.find("kernels/queries/refit.cl") != std::string::npos, !device->isGpu());
}

INSTANTIATE_TEST_SUITE_P(Devices, ProgramSetTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
