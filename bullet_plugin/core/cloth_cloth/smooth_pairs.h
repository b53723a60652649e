// Pairs of patches of cloth that lie so smoothly that no two of their features come near each other. They need no pair
// of features.
//
// Input: patches, with their nodes at rest, then in each step the nodes at its start and end. Output: the pairs that
// are smooth on the whole way between. Guarantee: any two points of a smooth pair stay at least `share` times as far
// apart as they are at rest, in a straight line.
//
// Method: a pair's cover is a set of triangles over whose plane at rest every straight line from one patch to the other
// leads. Where the cloth goes on along such a line to within an angle, the way cannot return. Let f be the position, d
// the line's direction and R two orthonormal axes. If d.R^T f'(d) >= m for all triangles of the cover, the points are
// at least m times as far apart as in the plane. This is Volino and Magnenat-Thalmann's cone of normals (1994,
// Efficient Self-Collision Detection on Smoothly Discretized Surface Animations), with the stretch included. The least
// eigenvalue of a matrix that is linear in time is concave, so start and end decide for the whole way. A region of
// patches has a cover, too, of all its pairs together. Pairs are asked one by one where that is not smooth.
//
// Cost: some microseconds a pair once, for the covers. In each step as many for a region of kRegion patches that is
// smooth, else a microsecond a pair. Host only. Lengths in metres.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bullet_plugin/core/scene/mesh_pool.h"
#include "bullet_plugin/core/scene/patches.h"
#include "bullet_plugin/core/threads/thread_team.h"
#include "kernels/lib/cloth_cloth/self_views.h"

namespace drape
{
class SmoothPairs
{
public:
    // Replaces the patches, and makes the covers of pairs that share a node or are within `reach` of each other at
    // rest. rest: x y z per joined node.
    void assign(const MeshPool& cloths, const Patches& patches, const float* rest, float reach, ThreadTeam& threads);

    // Computes which pairs are smooth between two places of the nodes, and returns how many. share: of the distance at
    // rest, above 0. Pairs that recheck() has barred count as not smooth.
    std::size_t check(const float* start, const float* end, float share, ThreadTeam& threads);
    // Bars the pairs that are smooth so far and are not with these places. Returns how many there are. isMoved: by
    // node, whether it is elsewhere than in the last check() or recheck(); null: all may be.
    std::size_t recheck(const float* start, const float* end, float share, const unsigned char* isMoved,
                        ThreadTeam& threads);
    void allowAll();

    // Returns whether two triangles belong to a pair that the last check() found smooth.
    bool isSmooth(std::uint32_t first, std::uint32_t second) const;
    SmoothView view() const { return {m_first.data(), m_others.data(), m_isSmooth.data()}; }
    // Returns the view in which only the pairs that the last recheck() barred are not smooth.
    SmoothView viewOfLost() const { return {m_first.data(), m_others.data(), m_isKept.data()}; }
    // Lists the patches with such a pair, the first of the two each.
    std::vector<std::uint32_t> patchesOfLost() const;

private:
    // Patches of a region, one after the other.
    static constexpr std::size_t kRegion = 16;

    // The cover of a pair or of a region; without triangles there is none.
    struct Cover
    {
        std::uint32_t m_firstNode, m_nodeCount;
        std::uint32_t m_firstTriangle, m_triangleCount;
        float m_slope;  // greatest ratio of a way in the cover at rest to that in the plane
    };
    struct Mesh;
    struct Builder;

    Mesh readMesh(const MeshPool& cloths, const Patches& patches, const float* rest);
    void append(const SmoothPairs& part);

    bool isAnyMoved(const Cover& cover, const unsigned char* isMoved) const;
    bool isSmoothNow(const Cover& cover, const float* start, const float* end, float share) const;
    template <class Take>
    void forPairs(const float* start, const float* end, float share, const unsigned char* isMoved, ThreadTeam& threads,
                  const Take& take);

    std::vector<std::uint32_t> m_patchOf;   // by triangle
    std::vector<std::uint32_t> m_first;     // first pair of each patch, then the number of pairs
    std::vector<std::uint32_t> m_others;    // by pair: the patch itself or a later one, ascending
    std::vector<unsigned char> m_isSmooth;  // by pair
    std::vector<unsigned char> m_isBarred;  // by pair
    std::vector<unsigned char> m_isKept;    // by pair: the last recheck() did not bar it
    std::vector<Cover> m_covers;            // by pair
    std::vector<Cover> m_regions;           // by region
    std::vector<std::uint32_t> m_nodes;     // the covers' nodes
    std::vector<float> m_places;            // two per node of m_nodes: m, in the cover's plane at rest
    std::vector<std::uint16_t> m_corners;   // three per triangle of a cover, among the cover's nodes
};
}  // namespace drape
