#include "tests/support/pair_batch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/backends.h"
#include "tests/support/self_cases.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
TriangleMesh meshOf(const Corners& corners)
{
    return looseTriangles(std::vector<float>(corners.begin(), corners.end()));
}

Corners inOrder(const Corners& corners, const int* order)
{
    Corners result;
    for (int i = 0; i < 3; ++i)
        std::copy_n(&corners[std::size_t(3 * order[i])], 3, &result[std::size_t(3 * i)]);
    return result;
}

std::size_t countIntersecting(const Settings& settings, const std::vector<TrianglePair>& pairs)
{
    std::vector<TriangleQuery> asked(pairs.size());
    for (std::size_t i = 0; i < pairs.size(); ++i)
    {
        std::copy(pairs[i].m_cloth.begin(), pairs[i].m_cloth.end(), asked[i].m_a);
        std::copy(pairs[i].m_obstacle.begin(), pairs[i].m_obstacle.end(), asked[i].m_b);
    }
    std::vector<std::uint32_t> answers(pairs.size());
    const std::unique_ptr<Queries> queries = makeQueries(settings);
    if (!queries || !queries->triangles(asked.data(), asked.size(), TriangleTest::Certified, answers.data()))
        ADD_FAILURE() << "no answers";
    return std::size_t(std::count_if(answers.begin(), answers.end(), [](std::uint32_t answer) { return answer != 0; }));
}
}  // namespace

BatchResult runBatch(const Settings& settings, const std::vector<TrianglePair>& pairs, float thickness)
{
    BatchResult result;
    result.m_contacts.resize(pairs.size());
    result.m_intersecting = countIntersecting(settings, pairs);
    const std::unique_ptr<Pipeline> pipeline = makePipeline(settings);
    if (!pipeline) return result;
    std::vector<MeshId> cloths, obstacles;
    for (const TrianglePair& pair : pairs)
    {
        cloths.push_back(addCloth(*pipeline, meshOf(pair.m_cloth)));
        obstacles.push_back(addObstacle(*pipeline, meshOf(pair.m_obstacle)));
    }
    for (std::size_t i = 0; i < pairs.size(); ++i)
    {
        const TriangleMesh mesh = meshOf(pairs[i].m_cloth);
        setMotion(*pipeline, cloths[i], mesh.m_positions, mesh.m_positions);
        pipeline->addPair(cloths[i], obstacles[i], thickness);
    }
    result.m_all = runStep(*pipeline);
    EXPECT_FALSE(pipeline->statistics().m_status & kStepDeviceFailed) << pipeline->lastError().text();
    for (const Contact& contact : result.m_all)
    {
        const MeshId cloth = pipeline->view(contact).m_cloth;
        const auto found = std::find(cloths.begin(), cloths.end(), cloth);
        result.m_contacts[std::size_t(found - cloths.begin())].push_back(contact);
    }
    return result;
}

std::vector<TrianglePair> allOrders(const TrianglePair& pair)
{
    const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    std::vector<TrianglePair> pairs;
    for (const auto& first : orders)
    {
        for (const auto& second : orders)
            pairs.push_back({inOrder(pair.m_cloth, first), inOrder(pair.m_obstacle, second)});
    }
    return pairs;
}

void expectFinite(const std::vector<Contact>& contacts)
{
    for (const Contact& contact : contacts)
    {
        double square = 0;
        for (int i = 0; i < 3; ++i)
        {
            ASSERT_TRUE(std::isfinite(contact.m_point[i]) && std::isfinite(contact.m_weights[i])) << describe(contact);
            square += double(contact.m_normal[i]) * double(contact.m_normal[i]);
        }
        ASSERT_NEAR(square, 1.0, 1e-4) << describe(contact);
        ASSERT_TRUE(std::isfinite(contact.m_gap0) && std::isfinite(contact.m_gap1) && std::isfinite(contact.m_time))
            << describe(contact);
    }
}
}  // namespace drape::test
