// Rows of the stress table that are about whole meshes: scale and place, winding, what is no surface, the order of
// things. tests/README.md has the table.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <iterator>
#include <numeric>
#include <tuple>

#include "scenes/shapes.h"
#include "tests/support/backends.h"
#include "tests/support/contact_oracle.h"
#include "tests/support/mesh_pairs.h"
#include "tests/support/oracle.h"
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

// A contact with the vertices that name it.
struct Keyed
{
    FeatureKey m_key;
    Contact m_contact;
};

void sortByKey(std::vector<Keyed>& contacts)
{
    std::sort(contacts.begin(), contacts.end(), [](const Keyed& a, const Keyed& b) { return a.m_key < b.m_key; });
}

void exchangeSides(FeatureKey& key)
{
    if (key[0] != DRAPE_EDGE_EDGE) key[0] = key[0] == DRAPE_NODE_FACE ? DRAPE_FACE_VERTEX : DRAPE_NODE_FACE;
    std::swap_ranges(&key[1], &key[1] + 3, &key[4]);
}

// Returns true if the contacts are between the same features. Reports contacts that are in one list only.
bool expectSameKeys(const std::vector<Keyed>& found, const std::vector<Keyed>& wanted)
{
    const auto less = [](const Keyed& a, const Keyed& b) { return a.m_key < b.m_key; };
    std::vector<Keyed> extra, missing;
    std::set_difference(found.begin(), found.end(), wanted.begin(), wanted.end(), std::back_inserter(extra), less);
    std::set_difference(wanted.begin(), wanted.end(), found.begin(), found.end(), std::back_inserter(missing), less);
    for (const Keyed& keyed : extra)
        ADD_FAILURE() << "not wanted: " << describe(keyed.m_contact);
    for (const Keyed& keyed : missing)
        ADD_FAILURE() << "missing: " << describe(keyed.m_contact);
    return extra.empty() && missing.empty() && found.size() == wanted.size();
}

// Triangles and edges have other numbers; nothing else differs by a bit.
void expectSameButForNumbers(const std::vector<Keyed>& found, const std::vector<Keyed>& wanted)
{
    ASSERT_TRUE(expectSameKeys(found, wanted));
    for (std::size_t i = 0; i < found.size(); ++i)
    {
        Contact contact = found[i].m_contact;
        const Contact& other = wanted[i].m_contact;
        contact.m_featureIndex = other.m_featureIndex;
        contact.m_clothFeature = other.m_clothFeature;
        contact.m_obstacleFeature = other.m_obstacleFeature;
        EXPECT_EQ(std::memcmp(&contact, &other, sizeof contact), 0) << describe(contact) << '\n' << describe(other);
    }
}

// Returns the nodes that are nearest to a vertex of a face, and nearer than the thickness: by brute force, sorted.
std::vector<FeatureKey> nodesNearVertices(const StepCase& step)
{
    std::vector<FeatureKey> keys;
    for (std::uint32_t node = 0; node < step.m_cloth.vertexCount(); ++node)
    {
        for (std::size_t t = 0; t < step.m_obstacle.triangleCount(); ++t)
        {
            const std::int32_t* corners = &step.m_obstacle.m_triangles[3 * t];
            Vector3 face[3];
            FeatureKey key = {DRAPE_NODE_FACE, node, ~0u, ~0u, 0, 0, 0};
            for (std::size_t i = 0; i < 3; ++i)
            {
                key[4 + i] = std::uint32_t(corners[i]);
                face[i] = position(step.m_obstacle.m_positions, key[4 + i]);
            }
            const NearestOnTriangle nearest = nearestOnTriangle(position(step.m_cloth.m_positions, node), face);
            if (nearest.m_distance > double(step.m_thickness)) continue;
            if (std::count(nearest.m_weights, nearest.m_weights + 3, 0.0) != 2) continue;
            std::sort(key.begin() + 4, key.end());
            keys.push_back(key);
        }
    }
    std::sort(keys.begin(), keys.end());
    return keys;
}

