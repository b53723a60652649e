// Collision queries outside a simulation: batches of feature pairs and triangle pairs, and whole meshes.
//
// Input: arrays of the caller, read during the call. Output: counts, sorted lists and flags. Guarantee: no true pair is
// denied, and every back end gives the same answers, bit for bit. Lists grow as needed. Work beyond
// Settings::m_candidateLimit or m_contactLimit is counted and reported, so memory and time are bounded. Cost: each call
// uploads, computes and waits. All calls run in the default floating-point environment and restore the caller's.
// Lengths are metres. Needs no Bullet and no Plugin. A Queries object is not thread-safe. C++11, no OpenCL header.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "drape/error.h"
#include "drape/export.h"
#include "drape/mesh_description.h"
#include "drape/query_records.h"
#include "drape/report.h"
#include "drape/settings.h"

namespace drape
{
// Returns working defaults of continuous collision. On the published data they miss no true pair and report 157 of the
// 6,598 pairs that do not touch.
DRAPE_EXPORT CcdSettings defaultCcdSettings();

// Selects the test of two triangles.
enum class TriangleTest
{
    Certified,  // denies no pair that intersects; reports a few pairs that nearly touch
    Exact       // gives the exact answer: the host decides reported pairs without rounding
};

// Bits of a result's m_limits. Zero means that every candidate was tested and every answer is listed.
enum QueryLimitBits : std::uint32_t
{
    kQueryWhole = 0,                 // the result is complete
    kQueryCandidateLimit = 1u << 0,  // there are more pairs than Settings::m_candidateLimit; none was tested
    kQueryAnswerLimit = 1u << 1      // there are more answers than Settings::m_contactLimit; they are only counted
};

// Result of Queries::meshPairs. Counts are exact; with kQueryCandidateLimit only m_candidates is set.
struct MeshPairs
{
    // QueryLimitBits.
    std::uint32_t m_limits = kQueryWhole;
    // Number of pairs whose volumes overlap; exact beyond the limit, too.
    std::uint64_t m_candidates = 0;
    // Number of pairs within the radius.
    std::uint64_t m_withinCount = 0;
    // Number of pairs that intersect.
    std::uint64_t m_intersectingCount = 0;
    // Pairs at a distance ≤ the radius, decided in double precision; sorted.
    std::vector<NearTriangles> m_within;
    // Pairs that intersect, decided exactly; sorted.
    std::vector<NearTriangles> m_intersecting;
};

// Result of Queries::meshMotion. kQueryCandidateLimit means that the triangle pairs, or the feature pairs of both
// kinds, exceed the limit; in the first case only m_trianglePairs is set.
struct MeshMotion
{
    // QueryLimitBits.
    std::uint32_t m_limits = kQueryWhole;
    // Number of triangle pairs whose volumes overlap; exact beyond the limit, too.
    std::uint64_t m_trianglePairs = 0;
    // Number of vertex-face pairs whose volumes over the step overlap.
    std::uint64_t m_vertexFaceCandidates = 0;
    // Number of edge-edge pairs whose volumes over the step overlap.
    std::uint64_t m_edgeCandidates = 0;
    // Number of vertex-face pairs that touch.
    std::uint64_t m_vertexFaceHits = 0;
    // Number of edge-edge pairs that touch.
    std::uint64_t m_edgeHits = 0;
    // Pairs that touch, vertex-face pairs first.
    std::vector<TouchingFeatures> m_touching;
};

// Runs queries on one back end. Every function below returns false if the device failed, the input is invalid (an index
// out of range, a missing array, an unknown kind, a length that is not a number) or memory ran out. error() then has
// the cause, and the results are undefined. Later calls may succeed. No exception leaves this class.
class DRAPE_EXPORT Queries
{
public:
    // Chooses the device, compiles its kernels and keeps the settings' limits. Returns null and fills `error` if the
    // settings are out of range, the requested device is missing or unusable, or memory ran out. Backend::Auto uses the
    // first device whatever the work, and the host if there is none or it fails; error() of the result then says why.
    static std::unique_ptr<Queries> create(const Settings& settings, Error& error);
    // Frees the device's memory.
    ~Queries();
    // Queries own a device: no copies.
    Queries(const Queries&) = delete;
    // Queries own a device: no copies.
    Queries& operator=(const Queries&) = delete;

    // Returns the device in use and the reason for it. The reference is valid as long as this object.
    const DeviceReport& deviceReport() const;

    // Returns the last failure. The reference is valid as long as this object.
    const Error& error() const;

    // Answers `count` continuous queries; writes `count` results.
    bool motions(const CcdQuery* queries, std::size_t count, const CcdSettings& settings, CcdResult* results);

    // Tests `count` pairs of triangles; writes `count` results, 1 for a pair that intersects and 0 otherwise.
    bool triangles(const TriangleQuery* queries, std::size_t count, TriangleTest test, std::uint32_t* results);

    // Finds pairs of triangles of `a` and `b` within `radius` (m, ≥ 0) and pairs that intersect. A null `b` pairs `a`
    // with itself, without triangles that share a vertex. A triangle with a corner that is not finite or beyond 2^30 m
    // is in no pair. Read found.m_limits before the lists.
    bool meshPairs(const MeshDescription& a, const MeshDescription* b, float radius, MeshPairs& found);

    // Finds features of `mesh` that touch one another while its vertices move in straight lines to `end` (x y z per
    // vertex, m). A vertex that is not finite or beyond 2^30 m touches nothing. Read found.m_limits before the list.
    bool meshMotion(const MeshDescription& mesh, const float* end, const CcdSettings& settings, MeshMotion& found);

private:
    explicit Queries(const Settings& settings);
    struct DRAPE_HIDDEN Implementation;
    std::unique_ptr<Implementation> m_implementation;
};
}  // namespace drape
