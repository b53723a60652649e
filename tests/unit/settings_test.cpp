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

using Change = std::function<void(Methods&)>;

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

std::string errorOf(const Change& change)
{
    return errorOfSettings([&](Settings& settings) { change(settings.m_methods); });
}

void expectRefused(const std::string& text, const Change& change)
{
    EXPECT_EQ(errorOf(change).rfind("Methods::" + text + "\nit should be ", 0), 0u) << errorOf(change);
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
    EXPECT_NE(errorOfSettings([](Settings& s) { s.m_crossover = double(kNaN); }), "");
    EXPECT_EQ(errorOfSettings([](Settings& s) { s.m_crossover = double(kInfinity); }), "");
}

TEST(StatusText, NamesEveryBit)
{
    EXPECT_EQ(statusText(kStepGood), "");
    std::string all;
    for (const std::uint32_t bit :
         {kStepInvalidNodes, kStepDeviceFailed, kStepDeviceFull, kStepClothsLeftOut, kStepCoarsePositions,
          kStepStartsIntersecting, kStepFacesLeftOut, kStepSurfacePassed, kStepMotionHeldBack, kStepOutOfMemory})
    {
        EXPECT_NE(statusText(bit), "");
        EXPECT_EQ(statusText(bit).find(';'), std::string::npos);
        all += (all.empty() ? "" : "; ") + statusText(bit);
    }
    EXPECT_EQ(statusText(0xffffffffu), all);
}

TEST(MethodsRanges, ValuesOutOfRangeAreRefused)
{
    expectRefused("m_traversal is 8", [](Methods& m) { m.m_traversal = Traversal(8); });
    expectRefused("m_tree.m_builder is -1", [](Methods& m) { m.m_tree.m_builder = TreeBuilder(-1); });
    expectRefused("m_tree.m_refit is 2", [](Methods& m) { m.m_tree.m_refit = RefitMethod(2); });
    expectRefused("m_tree.m_workShape is 3", [](Methods& m) { m.m_tree.m_workShape = WorkShape(3); });
    for (const std::uint32_t bits : {0u, 29u, 31u, 60u, 64u})
        expectRefused("m_tree.m_mortonBits is " + std::to_string(bits),
                      [&](Methods& m) { m.m_tree.m_mortonBits = bits; });
    for (const std::uint32_t radius : {0u, 33u})
        expectRefused("m_tree.m_plocRadius is " + std::to_string(radius),
                      [&](Methods& m) { m.m_tree.m_plocRadius = radius; });
    expectRefused("m_tree.m_topDown.m_leafSize is 0", [](Methods& m) { m.m_tree.m_topDown.m_leafSize = 0; });
    expectRefused("m_tree.m_topDown.m_largeSize is 0", [](Methods& m) { m.m_tree.m_topDown.m_largeSize = 0; });
    for (const std::uint32_t size : {0u, 8u, 100u, 512u})
    {
        expectRefused("m_tree.m_topDown.m_groupSize is " + std::to_string(size),
                      [&](Methods& m) { m.m_tree.m_topDown.m_groupSize = size; });
        expectRefused("m_tree.m_topDown.m_compactionGroup is " + std::to_string(size),
                      [&](Methods& m) { m.m_tree.m_topDown.m_compactionGroup = size; });
    }
    expectRefused("m_tree.m_topDown.m_smallShare is -0.5", [](Methods& m) { m.m_tree.m_topDown.m_smallShare = -0.5f; });
    expectRefused("m_tree.m_topDown.m_smallShare is nan", [](Methods& m) { m.m_tree.m_topDown.m_smallShare = kNaN; });
    expectRefused("m_rebuildDecay is 0.5", [](Methods& m) { m.m_rebuildDecay = 0.5f; });
    expectRefused("m_rebuildDecay is -1", [](Methods& m) { m.m_rebuildDecay = -1.0f; });
    expectRefused("m_rebuildDecay is nan", [](Methods& m) { m.m_rebuildDecay = kNaN; });
}

TEST(MethodsRanges, ValuesAtTheEndsAreAccepted)
{
    EXPECT_EQ(errorOf([](Methods&) {}), "");
    EXPECT_EQ(errorOf(
                  [](Methods& m)
                  {
                      m.m_traversal = Traversal::WideGroups;
                      m.m_tree.m_builder = TreeBuilder::Ploc;
                      m.m_tree.m_workShape = WorkShape::Serial;
                      m.m_tree.m_refit = RefitMethod::Levels;
                      m.m_tree.m_mortonBits = 63;
                      m.m_tree.m_plocRadius = 32;
                      m.m_tree.m_topDown.m_leafSize = 0xffffffffu;
                      m.m_tree.m_topDown.m_groupSize = m.m_tree.m_topDown.m_compactionGroup = 256;
                      m.m_tree.m_topDown.m_smallShare = kInfinity;
                      m.m_tree.m_topDown.m_largeSize = 0xffffffffu;
                      m.m_rebuildDecay = kInfinity;
                  }),
              "");
    EXPECT_EQ(errorOf(
                  [](Methods& m)
                  {
                      m.m_tree.m_plocRadius = 1;
                      m.m_tree.m_topDown.m_groupSize = m.m_tree.m_topDown.m_compactionGroup = 16;
                      m.m_tree.m_topDown.m_smallShare = 0;
                      m.m_tree.m_topDown.m_largeSize = 1;
                      m.m_rebuildDecay = 1;
                  }),
              "");
}
}  // namespace drape::test
