// Settings out of their ranges are refused with an error that names the field; what is at a range's ends is not.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "tests/support/backends.h"

namespace drape::test
{
namespace
{
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Returns the error of making a pipeline on the host with changed settings; empty on success.
std::string errorOfSettings(const std::function<void(Settings&)>& change)
{
    Settings settings;
    settings.m_backend = Backend::Host;
    change(settings);
    Error error;
    const std::unique_ptr<Pipeline> pipeline = Pipeline::create(settings, error);
    EXPECT_EQ(pipeline == nullptr, error.failed());
    return error.text();
}
}  // namespace

TEST(SettingsRanges, ValuesOutOfRangeAreRefused)
{
    for (const float activation : {-0.1f, 4.1f, kNaN, kInfinity})
    {
        const std::string error = errorOfSettings([&](Settings& s) { s.m_activation = activation; });
        EXPECT_EQ(error.rfind("Settings::m_activation is ", 0), 0u) << error;
        EXPECT_NE(error.find("it should be 0 to 4"), std::string::npos) << error;
    }
    for (const float activation : {0.0f, 4.0f})
        EXPECT_EQ(errorOfSettings([&](Settings& s) { s.m_activation = activation; }), "");
    EXPECT_NE(errorOfSettings([](Settings& s) { s.m_mode = ContactMode(3); }), "");
    EXPECT_NE(errorOfSettings([](Settings& s) { s.m_solver = Solver(3); }), "");
    EXPECT_NE(errorOfSettings([](Settings& s) { s.m_solverPlace = SolverPlace(3); }), "");
    EXPECT_NE(errorOfSettings([](Settings& s) { s.m_dynamicConvex = ShapeContacts(2); }), "");
    EXPECT_NE(errorOfSettings([](Settings& s) { s.m_staticConvex = ShapeContacts(2); }), "");
    EXPECT_NE(errorOfSettings([](Settings& s) { s.m_surfaces = ShapeContacts(2); }), "");
    EXPECT_NE(errorOfSettings([](Settings& s) { s.m_crossover = double(kNaN); }), "");
    EXPECT_EQ(errorOfSettings([](Settings& s) { s.m_crossover = double(kInfinity); }), "");
}

TEST(StatusText, NamesEveryBit)
{
    EXPECT_EQ(statusText(kStepGood), "");
    std::string all;
    for (const std::uint32_t bit : {kStepInvalidNodes, kStepDeviceFailed, kStepDeviceFull, kStepClothsLeftOut,
                                    kStepCoarsePositions, kStepStartsIntersecting, kStepFacesLeftOut,
                                    kStepSurfacePassed, kStepMotionHeldBack, kStepOutOfMemory, kStepClothsMeet})
    {
        EXPECT_NE(statusText(bit), "");
        EXPECT_EQ(statusText(bit).find(';'), std::string::npos);
        all += (all.empty() ? "" : "; ") + statusText(bit);
    }
    EXPECT_EQ(statusText(0xffffffffu), all);
}
}  // namespace drape::test
