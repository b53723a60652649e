// Compares contacts of a cloth with itself with all of its pairs of features, in double precision. Features that are
// near at the step's end or passed through one another must be reported, and no others.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <tuple>

#include "kernels/lib/narrow_phase/feature_meeting.h"
#include "scenes/describe_mesh.h"
#include "scenes/mesh_loader.h"
#include "tests/support/backends.h"
#include "tests/support/contact_oracle.h"
#include "tests/support/oracle.h"
#include "tests/support/published_data.h"
#include "tests/support/self_cases.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
// A crossing has this distance from the features' borders, in weights; rounding moves them by about 1e-6.
constexpr double kCrossMargin = 1e-3;

// Positions of a pair's four nodes: a node and a face's, or those of two edges.
struct Four
{
    Vector3 m_p[4];
};

double volume(const Four& four, bool edges)
{
    const Vector3* p = four.m_p;
    return edges ? dot(cross(p[1] - p[0], p[3] - p[2]), p[2] - p[0])
                 : dot(cross(p[2] - p[1], p[3] - p[1]), p[0] - p[1]);
}

Four between(const Four& a, const Four& b, double t)
{
    Four mixed;
    for (int i = 0; i < 4; ++i)
        mixed.m_p[i] = a.m_p[i] + t * (b.m_p[i] - a.m_p[i]);
    return mixed;
}

double extent(const Four& four)
{
    double largest = 0;
    for (const Vector3& p : four.m_p)
        largest = std::max(largest, length(p - four.m_p[0]));
    return largest;
}

struct Nearest
{
    double m_distance;
    double m_weights[3];  // weights of the face, or positions along the edges
    Vector3 m_offset;     // from the second feature to the first
};

Nearest nearest(const Four& four, bool edges)
{
    const Vector3* p = four.m_p;
    if (edges)
    {
        const NearestOnSegments on = nearestOnSegments(p[0], p[1], p[2], p[3]);
        return {on.m_distance, {on.m_first, on.m_second, 0}, on.m_firstPoint - on.m_secondPoint};
    }
    const NearestOnTriangle on = nearestOnTriangle(p[0], p + 1);
    return {on.m_distance, {on.m_weights[0], on.m_weights[1], on.m_weights[2]}, p[0] - on.m_point};
}

// Returns true if positions are well-conditioned, by the sine of the angle between the edges, or that of a fat face.
bool isConditioned(const Four& four, bool edges)
{
    const Vector3 u = edges ? four.m_p[1] - four.m_p[0] : four.m_p[2] - four.m_p[1];
    const Vector3 v = edges ? four.m_p[3] - four.m_p[2] : four.m_p[3] - four.m_p[1];
    const double longest = edges ? length(u) * length(v) : std::pow(std::max({length(u), length(v), length(u - v)}), 2);
    return length(cross(u, v)) > kSineMargin * longest;
}

bool insideMargins(const Nearest& at, bool edges, double margin)
{
    for (int i = 0; i < (edges ? 2 : 3); ++i)
        if (at.m_weights[i] < margin || at.m_weights[i] > 1 - margin) return false;
    return true;
}

class Oracle
{
public:
    Oracle(const SelfStepCase& step, double activation) : m_step(step), m_activation(activation)
    {
        TriangleMesh mesh = step.m_motion.m_mesh;
        m_side = makeSide({mesh});
        m_side.m_end = step.m_motion.m_end;
    }

    const Side& side() const { return m_side; }

    void nodesOf(bool edges, std::uint32_t a, std::uint32_t b, std::uint32_t nodes[4]) const
    {
        const std::uint32_t* second =
            edges ? m_side.m_pool.edges()[b].m_vertices : m_side.m_pool.triangles()[b].m_vertices;
        nodes[0] = a;
        if (edges) std::copy_n(m_side.m_pool.edges()[a].m_vertices, 2, nodes);
        std::copy_n(second, edges ? 2 : 3, nodes + (edges ? 2 : 1));
    }
    Four at(const std::vector<float>& positions, const std::uint32_t nodes[4]) const
    {
        Four four;
        for (int i = 0; i < 4; ++i)
            four.m_p[i] = position(positions, nodes[i]);
        return four;
    }
    double reach(const std::uint32_t nodes[4], bool edges) const
    {
        const double rest = nearest(at(m_step.m_rest, nodes), edges).m_distance;
        return std::min(double(m_step.m_thickness), 0.5 * rest) * (1 + m_activation);
    }