// Takes out those contacts, which must be all that there are. What is nearest to a node is that node's contact, so that
// they are other ones when cloth and obstacle change places.
void takeNodesNearVertices(std::vector<Keyed>& contacts, const StepCase& step)
{
    const std::vector<FeatureKey> near = nodesNearVertices(step);
    const auto isNear = [&](const Keyed& keyed) { return std::binary_search(near.begin(), near.end(), keyed.m_key); };
    const auto taken = std::remove_if(contacts.begin(), contacts.end(), isNear);
    EXPECT_EQ(std::size_t(contacts.end() - taken), near.size());
    contacts.erase(taken, contacts.end());
}

// Expects equal contacts with cloth and obstacle exchanged. The local frame has its origin at the other feature, so
// gaps differ by rounding.
void expectExchanged(std::vector<Keyed> found, const StepCase& swapped, std::vector<Keyed> wanted, const StepCase& step)
{
    takeNodesNearVertices(found, swapped);
    takeNodesNearVertices(wanted, step);
    EXPECT_GT(wanted.size(), 200u);
    for (Keyed& keyed : found)
        exchangeSides(keyed.m_key);
    sortByKey(found);
    ASSERT_TRUE(expectSameKeys(found, wanted));
    for (std::size_t i = 0; i < found.size(); ++i)
    {
        const Contact &a = found[i].m_contact, &b = wanted[i].m_contact;
        EXPECT_NEAR(a.m_gap1, b.m_gap1, 1e-6f) << describe(a) << '\n' << describe(b);
    }
}

using Rename = std::function<NearTriangles(const NearTriangles&)>;

void expectSameList(std::vector<NearTriangles> found, const std::vector<NearTriangles>& wanted, const Rename& rename)
{
    std::transform(found.begin(), found.end(), found.begin(), rename);
    std::sort(found.begin(), found.end(),
              [](const NearTriangles& a, const NearTriangles& b)
              { return std::tie(a.m_a, a.m_b) < std::tie(b.m_a, b.m_b); });
    EXPECT_TRUE(sameBytes(found, wanted)) << found.size() << " and " << wanted.size() << " pairs";
}

void expectSamePairs(const MeshPairs& found, const MeshPairs& wanted, const Rename& rename)
{
    EXPECT_EQ(found.m_candidates, wanted.m_candidates);
    expectSameList(found.m_within, wanted.m_within, rename);
    expectSameList(found.m_intersecting, wanted.m_intersecting, rename);
}

// Returns each triangle's number before.
std::vector<std::uint32_t> shuffleTriangles(TriangleMesh& mesh, std::uint32_t seed)
{
    Random random(seed);
    std::vector<std::uint32_t> original(mesh.triangleCount());
    std::iota(original.begin(), original.end(), 0u);
    for (std::size_t i = original.size(); i > 1; --i)
        std::swap(original[i - 1], original[random.below(std::uint32_t(i))]);
    const std::vector<std::int32_t> before = mesh.m_triangles;
    for (std::size_t i = 0; i < original.size(); ++i)
        std::copy_n(&before[3 * original[i]], 3, &mesh.m_triangles[3 * i]);
    return original;
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
        settings.m_activation = 0;  // contacts within the thickness
        const std::unique_ptr<Pipeline> pipeline = makePipeline(settings);
        if (!pipeline) return {};
        Run result = {runCase(*pipeline, step), {}};
        result.m_statistics = pipeline->statistics();
        expectFinite(result.m_contacts);
        return result;
    }

    // Returns the contacts sorted by their features.
    std::vector<Keyed> keyedContacts(const StepCase& step)
    {
        const Side cloth = makeSide({step.m_cloth}), obstacle = makeSide({step.m_obstacle});
        std::vector<Keyed> keyed;
        for (const Contact& contact : run(step).m_contacts)
            keyed.push_back({featureKey(contact, cloth, obstacle), contact});
        sortByKey(keyed);
        return keyed;
    }

    // Returns the pairs of the triangles at the step's start.
    MeshPairs pairsOf(const StepCase& step)
    {
        return meshPairsOn(GetParam().m_settings, step.m_cloth, step.m_obstacle, step.m_thickness);
    }

    // Expects every pair within the thickness and none beyond it, in the rounded numbers.
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
            // The certified distance keeps pairs unnecessarily up to 6.6e-5 of the extent (bound 4).
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

