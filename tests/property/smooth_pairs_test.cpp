// Pairs of patches that lie smoothly: leaving them out changes no contact, and their points keep their distance.
#include <gtest/gtest.h>

#include <cmath>

#include "bullet_plugin/core/cloth_cloth/host_self_patches.h"
#include "bullet_plugin/core/scene/scene.h"
#include "scenes/cloth_grid.h"
#include "scenes/random.h"
#include "scenes/vector3.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
constexpr float kThickness = 0.05f;

// A cloth of uneven triangles, flat or curved at rest.
struct Sheet
{
    Sheet(int nodes, float bend, std::uint32_t seed, ThreadTeam& threads) : m_threads(threads)
    {
        Random random(seed);
        m_grid = makeClothGrid(nodes, nodes, 2, 0).m_mesh;
        const float edge = 2 / float(nodes - 1);
        for (float& coordinate : m_grid.m_positions)
            coordinate += float(random.within(-0.2, 0.2)) * edge * (bend < 0 ? 0.0f : 1.0f);
        for (std::size_t i = 0; i < m_grid.m_positions.size(); i += 3)
            m_grid.m_positions[i + 1] += bend * m_grid.m_positions[i] * m_grid.m_positions[i];
        MeshDescription mesh;
        mesh.m_triangles = m_grid.m_triangles.data();
        mesh.m_triangleCount = m_grid.triangleCount();
        mesh.m_positions = m_grid.m_positions.data();
        mesh.m_vertexCount = m_grid.vertexCount();
        mesh.m_selfThickness = kThickness;
        m_scene.addCloth(mesh);
        m_scene.join(nullptr);
        m_patches.update(m_scene.m_cloths, m_scene.m_clothRest.data());
        m_patches.findSmoothPairs(m_scene.m_cloths, m_scene.m_clothRest.data(), 2 * kThickness, threads);
    }

    // Returns the nodes on waves of this height and length, m, with some noise. High waves are squeezed into folds.
    std::vector<float> waved(float height, float length, float phase, float noise, Random& random) const
    {
        std::vector<float> all = m_grid.m_positions;
        for (std::size_t i = 0; i < all.size(); i += 3)
        {
            all[i + 1] += height * std::sin(6.2831853f * (all[i] + 0.3f * all[i + 2]) / length + phase);
            all[i] *= 1 - 2 * height;
            for (std::size_t k = 0; k < 3; ++k)
                all[i + k] += float(random.within(-noise, noise));
        }
        return all;
    }

    std::vector<Contact> contacts(const std::vector<float>& start, const std::vector<float>& end, float share)
    {
        const MeshPool& cloths = m_scene.m_cloths;
        const SelfReach reach = {{kThickness}, {selfGrowth(1.5f * kThickness)}};
        const std::vector<float> none = {-1.0f};
        const ClothView view = clothView(start.data(), end.data(), cloths.triangles().data(), cloths.edges().data(),
                                         std::uint32_t(cloths.vertexCount()), std::uint32_t(cloths.triangles().size()),
                                         DRAPE_CONTINUOUS, nullptr);
        const SelfStep step = {cloths, selfView(view, m_scene.m_clothRest.data(), 1.5f), reach, none, share};
        std::vector<Contact> contacts;
        m_patches.cull(step, UINT64_MAX, m_threads);
        m_patches.findContacts(step, {}, m_threads, contacts);
        return contacts;
    }

    ThreadTeam& m_threads;
    TriangleMesh m_grid;
    Scene m_scene;
    HostSelfPatches m_patches;
};

Vector3 pointOf(const std::vector<float>& positions, const Triangle& triangle, const double weights[3])
{
    Vector3 point = {0, 0, 0};
    for (int k = 0; k < 3; ++k)
    {
        const float* const p = positions.data() + 3 * triangle.m_vertices[k];
        point = point + weights[k] * Vector3{p[0], p[1], p[2]};
    }
    return point;
}

void drawWeights(Random& random, double weights[3])
{
    const double a = random.within(0, 1), b = random.within(0, 1);
    weights[0] = std::min(a, b);
    weights[1] = std::fabs(a - b);
    weights[2] = 1 - std::max(a, b);
}
}  // namespace

TEST(SmoothPairs, LeavingThemOutChangesNoContact)
{
    ThreadTeam threads(2);
    std::size_t contacts = 0, smooth = 0, rough = 0;
    for (const float bend : {-1e-9f, 0.0f, 0.4f})
    {
        Sheet sheet(29, bend, 7, threads);
        Random random(8);
        for (const float height : {0.0f, 0.02f, 0.1f, 0.3f})
            for (const float wave : {0.15f, 0.6f, 1.5f})
                for (const float motion : {0.0f, 0.3f})
                {
                    const std::vector<float> start = sheet.waved(height, wave, 0, 0.003f, random);
                    std::vector<float> end = sheet.waved(height, wave, 4 * motion, 0.003f, random);
                    for (std::size_t i = 1; i < end.size(); i += 3)
                        end[i] -= motion;
                    const std::vector<Contact> expected = sheet.contacts(start, end, 0);
                    const std::uint64_t pairs = sheet.m_patches.counts().m_candidates;
                    const std::vector<Contact> found = sheet.contacts(start, end, 0.76f);
                    EXPECT_TRUE(sameBytes(found, expected)) << difference(found, expected);
                    contacts += found.size();
                    smooth += sheet.m_patches.counts().m_smoothPairs;
                    rough += sheet.m_patches.counts().m_smoothPairs == 0;
                    EXPECT_LE(sheet.m_patches.counts().m_candidates, pairs);
                }
    }
    EXPECT_GT(contacts, 10000u);
    EXPECT_GT(smooth, 5000u);
    EXPECT_GT(rough, 0u);
}

