// The quick test that two features do not meet in a step is never wrong, and decides most near pairs.
#include "kernels/lib/narrow_phase/feature_meeting.h"

#include <gtest/gtest.h>

#include "tests/support/cases.h"

namespace drape::test
{
namespace
{
constexpr float kReach = 0.02f;  // m

Vec3 place(Random& random, float size)
{
    return vec3(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
}

// Passes edges in the order of ccd.h: the ends of the one, then of the other.
int knownOfEdges(const Vec3* start, const Vec3* end)
{
    const EdgePair pair = edgePair(start, end, kReach, DRAPE_AUTOMATIC, nullptr);
    return edgesNearness(&pair);
}

// Tests a resting vertex and a face.
int knownOfFace(const Vec3* start, const Vec3* end)
{
    const MovingFace face = movingFace(start + 1, end + 1, start[0], end[0], kReach, DRAPE_AUTOMATIC, nullptr);
    const NearestOfFace nearest = nearestOfFace(&face);
    return faceNearness(&face, &nearest);
}

// Rotates the point so that no axis is an edge's or a normal's.
Vec3 turned(Vec3 p)
{
    return vec3((2 * p.x + 2 * p.y - p.z) / 3, (-p.x + 2 * p.y + 2 * p.z) / 3, (2 * p.x - p.y + 2 * p.z) / 3);
}

// Counts each kind of answer.
struct Answers
{
    int m_count[3] = {0, 0, 0};
};

// Features of 0.1 m about each other that move by up to `way`, m; of edges, too, the second one.
Answers answersFor(std::uint32_t kind, float way, Random& random)
{
    Answers answers;
    for (int i = 0; i < 20000; ++i)
    {
        Vec3 start[4], end[4];
        const Vec3 shared = place(random, way);
        for (int k = 0; k < 4; ++k)
        {
            const bool rests = kind == DRAPE_VERTEX_FACE ? k == 0 : k > 1 && i % 2 == 0;
            start[k] = place(random, kind == DRAPE_VERTEX_FACE && k == 0 ? 0.02f : 0.05f);
            end[k] = rests ? start[k] : vec3Add(start[k], vec3Add(shared, place(random, 0.1f * way)));
        }
        const int known = kind == DRAPE_VERTEX_FACE ? knownOfFace(start, end) : knownOfEdges(start, end);
        ++answers.m_count[known];
        const CcdResult result = ccdOfKind(kind, start, end, ccdDefaults());
        EXPECT_TRUE(known == DRAPE_MAY_MEET || !result.m_hit) << "pair " << i << " meets at " << result.m_time;
    }
    return answers;
}
}  // namespace

TEST(FeatureMeeting, AnswersWithoutASearchAreTrue)
{
    for (const std::uint32_t kind : {DRAPE_VERTEX_FACE, DRAPE_EDGES})
        for (const float way : {0.003f, 0.03f, 0.3f})
        {
            Random random(1100);
            SCOPED_TRACE("seed 1100, kind " + std::to_string(kind) + ", way " + std::to_string(way) + " m");
            const Answers answers = answersFor(kind, way, random);
            EXPECT_GT(answers.m_count[DRAPE_STAY_APART], 100);
            EXPECT_GT(answers.m_count[DRAPE_ARE_PARTED], 100);
            EXPECT_GT(answers.m_count[DRAPE_MAY_MEET], 100);
        }
}

// Cloth that slides along a surface without leaving its side needs no search. Cloth that goes through it, or just
// reaches it, does.
TEST(FeatureMeeting, SlidingFeaturesAreParted)
{
    const Vec3 way = vec3(0.005f, 0.0f, 0.003f);
    for (const auto& [above, after, known] :
         {std::tuple(0.001f, 0.001f, DRAPE_ARE_PARTED), std::tuple(0.001f, 0.0005f, DRAPE_ARE_PARTED),
          std::tuple(0.001f, -0.001f, DRAPE_MAY_MEET), std::tuple(0.001f, 0.0f, DRAPE_MAY_MEET)})
    {
        SCOPED_TRACE("from " + std::to_string(above) + " m to " + std::to_string(after) + " m");
        const Vec3 up = vec3(0.0f, above, 0.0f), there = vec3Add(way, vec3(0.0f, after, 0.0f));
        const Vec3 edges[4] = {vec3(-0.05f, 0, 0), vec3(0.05f, 0, 0), vec3(0, 0, -0.05f), vec3(0, 0, 0.05f)};
        const Vec3 face[4] = {vec3(0, 0, 0), vec3(-0.05f, 0, -0.05f), vec3(0.05f, 0, -0.05f), vec3(0, 0, 0.05f)};
        Vec3 edgeStart[4], edgeEnd[4], faceStart[4], faceEnd[4];
        for (int k = 0; k < 4; ++k)
        {
            edgeStart[k] = turned(k < 2 ? vec3Add(edges[k], up) : edges[k]);
            edgeEnd[k] = turned(k < 2 ? vec3Add(edges[k], there) : edges[k]);
            faceStart[k] = turned(k > 0 ? vec3Add(face[k], up) : face[k]);
            faceEnd[k] = turned(k > 0 ? vec3Add(face[k], there) : face[k]);
        }
        EXPECT_EQ(knownOfEdges(edgeStart, edgeEnd), int(known));
        EXPECT_EQ(knownOfFace(faceStart, faceEnd), int(known));
    }
}
}  // namespace drape::test
