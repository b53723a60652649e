#include "drape/queries.h"

#include <algorithm>
#include <chrono>
#include <tuple>

#include "bullet_plugin/core/exact/triangles.h"
#include "bullet_plugin/core/mesh/check_indices.h"
#include "kernels/lib/triangle_pair.h"
#include "query_device.h"

namespace drape
{
struct Queries::Implementation
{
    DeviceReport m_report;
    Error m_error;
    std::unique_ptr<QueryDevice> m_device;  // null on the host

    bool check(bool good)
    {
        if (!good) m_error = m_device->device().error();
        return good;
    }
};

namespace
{
ExactTriangle triangleOf(const QueryMesh& mesh, std::uint32_t triangle)
{
    float corners[9];
    for (int i = 0; i < 9; ++i)
        corners[i] = mesh.m_start[3 * mesh.m_topology.m_triangles[triangle].m_vertices[i / 3] + i % 3];
    return exactTriangle(corners);
}

std::uint32_t testOnHost(const TriangleQuery& query, std::uint32_t test)
{
    FeatureTriangle a, b;
    for (std::uint32_t i = 0; i < 3; ++i)
    {
        a.m_p[i] = vec3Load(query.m_a, i);
        b.m_p[i] = vec3Load(query.m_b, i);
    }
    return triangleQuery(a, b, test);
}

void pairsOnHost(QueryMesh& a, QueryMesh& b, float radius, std::uint64_t& candidates, std::vector<PairAnswer>& answers)
{
    const bool self = &a == &b;
    a.refit(self ? 0.5f * radius : radius);
    if (!self) b.refit(0.0f);
    const auto visit = [&](const Candidate& pair)
    {
        ++candidates;
        const PairAnswer answer = trianglePairAnswer(pair, a.m_start, a.m_topology.m_triangles.data(), b.m_start,
                                                     b.m_topology.m_triangles.data(), radius);
        if (answer.m_bits != 0) answers.push_back(answer);
    };
    leafPairsOnHost(a.tree(), b.tree(), self ? DRAPE_WALK_SELF_APART : DRAPE_WALK_OTHER, visit);
}

void sortPairs(std::vector<NearTriangles>& pairs)
{
    std::sort(pairs.begin(), pairs.end(),
              [](const NearTriangles& a, const NearTriangles& b)
              { return std::tie(a.m_a, a.m_b) < std::tie(b.m_a, b.m_b); });
}

// The truth about the pairs that the certified tests could not deny.
void decide(const QueryMesh& a, const QueryMesh& b, double radius, const std::vector<PairAnswer>& answers,
            MeshPairs& found)
{
    const bool self = &a == &b;
    for (const PairAnswer& answer : answers)
    {
        const ExactTriangle first = triangleOf(a, answer.m_a), second = triangleOf(b, answer.m_b);
        NearTriangles pair = {a.m_topology.m_sourceTriangle[answer.m_a], b.m_topology.m_sourceTriangle[answer.m_b]};
        if (self && pair.m_a > pair.m_b) std::swap(pair.m_a, pair.m_b);
        const bool meet = (answer.m_bits & DRAPE_PAIR_MEETS) && trianglesMeet(first, second);
        if (meet) found.m_intersecting.push_back(pair);
        if (meet || squaredDistance(first, second) <= radius * radius) found.m_within.push_back(pair);
    }
    sortPairs(found.m_within);
    sortPairs(found.m_intersecting);
}
}  // namespace

CcdSettings defaultCcdSettings()
{
    return ccdDefaults();
}

Queries::Queries() : m_implementation(new Implementation) {}
Queries::~Queries() = default;

std::unique_ptr<Queries> Queries::create(const Settings& settings, Error& error)
{
    const auto start = std::chrono::steady_clock::now();
    error = Error();
    const DeviceChoice choice = chooseDevice(settings, error);
    if (error.failed()) return nullptr;
    std::unique_ptr<Queries> queries(new Queries);
    Implementation& self = *queries->m_implementation;
    self.m_report.m_reason = choice.m_reason;
    self.m_report.m_device.m_name = "host";
    if (choice.m_onHost) return queries;
    std::unique_ptr<Device> device = Device::open(choice.m_index, error);
    if (!device) return nullptr;
    self.m_report.m_device = device->info();
    self.m_report.m_onHost = false;
    self.m_device.reset(new QueryDevice(std::move(device), settings));
    error = self.m_device->device().error();
    if (error.failed()) return nullptr;
    self.m_report.m_fromCache = self.m_device->fromCache();
    self.m_report.m_buildMs =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    return queries;
}

const DeviceReport& Queries::deviceReport() const
{
    return m_implementation->m_report;
}

const Error& Queries::error() const
{
    return m_implementation->m_error;
}

bool Queries::motions(const CcdQuery* queries, std::size_t count, const CcdSettings& settings, CcdResult* results)
{
    Implementation& self = *m_implementation;
    if (self.m_device) return self.check(self.m_device->motions(queries, count, settings, results));
    for (std::size_t i = 0; i < count; ++i)
    {
        Vec3 start[4], end[4];
        for (std::uint32_t p = 0; p < 4; ++p)
        {
            start[p] = vec3Load(queries[i].m_start, p);
            end[p] = vec3Load(queries[i].m_end, p);
        }
        results[i] = ccdOfKind(queries[i].m_kind, start, end, settings);
    }
    return true;
}

bool Queries::triangles(const TriangleQuery* queries, std::size_t count, TriangleTest test, std::uint32_t* results)
{
    Implementation& self = *m_implementation;
    const std::uint32_t fast = test == TriangleTest::Moller ? DRAPE_TEST_MOLLER : DRAPE_TEST_CERTIFIED;
    if (self.m_device && !self.check(self.m_device->triangles(queries, count, fast, results))) return false;
    for (std::size_t i = 0; i < count; ++i)
    {
        if (!self.m_device) results[i] = testOnHost(queries[i], fast);
        if (test == TriangleTest::Exact && results[i] != 0)
            results[i] = trianglesMeet(exactTriangle(queries[i].m_a), exactTriangle(queries[i].m_b));
    }
    return true;
}

bool Queries::meshPairs(const MeshDescription& a, const MeshDescription* b, float radius, MeshPairs& found)
{
    Implementation& self = *m_implementation;
    found = MeshPairs();
    if (!checkIndices(a, "meshPairs", self.m_error)) return false;
    if (b && !checkIndices(*b, "meshPairs", self.m_error)) return false;
    QueryMesh first = makeQueryMesh(a, a.m_positions), other;
    if (b) other = makeQueryMesh(*b, b->m_positions);
    QueryMesh& second = b ? other : first;
    std::vector<PairAnswer> answers;
    if (!self.m_device)
        pairsOnHost(first, second, radius, found.m_candidates, answers);
    else if (!self.check(self.m_device->meshPairs(first, second, radius, found.m_candidates, answers)))
        return false;
    decide(first, second, double(radius), answers, found);
    return true;
}

bool Queries::meshMotion(const MeshDescription& description, const float* end, const CcdSettings& settings,
                         MeshMotion& found)
{
    Implementation& self = *m_implementation;
    found = MeshMotion();
    if (!checkIndices(description, "meshMotion", self.m_error)) return false;
    QueryMesh mesh = makeQueryMesh(description, end);
    SelfCollisions collisions;
    if (!self.m_device)
    {
        mesh.refit(selfRadius(settings));
        const HostMotion motion = {mesh.tree(), mesh.m_topology.m_edges, mesh.m_start, mesh.m_end,
                                   description.m_vertexCount};
        selfCollideOnHost(motion, settings, collisions);
    }
    else if (!self.check(self.m_device->meshMotion(mesh, settings, collisions)))
        return false;
    sortHits(collisions.m_hits);
    found.m_trianglePairs = collisions.m_trianglePairs;
    found.m_vertexFaceCandidates = collisions.m_vertexFaceCandidates;
    found.m_edgeCandidates = collisions.m_edgeCandidates;
    for (const FeatureHit& hit : collisions.m_hits)
    {
        TouchingFeatures touching = {hit.m_kind, {}, hit.m_time};
        featurePairVertices(hit.m_kind, FeaturePair{hit.m_a, hit.m_b}, mesh.m_topology.m_triangles.data(),
                            mesh.m_topology.m_edges.data(), touching.m_vertices);
        found.m_touching.push_back(touching);
    }
    return true;
}
}  // namespace drape
