// The quick test that two features do not meet in a step is never wrong, and decides most near pairs.
#include "kernels/lib/feature_meeting.h"

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

PairBounds boundsOf(const Vec3* start, const Vec3* end)
{
    float extent = 0.0f;
    for (int i = 0; i < 4; ++i)
        extent = drapeMax(extent, drapeMax(vec3NormMax(start[i]), vec3NormMax(end[i])));
    return {extent, kReach, kReach * 1.001f, DRAPE_AUTOMATIC, nullptr};
}

// Passes edges in the order of ccd.h: the ends of the one, then of the other.
int knownOfEdges(const Vec3* start, const Vec3* end)
{
    const FeatureEdge e0 = {start[0], start[1]}, e1 = {end[0], end[1]}, o0 = {start[2], start[3]},
                      o1 = {end[2], end[3]};
    const auto volume = [](FeatureEdge e, FeatureEdge o)
    { return vec3Dot(vec3Cross(vec3Sub(e.m_b, e.m_a), vec3Sub(o.m_b, o.m_a)), vec3Sub(o.m_a, e.m_a)); };
    const float motion = edgeMotion(e0, e1) + edgeMotion(o0, o1);
    return edgesNearness(e0, e1, o0, o1, motion, volume(e0, o0), volume(e1, o1), boundsOf(start, end));
}

// Tests a resting vertex and a face.
int knownOfFace(const Vec3* start, const Vec3* end)
{
    MovingFace face;
    face.m_start = {{start[1], start[2], start[3]}};
    face.m_end = {{end[1], end[2], end[3]}};
    face.m_areaStart = vec3Cross(vec3Sub(start[2], start[1]), vec3Sub(start[3], start[1]));
    face.m_areaEnd = faceArea(face.m_end);
    const float s0 = vec3Dot(face.m_areaStart, vec3Sub(start[0], start[1]));
    const float s1 = vec3Dot(face.m_areaEnd.m_vector, vec3Sub(start[0], end[1]));
    return faceNearness(&face, start[0], s0, s1, boundsOf(start, end));
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