// Winding turns normals over and changes no distance: the same pairs of triangles, and the same contacts.
TEST_P(MeshRows, Row13FlippedWindingAndInvertedElements)
{
    StepCase original = fallingCase("torus", 16, 0.03f, 1113);
    SCOPED_TRACE(original.trace());
    // Every fifth node moves to the other side of its neighbours in the step: faces turn over.
    for (std::size_t node = 0; node < original.m_cloth.vertexCount(); node += 5)
        original.m_end[3 * node] += node % 2 ? 0.16f : -0.16f;
    StepCase ended = original;
    ended.m_cloth.m_positions = original.m_end;
    const std::vector<Keyed> contacts = keyedContacts(original);
    const MeshPairs start = pairsOf(original), end = pairsOf(ended);
    EXPECT_GT(start.m_intersecting.size(), 20u);
    EXPECT_TRUE(sameBytes(start.m_intersecting, meetingPairs(original.m_cloth, original.m_obstacle)));
    EXPECT_TRUE(sameBytes(end.m_intersecting, meetingPairs(ended.m_cloth, ended.m_obstacle)));
    const Rename same = [](const NearTriangles& pair) { return pair; };
    for (const bool flipCloth : {false, true})
    {
        StepCase step = original, stepEnded = ended;
        flipWinding(flipCloth ? step.m_cloth : step.m_obstacle);
        flipWinding(flipCloth ? stepEnded.m_cloth : stepEnded.m_obstacle);
        expectSamePairs(pairsOf(step), start, same);
        expectSamePairs(pairsOf(stepEnded), end, same);
        EXPECT_TRUE(expectSameKeys(keyedContacts(step), contacts));
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
    const std::vector<Keyed> keyed = keyedContacts(finned);
    for (std::size_t i = 1; i < keyed.size(); ++i)
        EXPECT_NE(keyed[i].m_key, keyed[i - 1].m_key) << "twice: " << describe(keyed[i].m_contact);
    EXPECT_GE(keyed.size(), reference.m_contacts.size());
}

// Pairs and contacts do not depend on which mesh is the cloth or on the numbering of its triangles. (HostDeviceTest
// compares device and host, bit for bit.)
TEST_P(MeshRows, Row23SidesSwappedAndTrianglesShuffled)
{
    std::size_t nearVertices = 0;
    for (std::uint32_t seed = 1123; seed < 1127; ++seed)
    {
        const StepCase step = soupCase(150, 200, false, seed);
        SCOPED_TRACE(step.trace());
        const std::vector<Keyed> reference = keyedContacts(step);
        EXPECT_GT(reference.size(), 200u);
        const MeshPairs pairs = pairsOf(step);
        EXPECT_GT(pairs.m_intersecting.size(), 30u);
        EXPECT_TRUE(sameBytes(pairs.m_intersecting, meetingPairs(step.m_cloth, step.m_obstacle)));

        StepCase swapped = step;
        std::swap(swapped.m_cloth, swapped.m_obstacle);
        swapped.m_end = swapped.m_cloth.m_positions;
        expectSamePairs(pairsOf(swapped), pairs,
                        [](const NearTriangles& pair) {
                            return NearTriangles{pair.m_b, pair.m_a};
                        });
        nearVertices += nodesNearVertices(step).size() + nodesNearVertices(swapped).size();
        expectExchanged(keyedContacts(swapped), swapped, reference, step);

        StepCase shuffled = step;
        const std::vector<std::uint32_t> original = shuffleTriangles(shuffled.m_cloth, seed);
        expectSamePairs(pairsOf(shuffled), pairs,
                        [&](const NearTriangles& pair) {
                            return NearTriangles{original[pair.m_a], pair.m_b};
                        });
        expectSameButForNumbers(keyedContacts(shuffled), reference);
    }
    EXPECT_GT(nearVertices, 10u);
}

INSTANTIATE_TEST_SUITE_P(Backends, MeshRows, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
