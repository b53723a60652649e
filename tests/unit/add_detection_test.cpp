// Adds up the statistics of a step that detects contacts more than once.
#include "bullet_plugin/core/pipeline/add_detection.h"

#include <gtest/gtest.h>

namespace drape::test
{
namespace
{
StepStatistics detectionOf(std::size_t number)
{
    StepStatistics detection;
    detection.m_contacts = detection.m_obstaclesKept = detection.m_invalidNodes = number;
    detection.m_candidates = 100 * number;
    detection.m_retries = 1;
    detection.m_waitMs = 2;
    return detection;
}
}  // namespace

TEST(AddDetection, CountsAreThoseOfTheContactsThatTheSolverReceives)
{
    StepStatistics step;
    addDetection(step, detectionOf(7), Detection::First);
    addDetection(step, detectionOf(5), Detection::Again);
    addDetection(step, detectionOf(6), Detection::Check);
    EXPECT_EQ(step.m_contacts, 5u);
    EXPECT_EQ(step.m_candidates, 500u);
    EXPECT_EQ(step.m_obstaclesKept, 7u) << "later detections find them up to date";
    EXPECT_EQ(step.m_invalidNodes, 7u);
}

TEST(AddDetection, StatusAndCostAddUpAndTheSolversTimesStay)
{
    StepStatistics step, detection = detectionOf(1);
    step.m_status = kStepMotionHeldBack;
    step.m_uploadMs = 3;
    step.m_clothsSkipped = 4;
    detection.m_status = kStepInvalidNodes;
    detection.m_uploadMs = 9;
    detection.m_onHost = true;
    addDetection(step, detection, Detection::First);
    addDetection(step, detectionOf(1), Detection::Check);
    EXPECT_EQ(step.m_status, std::uint32_t(kStepMotionHeldBack | kStepInvalidNodes));
    EXPECT_EQ(step.m_retries, 2u);
    EXPECT_EQ(step.m_waitMs, 4);
    EXPECT_EQ(step.m_uploadMs, 3);
    EXPECT_EQ(step.m_clothsSkipped, 4u);
    EXPECT_TRUE(step.m_onHost);
}
}  // namespace drape::test