    // Returns true if the pair is near at the end, locally closest and not passed, each within the margins.
    bool mustBeNear(const std::uint32_t nodes[4], bool edges, std::uint32_t face) const
    {
        const Four start = at(m_side.m_start, nodes), end = at(m_side.m_end, nodes);
        const Nearest near = nearest(end, edges);
        const double size = std::max(extent(start), extent(end));
        if (near.m_distance > reach(nodes, edges) * (1 - kReachMargin) || near.m_distance < kTouchMargin * size)
            return false;
        if (!isConditioned(end, edges) || !(volume(start, edges) * volume(end, edges) > 0)) return false;
        if (edges) return insideMargins(near, true, kWeightMargin);
        for (int i = 0; i < 3; ++i)
        {
            if (near.m_weights[i] > 0 && near.m_weights[i] < kWeightMargin) return false;
            if (near.m_weights[i] > 0) continue;
            const std::uint32_t edge = m_side.m_pool.triangles()[face].m_edges[(i + 1) % 3];
            for (std::uint32_t beyond : m_side.m_pool.edges()[edge].m_opposite)
            {
                const Vector3 point = end.m_p[0] - near.m_offset;
                if (dot(near.m_offset, position(m_side.m_end, beyond) - point) > 0) return false;
            }
        }
        return true;
    }

    // Returns true if the two crossed one another within the margins, at a time when their volume changed its sign.
    bool mustMeet(const std::uint32_t nodes[4], bool edges) const
    {
        constexpr int kSamples = 16;
        const Four start = at(m_side.m_start, nodes), end = at(m_side.m_end, nodes);
        // Features that touch at rest are joined.
        if (!(reach(nodes, edges) > 1e-6)) return false;
        double low = 0, before = volume(start, edges);
        for (int i = 1; i <= kSamples; ++i)
        {
            double high = double(i) / kSamples;
            const double after = volume(between(start, end, high), edges);
            if (before * after < 0)
            {
                double from = low, to = high;
                for (int k = 0; k < 60; ++k)
                {
                    const double middle = 0.5 * (from + to);
                    (volume(between(start, end, middle), edges) * before > 0 ? from : to) = middle;
                }
                const Four met = between(start, end, from);
                if (from > kCrossMargin && from < 1 - kCrossMargin && isConditioned(met, edges) &&
                    insideMargins(nearest(met, edges), edges, kCrossMargin))
                    return true;
            }
            low = high;
            before = after;
        }
        return false;
    }

private:
    const SelfStepCase& m_step;
    double m_activation;
    Side m_side;
};

using Key = std::tuple<bool, std::uint32_t, std::uint32_t>;  // edges, first and second feature

struct Checked
{
    std::size_t m_near = 0, m_met = 0, m_reported = 0;
};

// Expects every required contact. `kept`: only these nodes' pairs, or all.
void expectRequired(const Oracle& oracle, const std::map<Key, Contact>& found, ContactMode mode, Checked& checked)
{
    const MeshPool& pool = oracle.side().m_pool;
    const auto check = [&](bool edges, std::uint32_t a, std::uint32_t b)
    {
        std::uint32_t nodes[4];
        oracle.nodesOf(edges, a, b, nodes);
        for (int i = edges ? 2 : 1; i < 4; ++i)
            if (nodes[i] == nodes[0] || (edges && nodes[i] == nodes[1])) return;
        for (std::uint32_t node : nodes)
            for (const std::vector<float>* positions : {&oracle.side().m_start, &oracle.side().m_end})
                if (!positionIsValid(vec3Load(positions->data(), node))) return;
        const bool met = mode != ContactMode::Discrete && oracle.mustMeet(nodes, edges);
        const bool near = oracle.mustBeNear(nodes, edges, b);
        if (!met && !near) return;
        ++(met ? checked.m_met : checked.m_near);
        EXPECT_TRUE(found.count({edges, a, b}))
            << (edges ? "edges " : "node and face ") << a << " and " << b << (met ? " met" : " are near");
    };
    for (std::uint32_t node = 0; node < pool.vertexCount(); ++node)
        for (std::uint32_t face = 0; face < pool.triangles().size(); ++face)
            check(false, node, face);
    for (std::uint32_t first = 0; first < pool.edges().size(); ++first)
        for (std::uint32_t second = first + 1; second < pool.edges().size(); ++second)
            check(true, first, second);
}

// Expects the contact to be near at the end, or to touch at the time that it gives.
void expectTrue(const Oracle& oracle, const Contact& contact)
{
    const bool edges = contact.m_kind == DRAPE_SELF_EDGE_EDGE;
    std::uint32_t nodes[4];
    oracle.nodesOf(edges, contact.m_clothFeature, contact.m_obstacleFeature, nodes);
    const Four start = oracle.at(oracle.side().m_start, nodes), end = oracle.at(oracle.side().m_end, nodes);
    const double size = std::max(extent(start), extent(end));
    double motion = 0;
    for (int i = 1; i < 4; ++i)
        motion = std::max(motion, length((end.m_p[i] - start.m_p[i]) - (end.m_p[0] - start.m_p[0])));
    const double reach = oracle.reach(nodes, edges);
    const Vector3 normal = {contact.m_normal[0], contact.m_normal[1], contact.m_normal[2]};
    EXPECT_NEAR(length(normal), 1, 1e-5);
    EXPECT_GT(reach, 0);
    const double last = nearest(end, edges).m_distance;
    if (last <= reach * (1 + kReachMargin) + kTouchMargin * size) return;
    EXPECT_LE(nearest(between(start, end, contact.m_time), edges).m_distance,
              2 * DRAPE_MEETING_TIME * 2 * motion + kTouchMargin * size)
        << describe(contact);
    EXPECT_LE(contact.m_gap1, contact.m_gap0 + 1e-5 * size) << describe(contact);
}
}  // namespace

