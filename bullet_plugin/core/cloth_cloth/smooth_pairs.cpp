#include "smooth_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bullet_plugin/core/vec3d.h"

namespace drape
{
namespace
{
// Maximum numbers of pairs of a patch, and of nodes of the cover of a pair and of a region. Others are tested in every
// step.
constexpr std::size_t kMostPairs = 48, kMostNodes = 255, kMostRegionNodes = 1023;
// Greatest ratio of a way in a cover at rest to that in its plane: the cover is nearly flat.
constexpr double kMostSlope = 1.3;
// Least height of a triangle of a cover, as a share of the cover's size: rounding then matters little.
constexpr double kLeastHeight = 1.0 / 500;
// Maximum depth to which a border reaches into the hull of a cover, as a share of the cover's size. A way around the
// border is longer by a factor of less than 1 + 1e-4.
constexpr double kIntrusion = 1e-5;
// Factor on the demanded distance, for rounding and for ways around a border.
constexpr float kMargin = 1.02f;
// Patches that a thread builds at a time, and the minimum number of pairs for waking threads.
constexpr std::size_t kPatchRange = 64, kLeastPairs = 256;
constexpr std::uint32_t kNone = 0xffffffffu, kMany = 0xfffffffeu;

struct Place
{
    double x, y;
};

double across(Place a, Place b, Place c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Returns the convex hull of points, counterclockwise (Andrew's monotone chain). Sorts the points.
std::vector<Place> hullOf(std::vector<Place>& points)
{
    std::sort(points.begin(), points.end(), [](Place a, Place b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
    std::vector<Place> hull;
    for (int side = 0; side < 2; ++side)
    {
        const std::size_t first = hull.size();
        for (const Place& point : points)
        {
            while (hull.size() >= first + 2 && !(across(hull[hull.size() - 2], hull.back(), point) > 0))
                hull.pop_back();
            hull.push_back(point);
        }
        hull.pop_back();
        std::reverse(points.begin(), points.end());
    }
    return hull;
}

// Returns whether a segment has a part inside a convex hull, deeper than `depth`.
bool reachesInto(const std::vector<Place>& hull, Place a, Place b, double depth)
{
    double from = 0, to = 1;
    for (std::size_t i = 0; i < hull.size(); ++i)
    {
        const Place p = hull[i], q = hull[(i + 1) % hull.size()];
        const double length = std::hypot(q.x - p.x, q.y - p.y);
        const double start = across(p, q, a) - depth * length, end = across(p, q, b) - depth * length;
        if (start <= 0 && end <= 0) return false;
        const double meets = start / (start - end);
        if (start <= 0) from = std::max(from, meets);
        if (end <= 0) to = std::min(to, meets);
        if (from >= to) return false;
    }
    return true;
}
}  // namespace

// Input of all builders.
struct SmoothPairs::Mesh
{
    const MeshPool& m_cloths;
    const Patches& m_patches;
    const float* m_rest;
    std::vector<std::array<std::uint32_t, 2>>
        m_besides;  // by edge: its triangles, or kNone; kMany first if it has more
    std::vector<std::vector<std::uint32_t>> m_neighbours;  // by patch: patches with a common node, ascending
    std::vector<std::array<Vec3d, 2>> m_boxes;             // by patch: least and greatest corner
};

// Makes the covers of the pairs of some patches.
struct SmoothPairs::Builder
{
    explicit Builder(const Mesh& mesh) : m_mesh(mesh) {}

    void addPatch(std::uint32_t patch, float reach);
    void addRegion(std::uint32_t first, std::uint32_t last);

    SmoothPairs m_pairs;  // pairs of the builder's patches; m_first has the number of pairs of each
    const Mesh& m_mesh;
    std::vector<std::uint32_t> m_near;  // patches that are considered with a patch
    std::vector<std::uint32_t> m_triangles;
    std::vector<std::uint32_t> m_nodes;
    std::vector<Place> m_places;
    Vec3d m_axes[2], m_normal, m_origin;

    template <class Call>
    void forTriangles(std::uint32_t patch, const Call& call) const;
    void listNear(std::uint32_t patch, float reach);
    bool takePlane(const std::vector<std::uint32_t>& patches);
    Place placeOf(std::uint32_t node) const;
    std::size_t indexOf(std::uint32_t node);
    bool takeTriangle(std::uint32_t triangle, double size, std::size_t mostNodes, double* slope);
    bool findCover(const std::vector<std::uint32_t>& patches, std::size_t mostNodes, double* slope);
    bool addCover(const std::vector<std::uint32_t>& patches, std::size_t mostNodes, std::vector<Cover>& covers);
};

template <class Call>
void SmoothPairs::Builder::forTriangles(std::uint32_t patch, const Call& call) const
{
    const std::size_t width = m_mesh.m_patches.m_faceOwners.size() / m_mesh.m_patches.m_patches.size();
    for (std::size_t lane = patch * width; lane < (patch + 1) * width; ++lane)
        if (const std::uint32_t triangle = m_mesh.m_patches.m_faceOwners[lane]; triangle != DRAPE_NO_FEATURE)
            call(triangle);
}

// Lists the patch and later ones that are connected with it over patches within `reach`.
void SmoothPairs::Builder::listNear(std::uint32_t patch, float reach)
{
    const auto isNear = [&](std::uint32_t other)
    {
        const auto &a = m_mesh.m_boxes[patch], &b = m_mesh.m_boxes[other];
        const Vec3d gap = {std::max(a[0].x - b[1].x, b[0].x - a[1].x), std::max(a[0].y - b[1].y, b[0].y - a[1].y),
                           std::max(a[0].z - b[1].z, b[0].z - a[1].z)};
        return std::max(gap.x, std::max(gap.y, gap.z)) <= double(reach);
    };
    m_near.assign(1, patch);
    for (std::size_t i = 0; i < m_near.size() && m_near.size() < 2 * kMostPairs; ++i)
        for (const std::uint32_t other : m_mesh.m_neighbours[m_near[i]])
            if (std::find(m_near.begin(), m_near.end(), other) == m_near.end() && (i == 0 || isNear(other)))
                m_near.push_back(other);
    std::sort(m_near.begin(), m_near.end());
    m_near.erase(m_near.begin(), std::lower_bound(m_near.begin(), m_near.end(), patch));
    if (m_near.size() > kMostPairs) m_near.resize(kMostPairs);
}

// Takes the plane of patches: through a node, across the sum of their triangles' normals.
bool SmoothPairs::Builder::takePlane(const std::vector<std::uint32_t>& patches)
{
    Vec3d sum;
    m_origin = m_mesh.m_boxes[patches[0]][0];
    const auto add = [&](std::uint32_t triangle)
    {
        const std::uint32_t* const v = m_mesh.m_cloths.triangles()[triangle].m_vertices;
        const Vec3d a = pointAt(m_mesh.m_rest, v[0]);
        sum = sum + cross(pointAt(m_mesh.m_rest, v[1]) - a, pointAt(m_mesh.m_rest, v[2]) - a);
    };
    for (const std::uint32_t patch : patches)
        forTriangles(patch, add);
    m_normal = unit(sum);
    const Vec3d axis = std::fabs(m_normal.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    m_axes[0] = unit(cross(axis, m_normal));
    m_axes[1] = cross(m_normal, m_axes[0]);
    return dot(m_normal, m_normal) > 0;
}

Place SmoothPairs::Builder::placeOf(std::uint32_t node) const
{
    const Vec3d offset = pointAt(m_mesh.m_rest, node) - m_origin;
    return {dot(offset, m_axes[0]), dot(offset, m_axes[1])};
}

// Returns the node's index in the cover, to which it is added.
std::size_t SmoothPairs::Builder::indexOf(std::uint32_t node)
{
    const std::size_t index = std::size_t(std::find(m_nodes.begin(), m_nodes.end(), node) - m_nodes.begin());
    if (index < m_nodes.size()) return index;
    m_nodes.push_back(node);
    m_places.push_back(placeOf(node));
    return index;
}

// Adds a triangle to the cover. Returns whether it may belong to one.
bool SmoothPairs::Builder::takeTriangle(std::uint32_t triangle, double size, std::size_t mostNodes, double* slope)
{
    const std::uint32_t* const v = m_mesh.m_cloths.triangles()[triangle].m_vertices;
    const Vec3d a = pointAt(m_mesh.m_rest, v[0]), b = pointAt(m_mesh.m_rest, v[1]), c = pointAt(m_mesh.m_rest, v[2]);
    const Vec3d normal = cross(b - a, c - a);
    const double area = std::sqrt(dot(normal, normal)), flat = dot(normal, m_normal);
    const double longest2 = std::max(dot(b - a, b - a), std::max(dot(c - b, c - b), dot(a - c, a - c)));
    if (!(flat * kMostSlope >= area) || !(area >= kLeastHeight * size * std::sqrt(longest2)) || !(area > 0))
        return false;
    *slope = std::max(*slope, area / flat);
    m_triangles.push_back(triangle);
    for (int k = 0; k < 3; ++k)
        m_pairs.m_corners.push_back(std::uint16_t(indexOf(v[k])));
    return m_nodes.size() <= mostNodes;
}

// Makes the cover of patches: from a triangle of the first over all edges that reach into their hull. Returns whether
// there is one that contains all.
bool SmoothPairs::Builder::findCover(const std::vector<std::uint32_t>& patches, std::size_t mostNodes, double* slope)
{
    if (!takePlane(patches)) return false;
    std::vector<Place> points;
    std::vector<std::uint32_t> wanted;
    const auto add = [&](std::uint32_t triangle)
    {
        wanted.push_back(triangle);
        for (const std::uint32_t node : m_mesh.m_cloths.triangles()[triangle].m_vertices)
            points.push_back(placeOf(node));
    };
    for (const std::uint32_t patch : patches)
        forTriangles(patch, add);
    const std::vector<Place> hull = hullOf(points);
    double size = 0;
    for (const Place& p : hull)
        size = std::max(size, std::hypot(p.x - hull[0].x, p.y - hull[0].y));
    if (wanted.empty() || !takeTriangle(wanted[0], size, mostNodes, slope)) return false;
    for (std::size_t i = 0; i < m_triangles.size(); ++i)
    {
        const Triangle& triangle = m_mesh.m_cloths.triangles()[m_triangles[i]];
        for (std::uint32_t k = 0; k < 3; ++k)
        {
            const Place from = placeOf(triangle.m_vertices[k]), to = placeOf(triangle.m_vertices[(k + 1) % 3]);
            if (!reachesInto(hull, from, to, kIntrusion * size)) continue;
            const std::array<std::uint32_t, 2>& beside = m_mesh.m_besides[triangle.m_edges[k]];
            const std::uint32_t other = beside[0] == m_triangles[i] ? beside[1] : beside[0];
            if (beside[0] == kMany || other == kNone) return false;
            if (std::find(m_triangles.begin(), m_triangles.end(), other) != m_triangles.end()) continue;
            if (!takeTriangle(other, size, mostNodes, slope)) return false;
        }
    }
    return std::all_of(wanted.begin(), wanted.end(),
                       [&](std::uint32_t triangle)
                       { return std::find(m_triangles.begin(), m_triangles.end(), triangle) != m_triangles.end(); });
}

// Adds the cover of patches to a list. Returns whether there is one.
bool SmoothPairs::Builder::addCover(const std::vector<std::uint32_t>& patches, std::size_t mostNodes,
                                    std::vector<Cover>& covers)
{
    const std::size_t corners = m_pairs.m_corners.size();
    double slope = 1;
    m_triangles.clear();
    m_nodes.clear();
    m_places.clear();
    if (!findCover(patches, mostNodes, &slope))
    {
        m_pairs.m_corners.resize(corners);
        return false;
    }
    covers.push_back({std::uint32_t(m_pairs.m_nodes.size()), std::uint32_t(m_nodes.size()), std::uint32_t(corners / 3),
                      std::uint32_t(m_triangles.size()), float(slope)});
    m_pairs.m_nodes.insert(m_pairs.m_nodes.end(), m_nodes.begin(), m_nodes.end());
    for (const Place& place : m_places)
    {
        m_pairs.m_places.push_back(float(place.x));
        m_pairs.m_places.push_back(float(place.y));
    }
    return true;
}

void SmoothPairs::Builder::addPatch(std::uint32_t patch, float reach)
{
    const std::size_t pairs = m_pairs.m_others.size();
    listNear(patch, reach);
    for (const std::uint32_t other : m_near)
    {
        std::vector<std::uint32_t> both = {patch};
        if (other != patch) both.push_back(other);
        if (addCover(both, kMostNodes, m_pairs.m_covers)) m_pairs.m_others.push_back(other);
    }
    m_pairs.m_first.push_back(std::uint32_t(m_pairs.m_others.size() - pairs));
}

// Adds the region of the patches from first to last, whose pairs are the last that were added.
void SmoothPairs::Builder::addRegion(std::uint32_t first, std::uint32_t last)
{
    std::size_t pairs = 0;
    for (std::size_t i = m_pairs.m_first.size() - (last - first); i < m_pairs.m_first.size(); ++i)
        pairs += m_pairs.m_first[i];
    std::vector<std::uint32_t> patches(m_pairs.m_others.end() - std::ptrdiff_t(pairs), m_pairs.m_others.end());
    for (std::uint32_t patch = first; patch < last; ++patch)
        patches.push_back(patch);
    std::sort(patches.begin(), patches.end());
    patches.erase(std::unique(patches.begin(), patches.end()), patches.end());
    if (pairs == 0 || !addCover(patches, kMostRegionNodes, m_pairs.m_regions)) m_pairs.m_regions.push_back({});
}

// Notes the patch of each triangle, the triangles beside each edge, and the patches' boxes and neighbours.
SmoothPairs::Mesh SmoothPairs::readMesh(const MeshPool& cloths, const Patches& patches, const float* rest)
{
    const std::size_t count = patches.m_patches.size();
    m_patchOf.assign(cloths.triangles().size(), 0);
    Mesh mesh = {cloths, patches, rest, {}, {}, {}};
    mesh.m_besides.assign(cloths.edges().size(), {kNone, kNone});
    mesh.m_neighbours.resize(count);
    mesh.m_boxes.assign(count, {Vec3d{1e300, 1e300, 1e300}, Vec3d{-1e300, -1e300, -1e300}});
    std::vector<std::vector<std::uint32_t>> patchesOfNode(cloths.vertexCount());
    for (std::uint32_t patch = 0; patch < count; ++patch)
    {
        std::array<Vec3d, 2>& box = mesh.m_boxes[patch];
        const auto note = [&](std::uint32_t triangle)
        {
            m_patchOf[triangle] = patch;
            for (const std::uint32_t edge : cloths.triangles()[triangle].m_edges)
            {
                std::array<std::uint32_t, 2>& beside = mesh.m_besides[edge];
                const bool isFull = beside[1] != kNone;
                beside[isFull || beside[0] == kNone ? 0 : 1] = isFull ? kMany : triangle;
            }
            for (const std::uint32_t node : cloths.triangles()[triangle].m_vertices)
            {
                const Vec3d p = pointAt(rest, node);
                box[0] = {std::min(box[0].x, p.x), std::min(box[0].y, p.y), std::min(box[0].z, p.z)};
                box[1] = {std::max(box[1].x, p.x), std::max(box[1].y, p.y), std::max(box[1].z, p.z)};
                std::vector<std::uint32_t>& all = patchesOfNode[node];
                if (all.empty() || all.back() != patch) all.push_back(patch);
            }
        };
        Builder(mesh).forTriangles(patch, note);
    }
    for (const std::vector<std::uint32_t>& all : patchesOfNode)
        for (const std::uint32_t a : all)
            for (const std::uint32_t b : all)
                if (a != b) mesh.m_neighbours[a].push_back(b);
    for (std::vector<std::uint32_t>& all : mesh.m_neighbours)
    {
        std::sort(all.begin(), all.end());
        all.erase(std::unique(all.begin(), all.end()), all.end());
    }
    return mesh;
}

// Adds the pairs of later patches.
void SmoothPairs::append(const SmoothPairs& part)
{
    const auto nodes = std::uint32_t(m_nodes.size()), triangles = std::uint32_t(m_corners.size() / 3);
    for (const std::uint32_t pairs : part.m_first)
        m_first.push_back(m_first.back() + pairs);
    const auto take = [&](const std::vector<Cover>& from, std::vector<Cover>& to)
    {
        for (Cover cover : from)
        {
            cover.m_firstNode += nodes;
            cover.m_firstTriangle += triangles;
            to.push_back(cover);
        }
    };
    take(part.m_covers, m_covers);
    take(part.m_regions, m_regions);
    m_others.insert(m_others.end(), part.m_others.begin(), part.m_others.end());
    m_nodes.insert(m_nodes.end(), part.m_nodes.begin(), part.m_nodes.end());
    m_places.insert(m_places.end(), part.m_places.begin(), part.m_places.end());
    m_corners.insert(m_corners.end(), part.m_corners.begin(), part.m_corners.end());
}

void SmoothPairs::assign(const MeshPool& cloths, const Patches& patches, const float* rest, float reach,
                         ThreadTeam& threads)
{
    *this = SmoothPairs();
    const Mesh mesh = readMesh(cloths, patches, rest);
    const std::size_t count = patches.m_patches.size();
    std::vector<SmoothPairs> parts((count + kPatchRange - 1) / kPatchRange);
    const auto build = [&](std::size_t part)
    {
        Builder builder(mesh);
        const std::size_t end = std::min(count, (part + 1) * kPatchRange);
        for (std::size_t first = part * kPatchRange; first < end; first += kRegion)
        {
            const std::size_t last = std::min(end, first + kRegion);
            for (std::size_t patch = first; patch < last; ++patch)
                builder.addPatch(std::uint32_t(patch), reach);
            builder.addRegion(std::uint32_t(first), std::uint32_t(last));
        }
        parts[part] = std::move(builder.m_pairs);
    };
    threads.run(parts.size(), build);
    m_first.assign(1, 0);
    for (const SmoothPairs& part : parts)
        append(part);
    m_isSmooth.assign(m_others.size(), 0);
    allowAll();
}

namespace
{
// A cover's nodes seen along two axes at one end of the way.
struct Seen
{
    float m_x[kMostRegionNodes], m_y[kMostRegionNodes];
};

// Two sides of a triangle in a cover's plane, m, from its first corner.
struct Sides
{
    Sides(const float* places, const std::uint16_t* corners)
        : ux(places[2 * corners[1]] - places[2 * corners[0]]),
          uy(places[2 * corners[1] + 1] - places[2 * corners[0] + 1]),
          vx(places[2 * corners[2]] - places[2 * corners[0]]),
          vy(places[2 * corners[2] + 1] - places[2 * corners[0] + 1])
    {
    }
    float ux, uy, vx, vy;
};

// Computes two orthonormal axes along which a cover lies. x, y: its gradients along the axes of its plane, of any
// length. Returns false if there are no such axes.
bool takeAxes(Vec3 x, Vec3 y, Vec3 axes[2])
{
    const float lengthX = vec3Length(x), lengthY = vec3Length(y);
    if (!(lengthX > 0.0f) || !(lengthY > 0.0f)) return false;
    x = vec3Scale(x, 1.0f / lengthX);
    y = vec3Scale(y, 1.0f / lengthY);
    // Turns both directions by the same angle until they are perpendicular.
    const Vec3 sum = vec3Add(x, y), difference = vec3Sub(x, y);
    const float lengthSum = vec3Length(sum), lengthDifference = vec3Length(difference);
    if (!(lengthSum > 0.0f) || !(lengthDifference > 0.0f)) return false;
    const Vec3 between = vec3Scale(sum, 0.70710678f / lengthSum);
    const Vec3 beside = vec3Scale(difference, 0.70710678f / lengthDifference);
    axes[0] = vec3Add(between, beside);
    axes[1] = vec3Sub(between, beside);
    return true;
}
}  // namespace

bool SmoothPairs::isSmoothNow(const Cover& cover, const float* start, const float* end, float share) const
{
    const std::uint32_t* const nodes = m_nodes.data() + cover.m_firstNode;
    const float* const places = m_places.data() + 2 * std::size_t(cover.m_firstNode);
    const std::uint16_t* const corners = m_corners.data() + 3 * std::size_t(cover.m_firstTriangle);
    Vec3 offsets[2][kMostRegionNodes];
    // The axes lie along the gradient in the mean of all triangles.
    Vec3 x = vec3(0.0f, 0.0f, 0.0f), y = x, axes[2];
    for (std::uint32_t i = 0; i < cover.m_nodeCount; ++i)
    {
        offsets[0][i] = vec3Sub(vec3Load(start, nodes[i]), vec3Load(start, nodes[0]));
        offsets[1][i] = vec3Sub(vec3Load(end, nodes[i]), vec3Load(end, nodes[0]));
    }
    for (std::uint32_t t = 0; t < cover.m_triangleCount; ++t)
    {
        const std::uint16_t* const c = corners + 3 * t;
        const Sides at(places, c);
        const Vec3 p =
            vec3Add(vec3Sub(offsets[0][c[1]], offsets[0][c[0]]), vec3Sub(offsets[1][c[1]], offsets[1][c[0]]));
        const Vec3 q =
            vec3Add(vec3Sub(offsets[0][c[2]], offsets[0][c[0]]), vec3Sub(offsets[1][c[2]], offsets[1][c[0]]));
        x = vec3Add(x, vec3Sub(vec3Scale(p, at.vy), vec3Scale(q, at.uy)));
        y = vec3Add(y, vec3Sub(vec3Scale(q, at.ux), vec3Scale(p, at.vx)));
    }
    if (!takeAxes(x, y, axes)) return false;
    const float least = share * cover.m_slope * kMargin;
    Seen seen;
    bool all = true;
    for (int place = 0; place < 2 && all; ++place)
    {
        for (std::uint32_t i = 0; i < cover.m_nodeCount; ++i)
        {
            seen.m_x[i] = vec3Dot(offsets[place][i], axes[0]);
            seen.m_y[i] = vec3Dot(offsets[place][i], axes[1]);
        }
        for (std::uint32_t t = 0; t < cover.m_triangleCount; ++t)
        {
            const std::uint16_t* const c = corners + 3 * t;
            const Sides at(places, c);
            const float px = seen.m_x[c[1]] - seen.m_x[c[0]], py = seen.m_y[c[1]] - seen.m_y[c[0]];
            const float qx = seen.m_x[c[2]] - seen.m_x[c[0]], qy = seen.m_y[c[2]] - seen.m_y[c[0]];
            const float asked = least * (at.ux * at.vy - at.uy * at.vx);
            // The gradient along the axes, times the triangle's area; its symmetric part must exceed `asked`.
            const float a = px * at.vy - qx * at.uy - asked, b = qy * at.ux - py * at.vx - asked;
            const float c2 = (qx * at.ux - px * at.vx) + (py * at.vy - qy * at.uy);
            all &= (a > 0.0f) & (b > 0.0f) & (4.0f * a * b > c2 * c2);
        }
    }
    return all;
}

bool SmoothPairs::isAnyMoved(const Cover& cover, const unsigned char* isMoved) const
{
    const std::uint32_t* const first = m_nodes.data() + cover.m_firstNode;
    return !isMoved ||
           std::any_of(first, first + cover.m_nodeCount, [&](std::uint32_t node) { return isMoved[node] != 0; });
}

// Calls take(pair, isSmooth) for all pairs, but for those of which no node has moved. isSmooth(): whether the pair is.
template <class Take>
void SmoothPairs::forPairs(const float* start, const float* end, float share, const unsigned char* isMoved,
                           ThreadTeam& threads, const Take& take)
{
    const auto takeRegion = [&](std::size_t region)
    {
        const Cover& all = m_regions[region];
        const bool hasCover = all.m_triangleCount > 0;
        if (hasCover && !isAnyMoved(all, isMoved)) return;
        const bool allSmooth = hasCover && isSmoothNow(all, start, end, share);
        const std::size_t last = std::min(m_first.size() - 1, (region + 1) * kRegion);
        for (std::size_t pair = m_first[region * kRegion]; pair < m_first[last]; ++pair)
            if (isAnyMoved(m_covers[pair], isMoved))
                take(pair, [&] { return allSmooth || isSmoothNow(m_covers[pair], start, end, share); });
    };
    if (m_covers.size() >= kLeastPairs) return threads.run(m_regions.size(), takeRegion);
    for (std::size_t region = 0; region < m_regions.size(); ++region)
        takeRegion(region);
}

std::size_t SmoothPairs::check(const float* start, const float* end, float share, ThreadTeam& threads)
{
    forPairs(start, end, share, nullptr, threads,
             [&](std::size_t pair, const auto& isSmooth) { m_isSmooth[pair] = !m_isBarred[pair] && isSmooth(); });
    return std::size_t(std::count(m_isSmooth.begin(), m_isSmooth.end(), 1));
}

std::size_t SmoothPairs::recheck(const float* start, const float* end, float share, const unsigned char* isMoved,
                                 ThreadTeam& threads)
{
    m_isKept.assign(m_covers.size(), 1);
    const auto take = [&](std::size_t pair, const auto& isSmooth)
    {
        if (!m_isSmooth[pair] || isSmooth()) return;
        m_isKept[pair] = m_isSmooth[pair] = 0;
        m_isBarred[pair] = 1;
    };
    forPairs(start, end, share, isMoved, threads, take);
    return std::size_t(std::count(m_isKept.begin(), m_isKept.end(), 0));
}

std::vector<std::uint32_t> SmoothPairs::patchesOfLost() const
{
    std::vector<std::uint32_t> patches;
    for (std::uint32_t patch = 0; patch + 1 < m_first.size(); ++patch)
        if (std::count(m_isKept.begin() + m_first[patch], m_isKept.begin() + m_first[patch + 1], 0) > 0)
            patches.push_back(patch);
    return patches;
}

void SmoothPairs::allowAll()
{
    m_isBarred.assign(m_others.size(), 0);
}

bool SmoothPairs::isSmooth(std::uint32_t first, std::uint32_t second) const
{
    if (m_others.empty()) return false;
    const SmoothView all = view();
    const std::uint32_t a = m_patchOf[first], b = m_patchOf[second];
    return liesSmoothly(&all, std::min(a, b), std::max(a, b)) != 0;
}
}  // namespace drape
