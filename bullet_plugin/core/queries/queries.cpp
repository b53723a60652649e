#include "drape/queries.h"

#include <algorithm>
#include <cmath>

#include "bullet_plugin/core/device/device_choice.h"
#include "bullet_plugin/core/exact/triangles.h"
#include "bullet_plugin/core/scene/check_indices.h"
#include "bullet_plugin/core/check_settings.h"
#include "bullet_plugin/core/backends/step_limits.h"
#include "bullet_plugin/core/public_call.h"
#include "bullet_plugin/core/queries/leaf_pair_count.h"
#include "bullet_plugin/core/stopwatch.h"
#include "kernels/lib/queries/triangle_pair.h"
#include "query_device.h"

namespace drape
{
struct Queries::Implementation
{
    explicit Implementation(const Settings& settings) : m_limits(settings) {}

    StepLimits m_limits;
    DeviceReport m_report;
    Error m_error;
    std::unique_ptr<QueryDevice> m_device;  // null on the host

    static std::unique_ptr<Queries> make(const Settings& settings, Error& error);
    bool motions(const CcdQuery* queries, std::size_t count, const CcdSettings& settings, CcdResult* results);
    bool triangles(const TriangleQuery* queries, std::size_t count, TriangleTest test, std::uint32_t* results);
    bool meshPairs(const MeshDescription& a, const MeshDescription* b, float radius, MeshPairs& found);
    bool meshMotion(const MeshDescription& description, const float* end, const CcdSettings& settings,
                    MeshMotion& found);

    // Returns the result of a public function's work; false, with the error filled, if it throws.
    template <class Work>
    bool answer(const char* call, const Work& work)
    {
        return guarded(work,
                       [&](const CaughtException& caught)
                       {
                           setError(m_error, call, caught);
                           return false;
                       });
    }

