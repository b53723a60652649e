// Rows of the stress table that are about whole meshes: scale and place, winding, what is no surface, the order of
// things. tests/README.md has the table.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "scenes/shapes.h"
#include "tests/support/backends.h"
#include "tests/support/contact_oracle.h"
#include "tests/support/pair_batch.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
using Positions = std::vector<float>;

std::vector<Positions*> positionsOf(StepCase& step)
{
    return {&step.m_cloth.m_positions, &step.m_end, &step.m_obstacle.m_positions};
}

void scale(StepCase& step, float factor)
{
    for (Positions* positions : positionsOf(step))
    {
        for (float& coordinate : *positions)
            coordinate *= factor;
    }
    step.m_thickness *= factor;
}

void flipWinding(TriangleMesh& mesh)
{
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
        std::swap(mesh.m_triangles[3 * t + 1], mesh.m_triangles[3 * t + 2]);
}

using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>;
Key keyOf(const Contact& contact)
{
    return Key(contact.m_kind, contact.m_clothFeature, contact.m_obstacleFeature);
}
}  // namespace

class MeshRows : public BackendTest
{
protected:
    struct Run
    {
        std::vector<Contact> m_contacts;
        StepStatistics m_statistics;
    };

    Run run(const StepCase& step)
    {
        Settings settings = GetParam().m_settings;
        settings.m_reportIntersections = true;
        settings.m_activation = 0;  // contacts within the thickness
        const std::unique_ptr<Pipeline> pipeline = makePipeline(settings);
        if (!pipeline) return {};
        Run result = {runCase(*pipeline, step), {}};
        result.m_statistics = pipeline->statistics();
        expectFinite(result.m_contacts);
        return result;
    }

    // Nothing within the thickness is missed, nothing beyond it is kept, in the numbers as they were rounded.
    void expectTruth(const StepCase& step, const std::vector<Contact>& contacts)
    {
        Side cloth = makeSide({step.m_cloth});
        const Side obstacle = makeSide({step.m_obstacle});
        cloth.m_end = step.m_end;
        const std::vector<RequiredContact> required =
            requiredContacts(cloth, obstacle, double(step.m_thickness) * (1 - kReachMargin));
        EXPECT_GT(required.size(), 50u);
        for (const RequiredContact& wanted : required)
        {
            EXPECT_TRUE(std::any_of(contacts.begin(), contacts.end(),
                                    [&](const Contact& contact) { return sameFeatures(wanted, contact); }))
                << "missed: kind " << wanted.m_kind << " cloth " << wanted.m_clothFeature << " obstacle "
                << wanted.m_obstacleFeature << " distance " << wanted.m_distance;
        }
        for (const Contact& contact : contacts)
        {
            // 6.6e-5 of the extent: what the certified distance keeps unnecessarily (bound 4).
            EXPECT_LE(contactDistance(contact, cloth, obstacle) - double(step.m_thickness),
                      6.6e-5 * contactExtent(contact, cloth, obstacle))
                << describe(contact);
        }
    }
};

TEST_P(MeshRows, Row08ScalesOfAMillionthAndAMillion)
{
    const StepCase original = drapedCase("torus", 14, 0.03f, 1108);
    SCOPED_TRACE(original.trace());
    const Run reference = run(original);
    for (const float factor : {1e-6f, 1e6f, 0x1p-20f, 0x1p20f})
    {
        SCOPED_TRACE(factor);
        StepCase step = original;
        scale(step, factor);
        Run scaled = run(step);
        EXPECT_EQ(scaled.m_statistics.m_status, std::uint32_t(kStepGood));
        expectTruth(step, scaled.m_contacts);
        int exponent = 0;
        if (std::frexp(factor, &exponent) != 0.5f) continue;
        for (Contact& contact : scaled.m_contacts)
        {
            for (float* length :
                 {&contact.m_gap0, &contact.m_gap1, &contact.m_point[0], &contact.m_point[1], &contact.m_point[2]})
                *length /= factor;
        }
        EXPECT_TRUE(sameBytes(scaled.m_contacts, reference.m_contacts))
            << difference(scaled.m_contacts, reference.m_contacts);
    }
}

// A million metres out, floats are 62.5 mm apart: the rounded positions are another shape, and its truth is found. A
// thickness below that step brings a warning.
TEST_P(MeshRows, Row08OffsetOfAMillion)
{
    StepCase step = drapedCase("torus", 14, 0.3f, 1109);
    SCOPED_TRACE(step.trace());
    for (Positions* positions : positionsOf(step))
    {
        for (float& coordinate : *positions)
            coordinate *= 10;
        translate(*positions, 1e6f, 0, -1e6f);
    }
    const Run coarse = run(step);
    EXPECT_EQ(coarse.m_statistics.m_status, std::uint32_t(kStepGood));
    expectTruth(step, coarse.m_contacts);
    step.m_thickness = 0.06f;
    EXPECT_EQ(run(step).m_statistics.m_status, std::uint32_t(kStepCoarsePositions));
    step.m_thickness = 0.063f;
    EXPECT_EQ(run(step).m_statistics.m_status, std::uint32_t(kStepGood));
}

