// Runs code that changes its process for good in a process of its own.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <iostream>

namespace drape::test
{
// Runs the scenario in a new process, which repeats the test up to here. Its failures are this test's; what it prints
// is shown with them.
inline void inOwnProcess(const std::function<void()>& scenario)
{
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const auto run = [&]
    {
        scenario();
        const testing::TestResult& result = *testing::UnitTest::GetInstance()->current_test_info()->result();
        for (int i = 0; i < result.total_part_count(); ++i)
            std::cerr << result.GetTestPartResult(i) << std::endl;
        std::_Exit(testing::Test::HasFailure() ? 1 : 0);
    };
    EXPECT_EXIT(run(), testing::ExitedWithCode(0), "");
}
}  // namespace drape::test