    bool check(bool good)
    {
        if (!good) m_error = m_device->error();
        return good;
    }
    // Returns whether a caller's input is usable; otherwise the error names the call and the problem.
    bool require(bool good, const char* call, const std::string& wrong)
    {
        if (good) return true;
        m_error = Error();
        m_error.m_kind = ErrorKind::Input;
        m_error.m_call = std::string(call) + ": " + wrong;
        return false;
    }
    bool requireSettings(const CcdSettings& settings, const char* call)
    {
        const auto isLength = [](float value) { return std::isfinite(value) && value >= 0.0f; };
        return require(
            isLength(settings.m_separation) && isLength(settings.m_tolerance) && isLength(settings.m_timeTolerance),
            call, "CcdSettings with a length or tolerance that is negative or not finite");
    }
};

namespace
{
std::uint32_t testOnHost(const TriangleQuery& query)
{
    FeatureTriangle a, b;
    for (std::uint32_t i = 0; i < 3; ++i)
    {
        a.m_p[i] = vec3Load(query.m_a, i);
        b.m_p[i] = vec3Load(query.m_b, i);
    }
    return trianglePairTest(a.m_p, b.m_p, -1.0f) & DRAPE_PAIR_MEETS;
}

// Returns false if there are more pairs than may be tested; it only counts them then.
bool pairsOnHost(QueryMesh& a, QueryMesh& b, float radius, std::uint64_t limit, std::uint64_t& candidates,
                 PairDecision& decision)
{
    refitBoth(a, b, radius);
    candidates = leafPairsBeyond(a.tree(), b.tree(), walkOf(a, b), limit);
    if (candidates > 0) return false;
    const auto visit = [&](const Candidate& pair)
    {
        ++candidates;
        const PairAnswer answer = trianglePairAnswer(pair, a.m_start, a.m_topology.m_triangles.data(), b.m_start,
                                                     b.m_topology.m_triangles.data(), radius);
        if (answer.m_bits != 0) decision.take(answer);
    };
    leafPairsOnHost(a.tree(), b.tree(), walkOf(a, b), visit);
    return true;
}
}  // namespace

CcdSettings defaultCcdSettings()
{
    return ccdDefaults();
}

Queries::Queries(const Settings& settings) : m_implementation(new Implementation(settings)) {}

Queries::~Queries()
{
    const DefaultFloats floats;
    m_implementation.reset();
}

std::unique_ptr<Queries> Queries::create(const Settings& settings, Error& error)
{
    return guarded([&] { return Implementation::make(settings, error); },
                   [&](const CaughtException& caught)
                   {
                       setError(error, "drape::Queries::create", caught);
                       return std::unique_ptr<Queries>();
                   });
}

bool Queries::motions(const CcdQuery* queries, std::size_t count, const CcdSettings& settings, CcdResult* results)
{
    return m_implementation->answer("motions",
                                    [&] { return m_implementation->motions(queries, count, settings, results); });
}

bool Queries::triangles(const TriangleQuery* queries, std::size_t count, TriangleTest test, std::uint32_t* results)
{
    return m_implementation->answer("triangles",
                                    [&] { return m_implementation->triangles(queries, count, test, results); });
}

bool Queries::meshPairs(const MeshDescription& a, const MeshDescription* b, float radius, MeshPairs& found)
{
    const bool good =
        m_implementation->answer("meshPairs", [&] { return m_implementation->meshPairs(a, b, radius, found); });
    if (!good) found = MeshPairs();
    return good;
}

bool Queries::meshMotion(const MeshDescription& mesh, const float* end, const CcdSettings& settings, MeshMotion& found)
{
    const bool good = m_implementation->answer(
        "meshMotion", [&] { return m_implementation->meshMotion(mesh, end, settings, found); });
    if (!good) found = MeshMotion();
    return good;
}

std::unique_ptr<Queries> Queries::Implementation::make(const Settings& settings, Error& error)
{
    Stopwatch watch;
    error = Error();
    if (!checkSettings(settings, error)) return nullptr;
    const DeviceChoice choice = chooseDevice(settings, error);
    if (error.failed()) return nullptr;
    std::unique_ptr<Queries> queries(new Queries(settings));
    Implementation& self = *queries->m_implementation;
    self.m_report.m_reason = choice.m_reason;
    self.m_report.m_device.m_name = "host";
    if (choice.m_onHost) return queries;
    std::unique_ptr<Device> device = Device::open(choice.m_index, error);
    if (device)
    {
        self.m_device.reset(new QueryDevice(std::move(device), settings));
        error = self.m_device->device().error();
    }
    if (error.failed())
    {
        self.m_device.reset();
        if (!choice.m_byCost) return nullptr;
        self.m_report.m_reason = hostSince(choice.m_device, error);
        self.m_error = error;
        error = Error();
        return queries;
    }
    self.m_report.m_device = choice.m_device;
    self.m_report.m_onHost = false;
    self.m_report.m_fromCache = self.m_device->fromCache();
    self.m_report.m_buildMs = watch.lapMs();
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

bool Queries::Implementation::motions(const CcdQuery* queries, std::size_t count, const CcdSettings& settings,
                                      CcdResult* results)
{
    if (!require(count == 0 || (queries && results), "motions", "an array is missing") ||
        !requireSettings(settings, "motions"))
        return false;
    const CcdQuery* const unknown =
        std::find_if(queries, queries + count, [](const CcdQuery& query) { return query.m_kind > DRAPE_EDGES; });
    if (!require(unknown == queries + count, "motions", "a query with an unknown kind")) return false;
    if (m_device) return check(m_device->motions(queries, count, settings, results));
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

bool Queries::Implementation::triangles(const TriangleQuery* queries, std::size_t count, TriangleTest test,
                                        std::uint32_t* results)
{
    if (!require(count == 0 || (queries && results), "triangles", "an array is missing") ||
        !require(test >= TriangleTest::Certified && test <= TriangleTest::Exact, "triangles", "an unknown test"))
        return false;
    if (m_device && !check(m_device->triangles(queries, count, results))) return false;
    for (std::size_t i = 0; i < count; ++i)
    {
        if (!m_device) results[i] = testOnHost(queries[i]);
        if (test == TriangleTest::Exact && results[i] != 0)
            results[i] = trianglesMeet(exactTriangle(queries[i].m_a), exactTriangle(queries[i].m_b));
    }
    return true;
}

bool Queries::Implementation::meshPairs(const MeshDescription& a, const MeshDescription* b, float radius,
                                        MeshPairs& found)
{
    found = MeshPairs();
    if (!checkIndices(a, "meshPairs", m_error)) return false;
    if (b && !checkIndices(*b, "meshPairs", m_error)) return false;
    if (!require(std::isfinite(radius) && radius >= 0.0f, "meshPairs", "a radius that is negative or not finite"))
        return false;
    QueryMesh first = makeQueryMeshWithEdges(a, a.m_positions), other;
    if (b) other = makeQueryMeshWithEdges(*b, b->m_positions);
    QueryMesh& second = b ? other : first;
    PairDecision decision(first, second, double(radius), m_limits.m_contacts, found);
    const std::uint64_t limit = m_limits.m_candidates;
    bool within = true;
    if (!m_device)
        within = pairsOnHost(first, second, radius, limit, found.m_candidates, decision);
    else if (!check(m_device->meshPairs(first, second, radius, limit, found.m_candidates, decision, within)))
        return false;
    decision.finish();
    if (within) return true;
    const std::uint64_t candidates = found.m_candidates;
    found = MeshPairs();
    found.m_limits = kQueryCandidateLimit;
    found.m_candidates = candidates;
    return true;
}

bool Queries::Implementation::meshMotion(const MeshDescription& description, const float* end,
                                         const CcdSettings& settings, MeshMotion& found)
{
    found = MeshMotion();
    if (!checkIndices(description, "meshMotion", m_error)) return false;
    if (!require(end || description.m_vertexCount == 0, "meshMotion", "an array is missing") ||
        !requireSettings(settings, "meshMotion"))
        return false;
    QueryMesh mesh = makeQueryMesh(description, end);
    const SelfLimits limits = {m_limits.m_candidates, m_limits.m_contacts};
    SelfCollisions collisions;
    if (!m_device)
    {
        mesh.refit(selfRadius(settings));
        const HostMotion motion = {mesh.tree(), mesh.m_topology.m_edges, mesh.m_start, mesh.m_end,
                                   description.m_vertexCount};
        selfCollideOnHost(motion, settings, limits, collisions);
    }
    else if (!check(m_device->meshMotion(mesh, settings, limits, collisions)))
        return false;
    sortHits(collisions.m_hits);
    found.m_limits = (collisions.m_untested ? kQueryCandidateLimit : kQueryWhole) |
                     (collisions.hits() > limits.m_hits ? kQueryAnswerLimit : kQueryWhole);
    found.m_trianglePairs = collisions.m_trianglePairs;
    found.m_vertexFaceCandidates = collisions.m_vertexFaceCandidates;
    found.m_edgeCandidates = collisions.m_edgeCandidates;
    found.m_vertexFaceHits = collisions.m_hitCount[DRAPE_VERTEX_FACE];
    found.m_edgeHits = collisions.m_hitCount[DRAPE_EDGES];
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
