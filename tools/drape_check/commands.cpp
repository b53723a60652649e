#include "tools/drape_check/commands.h"

#include <chrono>
#include <cmath>

#include "scenes/describe_mesh.h"
#include "scenes/mesh_loader.h"
#include "tools/common/device_option.h"
#include "scenes/query_records.h"

namespace drape
{
namespace
{
using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

double microsecondsSince(Clock::time_point start)
{
    return std::chrono::duration<double, std::micro>(Clock::now() - start).count();
}

// Returns null, with `error` and `exitCode`, if the requested back end is not available.
std::unique_ptr<Queries> openQueries(const Options& options, Json& answer, std::string& error, int& exitCode)
{
    Settings settings;
    settings.m_candidateLimit = options.m_candidateLimit;
    exitCode = kExitBadInput;
    if (!deviceSettings(options.m_backend, options.m_device, settings, error)) return nullptr;
    Error problem;
    std::unique_ptr<Queries> queries = Queries::create(settings, problem);
    exitCode = kExitFailed;
    error = problem.text();
    if (!queries) return nullptr;
    const DeviceReport& report = queries->deviceReport();
    answer["backend"] = report.m_onHost ? "host" : "opencl";
    answer["device"] = report.m_device.m_name;
    answer["prepare_ms"] = report.m_buildMs;
    return queries;
}

CcdSettings ccdSettingsOf(const Options& options)
{
    CcdSettings settings = defaultCcdSettings();
    settings.m_separation = float(options.m_separation);
    settings.m_tolerance = float(options.m_tolerance);
    settings.m_timeTolerance = float(options.m_timeTolerance);
    return settings;
}

// Refuses files with more pairs than may be tested. The answer keeps what is counted.
bool refuseTooMany(const Options& options, std::uint64_t pairs, const char* what, Json& answer, std::string& error,
                   int& exitCode)
{
    answer[kLimitReached] = true;
    answer["candidate_limit"] = options.m_candidateLimit;
    error = options.m_first + (options.m_second.empty() ? "" : ", " + options.m_second) + ": " + std::to_string(pairs) +
            " pairs of " + what + " to test, more than --candidate-limit " + std::to_string(options.m_candidateLimit);
    exitCode = kExitBadInput;
    return false;
}

// Answers all queries twice, since drivers may compile at the first launch, and times the second; counts what differs
// from the truth. hit(i) tells the answer.
template <typename AnswerAll, typename Hit>
bool score(const std::vector<bool>& truth, AnswerAll answerAll, Hit hit, Json& answer)
{
    if (!answerAll()) return false;
    const Clock::time_point start = Clock::now();
    if (!answerAll()) return false;
    const double time = microsecondsSince(start);
    std::size_t misses = 0, falseHits = 0;
    for (std::size_t i = 0; i < truth.size(); ++i)
    {
        misses += truth[i] && !hit(i);
        falseHits += !truth[i] && hit(i);
    }
    answer["queries"] = truth.size();
    answer["misses"] = misses;
    answer["false_hits"] = falseHits;
    answer["us_per_query"] = time / double(truth.size());
    return true;
}

// The tests decide nothing for positions beyond this (drape/queries.h).
constexpr float kFarthest = 1073741824.0f;  // m, 2^30

bool refuseFar(const std::string& path, const std::vector<float>& positions, std::string& error)
{
    for (std::size_t i = 0; i < positions.size(); ++i)
    {
        if (std::fabs(positions[i]) <= kFarthest) continue;
        error = path + ": vertex " + std::to_string(i / 3 + 1) + ": coordinate beyond 2^30 m";
        return true;
    }
    return false;
}

bool answerCcd(const Options& options, Json& answer, std::string& error, int& exitCode)
{
    MotionRecords records;
    exitCode = kExitBadInput;
    if (!readRecords(options.m_first, records, error)) return false;
    const std::unique_ptr<Queries> queries = openQueries(options, answer, error, exitCode);
    if (!queries) return false;
    std::vector<CcdResult> results(records.m_queries.size());
    const CcdSettings settings = ccdSettingsOf(options);
    const auto answerAll = [&]
    { return queries->motions(records.m_queries.data(), results.size(), settings, results.data()); };
    const auto hit = [&](std::size_t i) { return results[i].m_hit != 0; };
    if (score(records.m_truth, answerAll, hit, answer)) return true;
    error = queries->error().text();
    return false;
}

bool answerTriangles(const Options& options, Json& answer, std::string& error, int& exitCode)
{
    TriangleRecords records;
    exitCode = kExitBadInput;
    if (!readRecords(options.m_first, records, error)) return false;
    const std::unique_ptr<Queries> queries = openQueries(options, answer, error, exitCode);
    if (!queries) return false;
    std::vector<std::uint32_t> results(records.m_queries.size());
    const auto answerAll = [&]
    { return queries->triangles(records.m_queries.data(), results.size(), options.m_test, results.data()); };
    const auto hit = [&](std::size_t i) { return results[i] != 0; };
    if (score(records.m_truth, answerAll, hit, answer)) return true;
    error = queries->error().text();
    return false;
}

Joining joiningOf(const Options& options)
{
    return options.m_join ? Joining::ByPosition : Joining::ByIndex;
}

// Says how the files became meshes: which vertices are one, and what rounding to float32 changed.
void addReport(const LoadReport& report, Json& answer)
{
    answer["vertices"] = report.m_isJoined ? "joined by position" : "by index";
    answer["rounding_error"] = report.m_rounding;
    if (report.isCentred()) answer["centre"] = report.m_centre;
    if (!report.m_notes.empty()) answer["notes"] = report.m_notes;
}

bool answerPairs(const Options& options, Json& answer, std::string& error, int& exitCode)
{
    const bool two = !options.m_second.empty();
    TriangleMesh a, b;
    exitCode = kExitBadInput;
    LoadReport report;
    const Joining joining = joiningOf(options);
    if (two ? !loadMeshes(options.m_first, options.m_second, joining, a, b, report, error)
            : !loadMesh(options.m_first, joining, a, report, error))
        return false;
    if (refuseFar(options.m_first, a.m_positions, error) || refuseFar(options.m_second, b.m_positions, error))
        return false;
    addReport(report, answer);
    const std::unique_ptr<Queries> queries = openQueries(options, answer, error, exitCode);
    if (!queries) return false;
    const MeshDescription second = describeMesh(b);
    MeshPairs found;
    const Clock::time_point start = Clock::now();
    if (!queries->meshPairs(describeMesh(a), two ? &second : nullptr, float(options.m_thickness), found))
    {
        error = queries->error().text();
        return false;
    }
    answer["candidates"] = found.m_candidates;
    if (found.m_limits & kQueryCandidateLimit)
        return refuseTooMany(options, found.m_candidates, "triangles", answer, error, exitCode);
    answer["pairs_within"] = found.m_withinCount;
    answer["intersecting_pairs"] = found.m_intersectingCount;
    answer["ms"] = microsecondsSince(start) / 1000;
    return true;
}

bool answerStep(const Options& options, Json& answer, std::string& error, int& exitCode)
{
    TriangleMesh mesh;
    std::vector<float> end;
    exitCode = kExitBadInput;
    LoadReport report;
    if (!loadMotion(options.m_first, options.m_second, joiningOf(options), mesh, end, report, error)) return false;
    if (refuseFar(options.m_first, mesh.m_positions, error) || refuseFar(options.m_second, end, error)) return false;
    addReport(report, answer);
    const std::unique_ptr<Queries> queries = openQueries(options, answer, error, exitCode);
    if (!queries) return false;
    MeshMotion found;
    const Clock::time_point start = Clock::now();
    if (!queries->meshMotion(describeMesh(mesh), end.data(), ccdSettingsOf(options), found))
    {
        error = queries->error().text();
        return false;
    }
    const bool tooMany = (found.m_limits & kQueryCandidateLimit) != 0;
    const std::uint64_t features = found.m_vertexFaceCandidates + found.m_edgeCandidates;
    answer["triangle_pairs"] = found.m_trianglePairs;
    if (tooMany && features == 0)
        return refuseTooMany(options, found.m_trianglePairs, "triangles", answer, error, exitCode);
    answer["vf_candidates"] = found.m_vertexFaceCandidates;
    if (!tooMany) answer["vf_hits"] = found.m_vertexFaceHits;
    answer["ee_candidates"] = found.m_edgeCandidates;
    if (tooMany) return refuseTooMany(options, features, "features", answer, error, exitCode);
    answer["ee_hits"] = found.m_edgeHits;
    answer["ms"] = microsecondsSince(start) / 1000;
    return true;
}
}  // namespace

bool runCommand(const Options& options, Json& answer, std::string& error, int& exitCode)
{
    switch (options.m_command)
    {
        case Command::Ccd:
            return answerCcd(options, answer, error, exitCode);
        case Command::Triangles:
            return answerTriangles(options, answer, error, exitCode);
        case Command::Pairs:
            return answerPairs(options, answer, error, exitCode);
        case Command::Step:
            return answerStep(options, answer, error, exitCode);
    }
    return false;
}
}  // namespace drape