// Winding turns normals over and changes no distance: the same pairs of triangles and, but for seams where rounding
// decides which neighbour reports, the same contacts.
TEST_P(MeshRows, Row13FlippedWindingAndInvertedElements)
{
    StepCase original = fallingCase("torus", 16, 0.03f, 1113);
    SCOPED_TRACE(original.trace());
    // Every fifth node goes to the other side of its neighbours in the step: faces turn over.
    for (std::size_t node = 0; node < original.m_cloth.vertexCount(); node += 5)
        original.m_end[3 * node] += node % 2 ? 0.16f : -0.16f;
    const Run reference = run(original);
    EXPECT_GT(reference.m_statistics.m_intersections, 20u);
    std::set<Key> keys;
    for (const Contact& contact : reference.m_contacts)
        keys.insert(keyOf(contact));
    for (const bool flipCloth : {false, true})
    {
        StepCase step = original;
        flipWinding(flipCloth ? step.m_cloth : step.m_obstacle);
        const Run flipped = run(step);
        EXPECT_EQ(flipped.m_statistics.m_candidates, reference.m_statistics.m_candidates);
        EXPECT_EQ(flipped.m_statistics.m_intersections, reference.m_statistics.m_intersections);
        EXPECT_NEAR(double(flipped.m_contacts.size()), double(keys.size()), 0.01 * double(keys.size()));
        // Nodes and faces keep their numbers; edges are numbered along their triangles.
        std::size_t others = 0, kept = 0;
        for (const Contact& contact : flipped.m_contacts)
        {
            if (contact.m_kind == DRAPE_EDGE_EDGE) continue;
            keys.count(keyOf(contact)) ? ++kept : ++others;
        }
        EXPECT_GT(kept, 100u);
        EXPECT_LE(others, kept / 100);
    }
}

// Every face three times, in any order of its corners, and fins: no contact comes twice, and the doubled faces add
// none.
TEST_P(MeshRows, Row20NonManifoldAndDuplicateFaces)
{
    const StepCase original = drapedCase("box", 20, 0.03f, 1120);
    SCOPED_TRACE(original.trace());
    StepCase step = original;
    for (TriangleMesh* mesh : {&step.m_cloth, &step.m_obstacle})
    {
        const std::vector<std::int32_t> once = mesh->m_triangles;
        for (std::size_t i = 0; i < once.size(); i += 3)
        {
            mesh->m_triangles.insert(mesh->m_triangles.end(), {once[i + 1], once[i + 2], once[i]});
            mesh->m_triangles.insert(mesh->m_triangles.end(), {once[i + 1], once[i], once[i + 2]});
        }
    }
    const Run doubled = run(step), reference = run(original);
    EXPECT_GT(reference.m_contacts.size(), 200u);
    EXPECT_TRUE(sameBytes(doubled.m_contacts, reference.m_contacts))
        << difference(doubled.m_contacts, reference.m_contacts);

    // A fin on each edge of the box's first triangles: three faces at an edge.
    StepCase finned = original;
    for (std::size_t t = 0; t < 4; ++t)
    {
        const std::int32_t a = finned.m_obstacle.m_triangles[3 * t], b = finned.m_obstacle.m_triangles[3 * t + 1];
        finned.m_obstacle.m_triangles.insert(finned.m_obstacle.m_triangles.end(),
                                             {a, b, std::int32_t(finned.m_obstacle.vertexCount())});
        const float* p = &finned.m_obstacle.m_positions[3 * std::size_t(a)];
        const Positions tip = {p[0] + 0.1f, p[1] + 0.2f, p[2]};
        finned.m_obstacle.m_positions.insert(finned.m_obstacle.m_positions.end(), tip.begin(), tip.end());
    }
    std::set<Key> keys;
    for (const Contact& contact : run(finned).m_contacts)
        EXPECT_TRUE(keys.insert(keyOf(contact)).second) << "twice: " << describe(contact);
    EXPECT_GE(keys.size(), reference.m_contacts.size());
}

// The same pairs whichever mesh is the cloth and however its triangles are numbered. (Device against host, bit for bit,
// is HostDeviceTest's.)
TEST_P(MeshRows, Row23SidesSwappedAndTrianglesShuffled)
{
    for (std::uint32_t seed = 1123; seed < 1127; ++seed)
    {
        StepCase step = soupCase(150, 200, false, seed);
        SCOPED_TRACE(step.trace());
        const Run reference = run(step);
        EXPECT_GT(reference.m_statistics.m_intersections, 30u);
        StepCase swapped = step;
        std::swap(swapped.m_cloth, swapped.m_obstacle);
        swapped.m_end = swapped.m_cloth.m_positions;
        EXPECT_EQ(run(swapped).m_statistics.m_intersections, reference.m_statistics.m_intersections);

        Random random(seed);
        StepCase shuffled = step;
        for (std::size_t i = shuffled.m_cloth.triangleCount(); i > 1; --i)
        {
            const std::size_t j = random.below(std::uint32_t(i));
            if (j == i - 1) continue;
            std::swap_ranges(&shuffled.m_cloth.m_triangles[3 * (i - 1)], &shuffled.m_cloth.m_triangles[3 * (i - 1)] + 3,
                             &shuffled.m_cloth.m_triangles[3 * j]);
        }
        const Run other = run(shuffled);
        EXPECT_EQ(other.m_statistics.m_candidates, reference.m_statistics.m_candidates);
        EXPECT_EQ(other.m_statistics.m_intersections, reference.m_statistics.m_intersections);
        EXPECT_EQ(other.m_contacts.size(), reference.m_contacts.size());
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, MeshRows, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
