// Fuzzes the questions of drape/queries.h on the host back end: single pairs, meshes against each other and themselves,
// meshes that move.
//
// Expects no crash and no undefined behaviour. A mesh with an index out of range is refused. Exact answers equal
// rational arithmetic over every pair. Features that touch at the step's start or end are a hit. Answers are sorted and
// their indices belong to the meshes.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <set>
#include <tuple>
#include <vector>

#include "drape/queries.h"
#include "scenes/describe_mesh.h"
#include "oracle/exact_predicates.h"
#include "tests/fuzz/bytes.h"

namespace
{
using drape::Vector3;
using drape::fuzz::AnyMesh;
using drape::fuzz::Bytes;
using drape::fuzz::require;

constexpr float kFarthest = 1073741824.0f;  // m, 2^30: meshes count what is farther out as no number
constexpr std::uint32_t kMostQueries = 16;

drape::Queries& queries()
{
    static const std::unique_ptr<drape::Queries> host = []
    {
        drape::Settings settings;
        settings.m_backend = drape::Backend::Host;
        drape::Error error;
        return drape::Queries::create(settings, error);
    }();
    require(host != nullptr);
    return *host;
}

bool areFinite(const float* values, std::size_t count)
{
    return std::all_of(values, values + count, [](float value) { return std::isfinite(value); });
}

Vector3 pointAt(const float* positions, std::size_t index)
{
    return {positions[3 * index], positions[3 * index + 1], positions[3 * index + 2]};
}

drape::CcdSettings settingsFrom(Bytes& bytes)
{
    drape::CcdSettings settings = drape::defaultCcdSettings();
    settings.m_separation = bytes.below(2) ? bytes.length() : 0.0f;
    settings.m_tolerance = std::ldexp(1.0f, -int(bytes.below(30)));
    settings.m_timeTolerance = std::ldexp(1.0f, -int(bytes.below(24)));
    settings.m_boxLimit = 1 + 8 * bytes.byte();
    return settings;
}

// Returns true if the pair's four points touch at these positions.
bool touches(std::uint32_t kind, const Vector3 p[4])
{
    const bool edges = kind == DRAPE_EDGES;
    const Vector3 first[3] = {p[0], edges ? p[1] : p[0], p[0]};
    const Vector3 second[3] = {edges ? p[2] : p[1], edges ? p[3] : p[2], p[3]};
    return drape::trianglesIntersect(first, second);
}

bool touches(std::uint32_t kind, const float points[12])
{
    const Vector3 p[4] = {pointAt(points, 0), pointAt(points, 1), pointAt(points, 2), pointAt(points, 3)};
    return touches(kind, p);
}

void askMotions(Bytes& bytes)
{
    const drape::CcdSettings settings = settingsFrom(bytes);
    std::vector<drape::CcdQuery> asked(bytes.below(kMostQueries));
    for (drape::CcdQuery& query : asked)
    {
        query.m_kind = bytes.below(2);
        for (float* points : {query.m_start, query.m_end})
            std::generate_n(points, 12, [&] { return bytes.number(); });
    }
    std::vector<drape::CcdResult> results(asked.size());
    require(queries().motions(asked.data(), asked.size(), settings, results.data()));
    for (std::size_t i = 0; i < asked.size(); ++i)
    {
        const drape::CcdQuery& query = asked[i];
        const drape::CcdResult& result = results[i];
        require(result.m_hit <= 1 && result.m_time >= 0.0f && result.m_time <= 1.0f);
        require(std::isfinite(result.m_u) && std::isfinite(result.m_v));
        require(result.m_hit || result.m_time == 1.0f);
        const bool finite = areFinite(query.m_start, 12) && areFinite(query.m_end, 12);
        require(finite || !result.m_hit);
        if (finite && touches(query.m_kind, query.m_start)) require(result.m_hit && result.m_time == 0.0f);
        if (finite && touches(query.m_kind, query.m_end)) require(result.m_hit);
    }
}

bool meet(const float a[9], const float b[9])
{
    const Vector3 first[3] = {pointAt(a, 0), pointAt(a, 1), pointAt(a, 2)};
    const Vector3 second[3] = {pointAt(b, 0), pointAt(b, 1), pointAt(b, 2)};
    return drape::trianglesIntersect(first, second);
}

void askTriangles(Bytes& bytes)
{
    std::vector<drape::TriangleQuery> asked(bytes.below(kMostQueries));
    for (drape::TriangleQuery& query : asked)
        for (float* corners : {query.m_a, query.m_b})
            std::generate_n(corners, 9, [&] { return bytes.number(); });
    std::vector<std::uint32_t> certified(asked.size()), exact(asked.size());
    require(queries().triangles(asked.data(), asked.size(), drape::TriangleTest::Certified, certified.data()));
    require(queries().triangles(asked.data(), asked.size(), drape::TriangleTest::Exact, exact.data()));
    for (std::size_t i = 0; i < asked.size(); ++i)
    {
        const bool finite = areFinite(asked[i].m_a, 9) && areFinite(asked[i].m_b, 9);
        require(certified[i] <= 1 && exact[i] <= certified[i]);
        require(exact[i] == std::uint32_t(finite && meet(asked[i].m_a, asked[i].m_b)));
    }
}

// The triangles that count: of three vertices and no earlier triangle's, and where they are a number.
struct Faces
{
    struct Face
    {
        std::uint32_t m_number;
        const std::int32_t* m_indices;
        Vector3 m_corners[3];
        bool m_valid;
    };
    std::vector<Face> m_faces;

