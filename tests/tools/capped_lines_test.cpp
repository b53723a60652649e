// The steps of a child that are kept when its time limit ends it, however the text is cut.
#include "tools/cloth_drop/capped_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace drape::test
{
namespace
{
constexpr std::size_t kWhole = 1 << 20;

// Returns a line with a time in ms.
std::string line(const char* word, int time)
{
    return std::string(word) + " " + std::to_string(1000000LL * time) + "\n";
}

// Returns the lines of steps of 10 ms, each measured for 30, one after the other.
std::string stepsOf(int count)
{
    std::string text;
    for (int i = 0; i < count; ++i)
    {
        const int time = 1000 + 40 * i;
        text += line("step", time) + line("stepped", time + 10) + line("measured", time + 40);
        text += "{\"step\": " + std::to_string(i + 1) + "}\n";
    }
    return text;
}

struct Kept
{
    std::vector<std::string> m_lines;
    int m_step = 0;
    bool m_capped = false;
};

Kept keep(const ChildCap& cap, const std::string& text, std::size_t chunk)
{
    Kept kept;
    CappedLines lines(cap, [&](int, const std::string& line) { kept.m_lines.push_back(line); });
    for (std::size_t from = 0; from < text.size() && !kept.m_capped; from += chunk)
        kept.m_capped = !lines.take(text.data() + from, std::min(chunk, text.size() - from));
    kept.m_step = lines.step();
    return kept;
}

void expectKept(const ChildCap& cap, std::size_t steps, bool capped)
{
    for (const std::size_t chunk : {kWhole, std::size_t(7), std::size_t(1)})
    {
        SCOPED_TRACE(chunk);
        const Kept kept = keep(cap, stepsOf(5), chunk);
        EXPECT_EQ(kept.m_lines.size(), steps);
        EXPECT_EQ(kept.m_capped, capped);
        EXPECT_EQ(kept.m_step, int(steps) + (capped ? 1 : 0));
        if (steps > 0)
        {
            EXPECT_EQ(kept.m_lines.back(), "{\"step\": " + std::to_string(steps) + "}");
        }
    }
}
}  // namespace

TEST(CappedLines, CountStepsAlone)
{
    expectKept({0.001}, 0, true);
    expectKept({0.025}, 2, true);
    expectKept({0.045}, 4, true);
    expectKept({0.055}, 5, false);
}

TEST(CappedLines, CountMeasuringWhereAsked)
{
    expectKept({0.001, true}, 0, true);
    expectKept({0.030, true}, 0, true);  // within the first step's measuring
    expectKept({0.060, true}, 1, true);
    expectKept({0.190, true}, 4, true);  // within the last one's
    expectKept({0.210, true}, 5, false);
}

TEST(CappedLines, LoadingCountsNothing)
{
    const Kept kept = keep({0.001, true}, "loading\nstill loading\n", kWhole);
    EXPECT_FALSE(kept.m_capped);
    EXPECT_EQ(kept.m_step, 0);
    EXPECT_EQ(kept.m_lines.size(), 2u);
}
}  // namespace drape::test