class SelfStepOracle : public BackendTest
{
};

TEST_P(SelfStepOracle, ReportsWhatIsNearAndWhatMetAndNothingElse)
{
    Checked all;
    for (const ContactMode mode : {ContactMode::Automatic, ContactMode::Discrete})
    {
        Settings settings = GetParam().m_settings;
        settings.m_mode = mode;
        for (const SelfStepCase& step : selfStepCases())
        {
            if (step.m_motion.m_mesh.m_triangles.empty()) continue;
            SCOPED_TRACE(step.m_motion.m_name + ", mode " + std::to_string(int(mode)));
            const std::unique_ptr<Pipeline> pipeline = makePipeline(settings);
            ASSERT_TRUE(pipeline);
            const Oracle oracle(step, settings.m_activation);
            std::map<Key, Contact> found;
            for (const Contact& contact : runSelfCase(*pipeline, step))
            {
                const bool edges = contact.m_kind == DRAPE_SELF_EDGE_EDGE;
                EXPECT_TRUE(found.insert({{edges, contact.m_clothFeature, contact.m_obstacleFeature}, contact}).second);
                expectTrue(oracle, contact);
            }
            all.m_reported += found.size();
            Checked checked;
            expectRequired(oracle, found, mode, checked);
            all.m_near += checked.m_near;
            all.m_met += checked.m_met;
        }
    }
    EXPECT_GT(all.m_near, 3000u);
    EXPECT_GT(all.m_met, 3000u);
    EXPECT_LT(all.m_reported, 3 * (all.m_near + all.m_met)) << "the oracle asks for much of what is reported";
}

// Checks every pair of a published step (46,598 nodes) that the certified test finds to touch and that crossed within
// the margins.
TEST_P(SelfStepOracle, PublishedClothBallStep)
{
    SelfStepCase step;
    std::string first, second, error;
    if (!findTruth("cloth_ball92.ply", first) || !findTruth("cloth_ball93.ply", second)) return;
    ASSERT_TRUE(loadMotion(first, second, step.m_motion.m_mesh, step.m_motion.m_end, error)) << error;
    step.m_rest = step.m_motion.m_mesh.m_positions;
    step.m_thickness = 0.001f;
    const std::unique_ptr<Queries> queries = makeQueries(GetParam().m_settings);
    const std::unique_ptr<Pipeline> pipeline = makePipeline(GetParam().m_settings);
    ASSERT_TRUE(queries && pipeline);
    MeshMotion touching;
    CcdSettings settings = defaultCcdSettings();
    settings.m_timeTolerance = 1;
    ASSERT_TRUE(
        queries->meshMotion(describeMesh(step.m_motion.m_mesh), step.m_motion.m_end.data(), settings, touching));
    const Oracle oracle(step, GetParam().m_settings.m_activation);
    // The key is the kind and the nodes. Nodes of each feature are sorted; of two edges the lesser is first.
    const auto keyOf = [](bool edges, const std::uint32_t nodes[4])
    {
        std::array<std::uint32_t, 5> key = {edges, nodes[0], nodes[1], nodes[2], nodes[3]};
        std::sort(key.begin() + (edges ? 1 : 2), key.begin() + (edges ? 3 : 5));
        if (edges) std::sort(key.begin() + 3, key.end());
        if (edges && std::lexicographical_compare(key.begin() + 3, key.end(), key.begin() + 1, key.begin() + 3))
            std::swap_ranges(key.begin() + 1, key.begin() + 3, key.begin() + 3);
        return key;
    };
    std::set<std::array<std::uint32_t, 5>> found;
    for (const Contact& contact : runSelfCase(*pipeline, step))
    {
        const bool edges = contact.m_kind == DRAPE_SELF_EDGE_EDGE;
        std::uint32_t nodes[4];
        oracle.nodesOf(edges, contact.m_clothFeature, contact.m_obstacleFeature, nodes);
        found.insert(keyOf(edges, nodes));
    }
    std::size_t expected[2] = {0, 0}, missing = 0;
    for (const TouchingFeatures& pair : touching.m_touching)
    {
        const bool edges = pair.m_kind == DRAPE_EDGES;
        if (!oracle.mustMeet(pair.m_vertices, edges)) continue;
        ++expected[edges];
        missing += found.count(keyOf(edges, pair.m_vertices)) == 0;
    }
    EXPECT_EQ(missing, 0u) << "of " << expected[0] << " nodes and faces and " << expected[1] << " pairs of edges";
    EXPECT_GT(expected[0], 1000u);
    EXPECT_GT(expected[1], 5000u);
}

INSTANTIATE_TEST_SUITE_P(Backends, SelfStepOracle, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
