#include "benchmarks/error_vs_time/distance_rows.h"

#include <algorithm>
#include <cmath>

#include "benchmarks/error_vs_time/detector_rows.h"
#include "benchmarks/error_vs_time/distance_sets.h"
#include "benchmarks/support/result_hash.h"
#include "kernels/lib/narrow_phase/pair_contact.h"

namespace drape::bench
{
namespace
{
// The answer of a variant for one pair.
struct Answer
{
    float m_distance = 0;  // m
    float m_normal[3] = {};
    std::uint32_t m_found = 0;
};

Vec3 pointOf(const DistancePair& pair, int point)
{
    return vec3Load(pair.m_points, std::uint32_t(point));
}

// Tests two triangles of four vertices each. The vertices are 0 0 0 and 1 2 3 for a vertex and a face,
// and 0 1 1 and 2 3 3 for edges. The first vertex and the first edge are the pair's.
class ContactTest
{
public:
    explicit ContactTest(std::uint32_t mode) : m_mode(mode) {}

    Answer operator()(const DistancePair& pair, float thickness) const
    {
        const bool edges = pair.m_kind == DRAPE_EDGES;
        const Triangle own = {{0, edges ? 1u : 0u, edges ? 1u : 0u}, {0, 0, 0}, 0, 0};
        const Triangle other = {{1, 2, 3}, {0, 0, 0}, 0, 0};
        const Edge edge = {{0, 1}, {1, 1}};
        const NormalCone any = {vec3(0, 0, 0), -1};
        const NormalCone anyOf[4] = {any, any, any, any};
        std::uint32_t searches = 0;
        const ClothView cloth = clothView(pair.m_points, pair.m_points, &own, &edge, 4, 1, m_mode, &searches);
        const ObstacleView obstacle = obstacleView(pair.m_points, &other, anyOf, anyOf);
        Contact contact;
        const int found =
            edges ? pairEdgeEdge(0, &cloth, 0, pointOf(pair, 2), pointOf(pair, 3), any, 0, thickness, &contact)
                  : pairNodeFace(0, &cloth, 0, pointOf(pair, 1), pointOf(pair, 2), pointOf(pair, 3), &obstacle, 0,
                                 thickness, &contact);
        Answer answer;
        if (found != DRAPE_IS_CONTACT) return answer;
        answer.m_found = 1;
        answer.m_distance = contact.m_gap1;
        std::copy_n(contact.m_normal, 3, answer.m_normal);
        return answer;
    }

private:
    std::uint32_t m_mode;
};

Answer plainFloat(const DistancePair& pair, float thickness)
{
    const Vec3 p[4] = {pointOf(pair, 0), pointOf(pair, 1), pointOf(pair, 2), pointOf(pair, 3)};
    Vec3 offset;
    if (pair.m_kind == DRAPE_EDGES)
    {
        float s, t;
        closestOnSegments(p[0], p[1], p[2], p[3], &s, &t);
        offset = vec3Sub(vec3Mix(p[0], p[1], s), vec3Mix(p[2], p[3], t));
    }
    else
        offset = vec3Sub(p[0], trianglePoint(p[1], p[2], p[3], closestOnTriangle(p[0], p[1], p[2], p[3])));
    Answer answer;
    const float square = vec3Dot(offset, offset);
    if (square > thickness * thickness) return answer;
    answer.m_found = 1;
    answer.m_distance = vec3Length(offset);
    const Vec3 normal = vec3Scale(offset, drapeRatio(1.0f, answer.m_distance));
    answer.m_normal[0] = normal.x;
    answer.m_normal[1] = normal.y;
    answer.m_normal[2] = normal.z;
    return answer;
}

Answer inDouble(const DistancePair& pair, float thickness)
{
    Vector3 p[4];
    for (int i = 0; i < 4; ++i)
        p[i] = {pair.m_points[3 * i], pair.m_points[3 * i + 1], pair.m_points[3 * i + 2]};
    const Vector3 offset = pair.m_kind == DRAPE_EDGES ? offsetOfEdges(p) : p[0] - nearestOnTriangle(p[0], p + 1);
    const double distance = length(offset);
    Answer answer;
    if (distance > double(thickness)) return answer;
    answer.m_found = 1;
    answer.m_distance = float(distance);
    for (int axis = 0; axis < 3; ++axis)
        answer.m_normal[axis] = float(offset[axis] / distance);
    return answer;
}

// Degrees between two directions.
double angleBetween(const Vector3& a, const Vector3& b)
{
    return std::atan2(length(cross(a, b)), dot(a, b)) * 180 / 3.14159265358979;
}

// Two-sided contacts name the cloth's side. A pair at distance zero has none.
void addErrors(Row& row, const DistanceSet& set, const std::vector<Answer>& answers)
{
    std::vector<double> distances, normals;
    for (std::size_t i = 0; i < answers.size(); ++i)
    {
        if (!answers[i].m_found) continue;
        const DistancePair& pair = set.m_pairs[i];
        const float* normal = answers[i].m_normal;
        distances.push_back(std::abs(double(answers[i].m_distance) - pair.m_distance) / pair.m_extent);
        normals.push_back(angleBetween({normal[0], normal[1], normal[2]}, pair.m_direction));
    }
    fillErrors(row, "distance_error", std::move(distances));
    fillErrors(row, "normal_error_deg", std::move(normals));
}

template <typename Test>
void addRow(const DistanceSet& set, const std::string& method, const Variant& variant, const Test& test, Table& table)
{
    Row row = detectorRow(set.m_name, method, variant);
    std::vector<Answer> answers(set.m_pairs.size());
    const float thickness = float(set.m_thickness);
    timeQueries(row, answers.size(),
                [&]
                {
                    for (std::size_t i = 0; i < answers.size(); ++i)
                        answers[i] = test(set.m_pairs[i], thickness);
                    return true;
                });
    std::vector<bool> truth, hits;
    for (std::size_t i = 0; i < answers.size(); ++i)
    {
        truth.push_back(set.m_pairs[i].m_distance <= set.m_thickness);
        hits.push_back(answers[i].m_found != 0);
    }
    fillAnswers(row, truth, hits);
    addErrors(row, set, answers);
    row["device"] = "host";
    row["hash"] = hashText(hashOf(answers));
    table.add(row);
}
}  // namespace

void addDistanceRows(std::size_t pairs, Table& table)
{
    for (const DistanceSet& set : makeDistanceSets(pairs))
    {
        addRow(set, "drape_host", {"mode", 0, "discrete"}, ContactTest(DRAPE_DISCRETE), table);
        addRow(set, "drape_host", {"defaults", 0, "automatic"}, ContactTest(DRAPE_AUTOMATIC), table);
        addRow(set, "drape_host", {"mode", 0, "continuous"}, ContactTest(DRAPE_CONTINUOUS), table);
        addRow(set, "plain", {"test", 0, "float"}, plainFloat, table);
        addRow(set, "plain", {"test", 0, "double"}, inDouble, table);
    }
}
}  // namespace drape::bench
