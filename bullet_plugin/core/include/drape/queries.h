// Questions outside a cloth's step, on the chosen back end: do moving features touch, do triangles intersect, which
// pairs of two meshes are near, which features of a moving mesh touch one another.
//
// Job: batches of single pairs, and whole meshes with their own hierarchies, made for the call. Guarantee: no true pair
// is denied; the same answers, bit for bit, on every back end. Lists grow and the work is done in batches; what is
// beyond Settings::m_candidateLimit and m_contactLimit is counted and said to be so, so that memory and time are
// bounded. Cost: each call uploads, computes and waits, in the default floating-point environment, whatever the app's
// is. Lengths in metres. Knows no Bullet and needs no plugin. Not thread-safe. C++11, no OpenCL header needed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "error.h"
#include "mesh_description.h"
#include "query_records.h"
#include "report.h"
#include "settings.h"

namespace drape
{
// Working defaults of continuous collision: no published true pair is missed, 157 false hits among the 6,598 published
// pairs that do not touch.
CcdSettings defaultCcdSettings();

enum class TriangleTest
{
    Certified,  // no pair that intersects is denied; a few that nearly touch are reported
    Exact       // the truth: what the certified test reports is decided on the host without rounding
};

// Two triangles by their index as given: of the first mesh, and of the second or, with itself, the later one. Edges of
// MeshDescription::m_edges are triangles without area here, numbered behind the triangles.
struct NearTriangles
{
    std::uint32_t m_a, m_b;
};

// Bits of m_limits in a result. Zero: every candidate was tested, and every answer is listed.
enum QueryLimitBits : std::uint32_t
{
    kQueryWhole = 0,
    kQueryCandidateLimit = 1u << 0,  // more pairs than Settings::m_candidateLimit: no answer is counted or listed
    kQueryAnswerLimit = 1u << 1      // more answers than Settings::m_contactLimit: they are counted, none is listed
};

// Counts are exact, whatever the limits; with kQueryCandidateLimit there is only m_candidates.
struct MeshPairs
{
    std::uint32_t m_limits = kQueryWhole;
    std::uint64_t m_candidates = 0;  // pairs whose volumes overlap; exact beyond the limit, too
    std::uint64_t m_withinCount = 0;
    std::uint64_t m_intersectingCount = 0;
    std::vector<NearTriangles> m_within;        // distance ≤ the radius, decided in double precision; sorted
    std::vector<NearTriangles> m_intersecting;  // exact; sorted
};

// Two features that touch during a step, by their vertices: a vertex and a face, or two edges (see CcdQuery).
struct TouchingFeatures
{
    std::uint32_t m_kind;  // DRAPE_VERTEX_FACE or DRAPE_EDGES
    std::uint32_t m_vertices[4];
    float m_time;  // of impact, part of the step
};

// kQueryCandidateLimit: more pairs of triangles, which alone are counted then, or more pairs of features of both kinds.
struct MeshMotion
{
    std::uint32_t m_limits = kQueryWhole;
    std::uint64_t m_trianglePairs = 0;         // exact beyond the limit, too
    std::uint64_t m_vertexFaceCandidates = 0;  // pairs whose own volumes over the step overlap
    std::uint64_t m_edgeCandidates = 0;
    std::uint64_t m_vertexFaceHits = 0;  // those that touch
    std::uint64_t m_edgeHits = 0;
    std::vector<TouchingFeatures> m_touching;  // vertices and faces first
};

class Queries
{
public:
    // Chooses the device and makes its kernels ready; keeps the settings' limits. Returns null and fills error when
    // settings ask for what is not there or does not work, or are out of their ranges. Backend::Auto is the first
    // device, whatever the work, and the host where there is none or it fails: then error() of what is returned says
    // why. Returns null, too, where memory runs out.
    static std::unique_ptr<Queries> create(const Settings& settings, Error& error);
    ~Queries();
    Queries(const Queries&) = delete;
    Queries& operator=(const Queries&) = delete;

    const DeviceReport& deviceReport() const;

    // Each returns false when the device failed, a mesh has an index out of range, an array is missing, a kind or a
    // length is none, or memory ran out; error() says how of the last that did. Then nothing is found, and results are
    // not to be read; further calls may succeed. No exception leaves this class.
    const Error& error() const;

    // results: count of them.
    bool motions(const CcdQuery* queries, std::size_t count, const CcdSettings& settings, CcdResult* results);

    // results: 1 for each pair that intersects, else 0.
    bool triangles(const TriangleQuery* queries, std::size_t count, TriangleTest test, std::uint32_t* results);

    // Pairs of a's triangles with b's; b null: with a's own that share no vertex. radius ≥ 0. A triangle with a corner
    // that is NaN, infinite or farther out than 2^30 m is in no pair, and such a vertex touches nothing in meshMotion.
    // Look at found.m_limits before its lists.
    bool meshPairs(const MeshDescription& a, const MeshDescription* b, float radius, MeshPairs& found);

    // Which features of the mesh touch one another while it moves from its positions to `end` (x y z per vertex). Look
    // at found.m_limits before its list.
    bool meshMotion(const MeshDescription& mesh, const float* end, const CcdSettings& settings, MeshMotion& found);

private:
    explicit Queries(const Settings& settings);
    struct Implementation;
    std::unique_ptr<Implementation> m_implementation;
};
}  // namespace drape
