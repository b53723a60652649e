#include "patches.h"

#include <algorithm>
#include <array>

#include "kernels/lib/geometry/vec3.h"

namespace drape
{
namespace
{
void padBlock(std::vector<std::uint32_t>& owners, std::uint32_t width)
{
    while (owners.size() % width != 0)
        owners.push_back(DRAPE_NO_FEATURE);
}

constexpr std::uint32_t kNone = 0xffffffffu;

// Two triangles at each edge; kNone beside a boundary.
using EdgeTriangles = std::vector<std::array<std::uint32_t, 2>>;

EdgeTriangles trianglesOfEdges(const Topology& topology)
{
    EdgeTriangles sides(topology.m_edges.size(), {kNone, kNone});
    for (std::uint32_t i = 0; i < topology.m_triangles.size(); ++i)
    {
        for (std::uint32_t edge : topology.m_triangles[i].m_edges)
            (sides[edge][0] == kNone ? sides[edge][0] : sides[edge][1]) = i;
    }
    return sides;
}

// Triangles of the leaf order that are examined when a patch has no neighbours left.
constexpr std::size_t kAhead = 64;

Vec3 middleOf(const Triangle& triangle, const float* positions)
{
    const Vec3 sum =
        vec3Add(vec3Add(vec3Load(positions, triangle.m_vertices[0]), vec3Load(positions, triangle.m_vertices[1])),
                vec3Load(positions, triangle.m_vertices[2]));
    return vec3Scale(sum, 1.0f / 3.0f);
}

// Takes triangles one after the other. Among the neighbours of the current patch it prefers one near the patch's
// middle, and one whose neighbours are taken, so that no hole remains. Without a neighbour it takes the nearest of
// the next triangles in leaf order.
class Clustering
{
public:
    Clustering(const PooledMesh& mesh, const float* positions)
        : m_triangles(mesh.m_topology.m_triangles),
          m_order(mesh.m_order),
          m_sides(trianglesOfEdges(mesh.m_topology)),
          m_taken(m_triangles.size(), false)
    {
        m_middles.reserve(m_triangles.size());
        for (const Triangle& triangle : m_triangles)
            m_middles.push_back(middleOf(triangle, positions));
    }

    bool done() const { return m_leaf == m_order.size(); }
    void beginPatch()
    {
        m_beside.clear();
        m_inPatch = 0;
    }
    std::uint32_t next()
    {
        const std::uint32_t triangle = m_inPatch == 0     ? m_order[m_leaf]
                                       : m_beside.empty() ? nearestAhead()
                                                          : bestBeside();
        take(triangle);
        return triangle;
    }

private:
    std::uint32_t across(std::uint32_t triangle, std::uint32_t edge) const
    {
        return m_sides[edge][0] == triangle ? m_sides[edge][1] : m_sides[edge][0];
    }
    int takenNeighbours(std::uint32_t triangle) const
    {
        int count = 0;
        for (std::uint32_t edge : m_triangles[triangle].m_edges)
        {
            const std::uint32_t other = across(triangle, edge);
            count += other == kNone || m_taken[other];
        }
        return count;
    }
    // Returns the squared distance between the centres of the triangle and the patch.
    float distance(std::uint32_t triangle) const
    {
        const Vec3 offset = vec3Sub(m_middles[triangle], vec3Scale(m_sum, 1.0f / float(m_inPatch)));
        return vec3Dot(offset, offset);
    }
    std::uint32_t bestBeside()
    {
        const auto cost = [&](std::uint32_t triangle)
        {
            const int open = 4 - takenNeighbours(triangle);
            return distance(triangle) * float(open * open);
        };
        std::size_t best = 0;
        float least = cost(m_beside[0]);
        for (std::size_t i = 1; i < m_beside.size(); ++i)
        {
            const float own = cost(m_beside[i]);
            if (!(own < least)) continue;
            least = own;
            best = i;
        }
        const std::uint32_t triangle = m_beside[best];
        m_beside.erase(m_beside.begin() + std::ptrdiff_t(best));
        return triangle;
    }
    std::uint32_t nearestAhead() const
    {
        std::uint32_t nearest = m_order[m_leaf];
        for (std::size_t leaf = m_leaf + 1; leaf < std::min(m_order.size(), m_leaf + kAhead); ++leaf)
        {
            if (m_taken[m_order[leaf]]) continue;
            if (distance(m_order[leaf]) < distance(nearest)) nearest = m_order[leaf];
        }
        return nearest;
    }
    void take(std::uint32_t triangle)
    {
        m_taken[triangle] = true;
        m_sum = m_inPatch == 0 ? m_middles[triangle] : vec3Add(m_sum, m_middles[triangle]);
        ++m_inPatch;
        for (std::uint32_t edge : m_triangles[triangle].m_edges)
        {
            const std::uint32_t other = across(triangle, edge);
            if (other == kNone || m_taken[other]) continue;
            if (std::find(m_beside.begin(), m_beside.end(), other) == m_beside.end()) m_beside.push_back(other);
        }
        while (!done() && m_taken[m_order[m_leaf]])
            ++m_leaf;
    }