    Faces(const AnyMesh& mesh, const float* positions)
    {
        std::set<std::array<std::int32_t, 3>> known;
        for (std::uint32_t number = 0; number < mesh.m_triangles.size() / 3; ++number)
        {
            const std::int32_t* indices = &mesh.m_triangles[3 * number];
            std::array<std::int32_t, 3> key = {indices[0], indices[1], indices[2]};
            std::sort(key.begin(), key.end());
            if (key[0] == key[1] || key[1] == key[2] || !known.insert(key).second) continue;
            Face face = {number, indices, {}, true};
            for (std::size_t i = 0; i < 3; ++i)
            {
                face.m_corners[i] = pointAt(positions, std::size_t(indices[i]));
                face.m_valid = face.m_valid && isValid(positions, indices[i]);
            }
            m_faces.push_back(face);
        }
    }

    static bool isValid(const float* positions, std::int32_t vertex)
    {
        const float* p = positions + 3 * vertex;
        return std::all_of(p, p + 3, [](float value) { return std::fabs(value) <= kFarthest; });
    }
};

bool share(const Faces::Face& a, const Faces::Face& b)
{
    return std::find_first_of(a.m_indices, a.m_indices + 3, b.m_indices, b.m_indices + 3) != a.m_indices + 3;
}

using Pair = std::pair<std::uint32_t, std::uint32_t>;

std::vector<Pair> pairsOf(const std::vector<drape::NearTriangles>& list)
{
    std::vector<Pair> pairs;
    for (const drape::NearTriangles& pair : list)
        pairs.emplace_back(pair.m_a, pair.m_b);
    require(std::is_sorted(pairs.begin(), pairs.end()));
    return pairs;
}

std::vector<Pair> meetingPairs(const AnyMesh& a, const AnyMesh& b, bool self)
{
    std::vector<Pair> pairs;
    const Faces second(b, b.m_positions.data());
    for (const Faces::Face& p : Faces(a, a.m_positions.data()).m_faces)
        for (const Faces::Face& q : second.m_faces)
        {
            if (!p.m_valid || !q.m_valid || (self && (p.m_number >= q.m_number || share(p, q)))) continue;
            if (drape::trianglesIntersect(p.m_corners, q.m_corners)) pairs.emplace_back(p.m_number, q.m_number);
        }
    return pairs;
}

void askMeshPairs(Bytes& bytes)
{
    const float radius = bytes.length();
    const bool self = bytes.below(2) == 0, badIndices = bytes.below(4) == 0;
    const AnyMesh a(bytes, badIndices), other(bytes, badIndices);
    const AnyMesh& b = self ? a : other;
    const drape::MeshDescription second = describeMesh(b);
    drape::MeshPairs found;
    const bool good = queries().meshPairs(describeMesh(a), self ? nullptr : &second, radius, found);
    require(good == (a.m_inRange && b.m_inRange));
    require(good || queries().error().failed());
    if (!good) return;
    const std::vector<Pair> within = pairsOf(found.m_within), meeting = pairsOf(found.m_intersecting);
    require(meeting == meetingPairs(a, b, self));
    require(std::includes(within.begin(), within.end(), meeting.begin(), meeting.end()));
    require(within.size() <= found.m_candidates);
}

using VertexFace = std::array<std::int32_t, 4>;  // the face's vertices sorted

VertexFace vertexFace(std::int32_t vertex, const std::int32_t* face)
{
    VertexFace key = {vertex, face[0], face[1], face[2]};
    std::sort(key.begin() + 1, key.end());
    return key;
}

// The pairs of a vertex and a face without it that have a point in common, of those whose numbers count before and
// after.
std::vector<VertexFace> touchingPairs(const AnyMesh& mesh, const float* positions, const float* others)
{
    const Faces faces(mesh, positions), otherFaces(mesh, others);
    std::set<std::int32_t> vertices;
    for (const Faces::Face& face : faces.m_faces)
        for (const std::int32_t* vertex = face.m_indices; vertex != face.m_indices + 3; ++vertex)
            if (Faces::isValid(positions, *vertex) && Faces::isValid(others, *vertex)) vertices.insert(*vertex);
    std::vector<VertexFace> pairs;
    for (std::size_t i = 0; i < faces.m_faces.size(); ++i)
    {
        const Faces::Face& face = faces.m_faces[i];
        if (!face.m_valid || !otherFaces.m_faces[i].m_valid) continue;
        for (const std::int32_t vertex : vertices)
        {
            if (std::count(face.m_indices, face.m_indices + 3, vertex)) continue;
            const Vector3 p = pointAt(positions, std::size_t(vertex)), point[3] = {p, p, p};
            if (drape::trianglesIntersect(point, face.m_corners)) pairs.push_back(vertexFace(vertex, face.m_indices));
        }
    }
    return pairs;
}

void checkTouching(const AnyMesh& mesh, const std::vector<float>& end, const drape::MeshMotion& found)
{
    std::set<VertexFace> touching;
    for (const drape::TouchingFeatures& features : found.m_touching)
    {
        require(features.m_kind <= DRAPE_EDGES && features.m_time >= 0.0f && features.m_time <= 1.0f);
        for (const std::uint32_t vertex : features.m_vertices)
            require(3 * std::size_t(vertex) < mesh.m_positions.size());
        std::int32_t vertices[4];
        std::copy_n(features.m_vertices, 4, vertices);
        if (features.m_kind == DRAPE_VERTEX_FACE) touching.insert(vertexFace(vertices[0], vertices + 1));
    }
    for (const VertexFace& pair : touchingPairs(mesh, mesh.m_positions.data(), end.data()))
        require(touching.count(pair));
    for (const VertexFace& pair : touchingPairs(mesh, end.data(), mesh.m_positions.data()))
        require(touching.count(pair));
}

void askMeshMotion(Bytes& bytes)
{
    const drape::CcdSettings settings = settingsFrom(bytes);
    const AnyMesh mesh(bytes, bytes.below(4) == 0);
    std::vector<float> end = mesh.m_positions;
    if (bytes.below(4) != 0) std::generate(end.begin(), end.end(), [&] { return bytes.number(); });
    drape::MeshMotion found;
    const bool good = queries().meshMotion(describeMesh(mesh), end.data(), settings, found);
    require(good == mesh.m_inRange);
    if (!good) return;
    require(found.m_touching.size() <= found.m_vertexFaceCandidates + found.m_edgeCandidates);
    checkTouching(mesh, end, found);
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    Bytes bytes(data, size);
    switch (bytes.below(4))
    {
        case 0:
            askMotions(bytes);
            break;
        case 1:
            askTriangles(bytes);
            break;
        case 2:
            askMeshPairs(bytes);
            break;
        default:
            askMeshMotion(bytes);
    }
    return 0;
}