TEST(SmoothPairs, PointsKeepTheirShareOfTheDistanceAtRest)
{
    ThreadTeam threads(2);
    for (const float share : {0.1f, 0.76f})
    {
        std::size_t checked = 0;
        double least = 1e9;
        for (const float bend : {0.0f, 0.4f})
        {
            Sheet sheet(25, bend, 3, threads);
            Random random(4);
            for (int turn = 0; turn < 12; ++turn)
            {
                const float height = float(random.within(0, 0.1)), wave = float(random.within(0.4, 1.5));
                const std::vector<float> start = sheet.waved(height, wave, 0, 0.004f, random);
                const std::vector<float> end = sheet.waved(height, wave, 0.7f, 0.004f, random);
                SmoothPairs& pairs = sheet.m_patches.smoothPairs();
                pairs.check(start.data(), end.data(), share, threads);
                const std::vector<Triangle>& triangles = sheet.m_scene.m_cloths.triangles();
                for (int draw = 0; draw < 40000; ++draw)
                {
                    const std::uint32_t a = std::uint32_t(random.within(0, double(triangles.size())));
                    const std::uint32_t b = std::uint32_t(random.within(0, double(triangles.size())));
                    if (!pairs.isSmooth(a, b)) continue;
                    double first[3], second[3];
                    drawWeights(random, first);
                    drawWeights(random, second);
                    const double time = random.within(0, 1);
                    const auto distanceIn = [&](const std::vector<float>& places)
                    { return pointOf(places, triangles[a], first) - pointOf(places, triangles[b], second); };
                    const Vector3 now = (1 - time) * distanceIn(start) + time * distanceIn(end);
                    const double ratio = length(now) / length(distanceIn(sheet.m_grid.m_positions));
                    least = std::min(least, ratio);
                    ++checked;
                }
            }
        }
        EXPECT_GE(least, double(share));
        EXPECT_GT(checked, 2000u);
    }
}

TEST(SmoothPairs, AFoldIsNotSmooth)
{
    ThreadTeam threads(1);
    Sheet sheet(17, -1e-9f, 1, threads);
    Random random(1);
    std::vector<float> folded = sheet.m_grid.m_positions;
    SmoothPairs& pairs = sheet.m_patches.smoothPairs();
    const std::size_t flat = pairs.check(folded.data(), folded.data(), 0.1f, threads);
    for (std::size_t i = 0; i < folded.size(); i += 3)
        if (folded[i] > 0.01f)
        {
            folded[i] = -folded[i];
            folded[i + 1] += 0.1f;
        }
    const std::size_t rest = pairs.check(folded.data(), folded.data(), 0.1f, threads);
    EXPECT_LT(rest, flat);
    const std::vector<Triangle>& triangles = sheet.m_scene.m_cloths.triangles();
    for (std::uint32_t a = 0; a < triangles.size(); ++a)
        for (std::uint32_t b = 0; b < a; ++b)
        {
            if (!pairs.isSmooth(a, b)) continue;
            const double middle[3] = {1.0 / 3, 1.0 / 3, 1.0 / 3};
            const double x = pointOf(sheet.m_grid.m_positions, triangles[a], middle).x;
            EXPECT_GE(x * pointOf(sheet.m_grid.m_positions, triangles[b], middle).x, 0.0) << a << " " << b;
        }
    // Between the two places nodes pass each other.
    EXPECT_LE(pairs.check(sheet.m_grid.m_positions.data(), folded.data(), 0.1f, threads), rest);
}

TEST(SmoothPairs, RecheckBarsWhatIsNotSmoothAnyMore)
{
    ThreadTeam threads(1);
    Sheet sheet(17, -1e-9f, 1, threads);
    const std::vector<float>& flat = sheet.m_grid.m_positions;
    std::vector<float> bent = flat;
    bent[3 * 8 * 17 + 3 * 8] += 0.2f;  // over its neighbours
    SmoothPairs& pairs = sheet.m_patches.smoothPairs();
    const std::size_t all = pairs.check(flat.data(), flat.data(), 0.76f, threads);
    const std::vector<unsigned char> none(flat.size() / 3, 0);
    EXPECT_EQ(pairs.recheck(flat.data(), bent.data(), 0.76f, none.data(), threads), 0u);
    const std::size_t lost = pairs.recheck(flat.data(), bent.data(), 0.76f, nullptr, threads);
    EXPECT_GT(lost, 0u);
    EXPECT_FALSE(pairs.patchesOfLost().empty());
    EXPECT_EQ(pairs.check(flat.data(), flat.data(), 0.76f, threads), all - lost);
    EXPECT_EQ(pairs.recheck(flat.data(), bent.data(), 0.76f, nullptr, threads), 0u);
    EXPECT_TRUE(pairs.patchesOfLost().empty());
    pairs.allowAll();
    EXPECT_EQ(pairs.check(flat.data(), flat.data(), 0.76f, threads), all);
}
}  // namespace drape::test