    const std::vector<Triangle>& m_triangles;
    const std::vector<std::uint32_t>& m_order;
    EdgeTriangles m_sides;
    std::vector<Vec3> m_middles;
    std::vector<bool> m_taken;
    std::vector<std::uint32_t> m_beside;  // free triangles beside the current patch, oldest first
    Vec3 m_sum = {0, 0, 0};               // sum of the patch's triangle centres
    std::uint32_t m_inPatch = 0;
    std::size_t m_leaf = 0;  // first of the leaf order that is not taken
};

// Joined triangles [first, last) of those of a mesh.
void appendPatch(Patches& patches, const std::vector<Triangle>& triangles, const std::uint32_t* first,
                 const std::uint32_t* last, std::uint32_t width)
{
    Patch patch = {};
    patch.m_mesh = triangles[*first].m_mesh;
    patch.m_vertexBlock = std::uint32_t(patches.m_vertexOwners.size()) / width;
    patch.m_edgeBlock = std::uint32_t(patches.m_edgeOwners.size()) / width;
    for (; first < last; ++first)
    {
        const std::uint32_t index = *first;
        const std::uint32_t owned = triangles[index].m_owned;
        patches.m_faceOwners.push_back(index);
        const std::size_t vertex = patches.m_vertexOwners.size() - std::size_t(patch.m_vertexBlock) * width;
        const std::size_t edge = patches.m_edgeOwners.size() - std::size_t(patch.m_edgeBlock) * width;
        patches.m_faceFeatures.push_back(owned | std::uint32_t(vertex) << 8 | std::uint32_t(edge) << 16);
        for (std::uint32_t corner = 0; corner < 3; ++corner)
        {
            const std::uint32_t feature = index | (corner << DRAPE_CORNER_SHIFT);
            if (owned & DRAPE_OWNS_VERTEX(corner)) patches.m_vertexOwners.push_back(feature);
            if (owned & DRAPE_OWNS_EDGE(corner)) patches.m_edgeOwners.push_back(feature);
        }
    }
    padBlock(patches.m_faceOwners, width);
    patches.m_faceFeatures.resize(patches.m_faceOwners.size(), 0);
    padBlock(patches.m_vertexOwners, width);
    padBlock(patches.m_edgeOwners, width);
    patch.m_vertexBlocks = std::uint32_t(patches.m_vertexOwners.size()) / width - patch.m_vertexBlock;
    patch.m_edgeBlocks = std::uint32_t(patches.m_edgeOwners.size()) / width - patch.m_edgeBlock;
    patches.m_patches.push_back(patch);
}

// feature(triangle, index): numbered over all meshes.
template <typename Feature>
std::vector<std::uint32_t> idsOf(const std::vector<std::uint32_t>& owners, const std::vector<Triangle>& triangles,
                                 Feature feature)
{
    std::vector<std::uint32_t> ids;
    ids.reserve(owners.size());
    for (std::uint32_t owner : owners)
        ids.push_back(owner == DRAPE_NO_FEATURE
                          ? DRAPE_NO_FEATURE
                          : feature(triangles[owner & ((1u << DRAPE_CORNER_SHIFT) - 1u)], owner >> DRAPE_CORNER_SHIFT));
    return ids;
}

template <std::size_t count, typename Feature>
std::vector<std::uint32_t> nodesOf(const std::vector<std::uint32_t>& ids, const std::vector<Feature>& features,
                                   std::uint32_t width)
{
    std::vector<std::uint32_t> nodes(count * ids.size(), DRAPE_NO_FEATURE);
    for (std::size_t i = 0; i < ids.size(); ++i)
        for (std::size_t k = 0; k < count && ids[i] != DRAPE_NO_FEATURE; ++k)
            nodes[(i / width * count + k) * width + i % width] = features[ids[i]].m_vertices[k];
    return nodes;
}
}  // namespace

std::vector<std::uint32_t> clusteredOrder(const PooledMesh& mesh, const float* positions, std::uint32_t width)
{
    std::vector<std::uint32_t> order;
    order.reserve(mesh.m_order.size());
    Clustering clustering(mesh, positions);
    while (!clustering.done())
    {
        clustering.beginPatch();
        for (std::uint32_t i = 0; i < width && !clustering.done(); ++i)
            order.push_back(clustering.next());
    }
    return order;
}

void clusterMeshes(const MeshPool& pool, std::size_t first, std::uint32_t width, std::vector<std::uint32_t>& order)
{
    order.resize(pool.begin(first).m_triangle);
    for (std::size_t slot = first; slot < pool.meshCount(); ++slot)
    {
        const PooledMesh& mesh = pool.mesh(slot);
        for (std::uint32_t own : clusteredOrder(mesh, mesh.m_positions.data(), width))
            order.push_back(own + mesh.m_firstTriangle);
    }
}

// Patches are in the order of slots.
ItemRange patchesOf(const Patches& patches, SlotRange slots)
{
    const std::vector<Patch>& all = patches.m_patches;
    const auto before = [](const Patch& patch, std::size_t slot) { return patch.m_mesh < slot; };
    const auto first = std::lower_bound(all.begin(), all.end(), slots.m_first, before);
    const auto last = std::lower_bound(first, all.end(), slots.m_last, before);
    return {std::size_t(first - all.begin()), std::size_t(last - all.begin())};
}

PatchLanes lanesOf(const Patches& patches, ItemRange range, std::uint32_t width)
{
    const Patch &front = patches.m_patches[range.m_first], &back = patches.m_patches[range.m_last - 1];
    const std::size_t lanes = width;
    return {{range.m_first * lanes, range.m_last * lanes},
            {front.m_vertexBlock * lanes, (back.m_vertexBlock + back.m_vertexBlocks) * lanes},
            {front.m_edgeBlock * lanes, (back.m_edgeBlock + back.m_edgeBlocks) * lanes}};
}

std::vector<LevelPlaces> changedPlaces(const Patches& patches, ItemRange range, bool levelsMoved, std::uint32_t width)
{
    std::vector<LevelPlaces> all;
    std::size_t children = patches.m_patches.size();
    for (std::size_t level = 0; level + 1 < patches.m_levels.size(); ++level)
    {
        const std::size_t nodes = patches.m_levels[level + 1] - patches.m_levels[level];
        if (level > 0 && levelsMoved) range = {0, children};
        if (range.m_last == children) range.m_last = nodes * width;
        all.push_back({level, children, range});
        children = nodes;
        range = {range.m_first / width, (range.m_last + width - 1) / width};
    }
    return all;
}

void keepPatches(Patches& patches, std::size_t slots, std::uint32_t width)
{
    std::vector<Patch>& all = patches.m_patches;
    const auto before = [](const Patch& patch, std::size_t slot) { return patch.m_mesh < slot; };
    all.erase(std::lower_bound(all.begin(), all.end(), slots, before), all.end());
    const Patch last = all.empty() ? Patch{} : all.back();
    patches.m_faceOwners.resize(all.size() * width);
    patches.m_faceFeatures.resize(all.size() * width);
    patches.m_vertexOwners.resize(std::size_t(last.m_vertexBlock + last.m_vertexBlocks) * width);
    patches.m_edgeOwners.resize(std::size_t(last.m_edgeBlock + last.m_edgeBlocks) * width);
}

void appendPatches(Patches& patches, const MeshPool& pool, std::size_t slot, const float* positions,
                   std::uint32_t width)
{
    const PooledMesh& mesh = pool.mesh(slot);
    std::vector<std::uint32_t> order = clusteredOrder(mesh, positions, width);
    for (std::uint32_t& triangle : order)
        triangle += mesh.m_firstTriangle;
    for (std::size_t first = 0; first < order.size(); first += width)
    {
        const std::size_t last = std::min(order.size(), first + width);
        appendPatch(patches, pool.triangles(), order.data() + first, order.data() + last, width);
    }
}

void makeLevels(Patches& patches, std::uint32_t width)
{
    std::uint32_t nodes = 0;
    patches.m_levels.clear();
    for (std::size_t count = patches.m_patches.size(); count > 0;)
    {
        count = (count + width - 1) / width;
        patches.m_levels.push_back(nodes);
        nodes += std::uint32_t(count);
        if (count == 1) break;
    }
    patches.m_levels.push_back(nodes);
}

std::vector<std::uint32_t> vertexIdsOf(const std::vector<std::uint32_t>& owners, const std::vector<Triangle>& triangles)
{
    return idsOf(owners, triangles,
                 [](const Triangle& triangle, std::uint32_t corner) { return triangle.m_vertices[corner]; });
}

std::vector<std::uint32_t> edgeIdsOf(const std::vector<std::uint32_t>& owners, const std::vector<Triangle>& triangles)
{
    return idsOf(owners, triangles,
                 [](const Triangle& triangle, std::uint32_t corner) { return triangle.m_edges[corner]; });
}

std::vector<std::uint32_t> faceNodesOf(const std::vector<std::uint32_t>& ids, const std::vector<Triangle>& triangles,
                                       std::uint32_t width)
{
    return nodesOf<3>(ids, triangles, width);
}

std::vector<std::uint32_t> edgeNodesOf(const std::vector<std::uint32_t>& ids, const std::vector<Edge>& edges,
                                       std::uint32_t width)
{
    return nodesOf<2>(ids, edges, width);
}

Patches makePatches(const MeshPool& pool, const float* positions, std::uint32_t width)
{
    Patches patches;
    for (std::size_t slot = 0; slot < pool.meshCount(); ++slot)
        appendPatches(patches, pool, slot, positions + 3 * std::size_t(pool.mesh(slot).m_firstVertex), width);
    makeLevels(patches, width);
    return patches;
}
}  // namespace drape
