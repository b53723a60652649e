// Chooses the cloths that are left out of a step over its limits.
#include "bullet_plugin/core/pipeline/cloths_over_budget.h"

#include <gtest/gtest.h>

namespace drape::test
{
namespace
{
using Slots = std::vector<std::size_t>;
}

TEST(ClothsOverBudget, ClothsWithTheMostCandidatesAreRemoved)
{
    EXPECT_EQ(clothsOverBudget({0, 1, 2, 3}, {5, 90, 7, 40}, 60), (Slots{1}));
    EXPECT_EQ(clothsOverBudget({0, 1, 2, 3}, {5, 90, 7, 40}, 12), (Slots{3, 1}));
    EXPECT_EQ(clothsOverBudget({0, 1, 2}, {8, 8, 8}, 16), (Slots{2}));
}

TEST(ClothsOverBudget, OneClothIsRemovedWhateverTheCounts)
{
    EXPECT_EQ(clothsOverBudget({0, 1}, {0, 0}, 100), (Slots{1}));
    EXPECT_EQ(clothsOverBudget({4}, {0, 0, 0, 0, 0}, 100), (Slots{4}));
    EXPECT_TRUE(clothsOverBudget({}, {0, 0}, 100).empty());
}

// A cloth that is already out counts nothing, and must not replace one that has to go.
TEST(ClothsOverBudget, OnlyParticipatingClothsAreRemoved)
{
    EXPECT_EQ(clothsOverBudget({0}, {0, 0}, 100), (Slots{0}));
    EXPECT_EQ(clothsOverBudget({0, 2}, {3, 0, 9}, 5), (Slots{2}));
}
}  // namespace drape::test
