// The summary of a run has the most intersecting pairs with their step, and no statistics of steps in contact if there
// were none.
#include <gtest/gtest.h>

#include <cmath>

#include "tools/cloth_drop/report.h"
#include "tools/cloth_drop/step_stream.h"

namespace drape::test
{
namespace
{
NamedRun runOf(const std::string& name, const std::vector<std::size_t>& pairs, std::size_t contacts)
{
    NamedRun run;
    run.m_name = name;
    run.m_record.m_backend = "host";
    for (const std::size_t count : pairs)
    {
        StepRecord step;
        step.m_times.m_stepMs = 2;
        step.m_times.m_collisionMs = 1;
        step.m_times.m_contacts = contacts;
        step.m_measure.m_intersectingPairs = count;
        run.m_record.m_steps.push_back(step);
    }
    return run;
}
}  // namespace

TEST(RunSummary, HasTheMostIntersectingPairsAndTheFirstStepThatHadThem)
{
    const auto most = [](const std::vector<std::size_t>& pairs)
    {
        const auto json = asJson({runOf("drape", pairs, 7)}, false);
        const std::pair<std::size_t, std::size_t> found = {json.at("intersecting_pairs_max"),
                                                           json.at("intersecting_pairs_max_step")};
        EXPECT_EQ(json.at("intersecting_pairs_end"), pairs.empty() ? 0 : pairs.back());
        return found;
    };
    using Most = std::pair<std::size_t, std::size_t>;
    EXPECT_EQ(most({0, 3, 5, 5, 1, 0}), Most(5, 3));
    EXPECT_EQ(most({4}), Most(4, 1));
    EXPECT_EQ(most({0, 0, 9}), Most(9, 3));
    EXPECT_EQ(most({0, 0}), Most(0, 0));
    EXPECT_EQ(most({}), Most(0, 0));
    EXPECT_NE(asTable({runOf("drape", {0, 3, 5, 1}, 7)}).find("5 (3)"), std::string::npos);
}

TEST(RunSummary, StretchIsAgainstTheLengthsAtTheStart)
{
    TriangleMesh cloth;
    cloth.m_positions = {0, 0, 0, 1, 0, 0, 0, 0, 2};
    cloth.m_triangles = {0, 1, 2};
    const StretchMeter meter(cloth);
    EXPECT_DOUBLE_EQ(meter.measure(cloth.m_positions).m_mean, 0);
    EXPECT_DOUBLE_EQ(meter.measure(cloth.m_positions).m_max, 0);
    // Twice as large: every edge is longer by its own length.
    const MeshStretch twice = meter.measure({0, 0, 0, 2, 0, 0, 0, 0, 4});
    EXPECT_NEAR(twice.m_mean, 1, 1e-12);
    EXPECT_NEAR(twice.m_max, 1, 1e-12);
    // The first edge half as long, the second one unchanged.
    const MeshStretch narrow = meter.measure({0, 0, 0, 0.5f, 0, 0, 0, 0, 2});
    EXPECT_DOUBLE_EQ(narrow.m_max, 0);
    EXPECT_NEAR(narrow.m_mean, (-0.5 + std::sqrt(4.25 / 5) - 1) / 3, 1e-7);
}

TEST(RunSummary, TheTableHasTheStretchAtTheEnd)
{
    NamedRun run = runOf("drape", {0, 0}, 1);
    run.m_record.m_steps.back().m_stretch = {0.0125, 0.5};
    const std::string table = asTable({run});
    const auto rowOf = [&](const std::string& label)
    {
        const std::size_t at = std::min(table.find(label), table.size());
        return table.substr(at, table.find('\n', at) - at);
    };
    EXPECT_NE(rowOf("stretch, mean, end, %").find(" 1.25"), std::string::npos) << table;
    EXPECT_NE(rowOf("stretch, maximum, end, %").find(" 50.00"), std::string::npos) << table;
}

TEST(RunSummary, SpeedAtRestIsThatOfTheLastQuarter)
{
    NamedRun run = runOf("drape", {0, 0, 0, 0, 0, 0, 0, 0}, 1);
    for (std::size_t i = 0; i < 8; ++i)
        run.m_record.m_steps[i].m_speed = i < 6 ? 9 : double(i) - 3;
    EXPECT_NEAR(double(asJson({run}, false).at("rest_speed_mm_s")), 1000 * std::sqrt((9.0 + 16.0) / 2), 1e-6);
}

TEST(RunSummary, SaysNothingOfStepsInContactWhereThereWereNone)
{
    const auto json = asJson({runOf("drape", {0, 0}, 0)}, false);
    EXPECT_EQ(json.at("steps_in_contact"), 0);
    for (const char* key : {"step_ms", "collision_ms", "finding_ms", "step_parts_ms", "penetration_p99_m"})
        EXPECT_TRUE(json.at(key).is_null()) << key;
    const std::string table = asTable({runOf("drape", {0, 0}, 0)});
    for (const char* label : {"step, ms", "collision, ms", "finding", "p99"})
        EXPECT_EQ(table.find(label), std::string::npos) << table;
    EXPECT_NE(table.find("2 (0)"), std::string::npos) << table;
}

TEST(RunSummary, HasNoRatioToARunThatWasNeverInContact)
{
    const std::vector<NamedRun> runs = {runOf("drape", {0}, 7), runOf("bullet_stock", {0}, 0),
                                        runOf("bullet_tuned", {0}, 7)};
    const auto json = asJson(runs, true);
    for (const char* key : {"ratio_stock", "ratio_stock_finding"})
        EXPECT_TRUE(json.at(key).is_null()) << key;
    EXPECT_EQ(json.at("ratio_tuned"), 1);
    EXPECT_TRUE(json.at("bullet_stock").at("step_ms").is_null());
    EXPECT_EQ(json.at("drape").at("step_ms").at("median"), 2);
    const std::string table = asTable(runs);
    const std::size_t row = table.find("step, ms, median");
    EXPECT_NE(table.substr(row, table.find('\n', row) - row).find(" - "), std::string::npos) << table;
}
}  // namespace drape::test
