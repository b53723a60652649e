// One side of a scene (cloths or obstacles) as the core's stages take it, built on the host without a pipeline.
//
// Input: meshes. Output: joined topology, leaf order, hierarchy, positions at the step's start and end (equal at
// first), cones. Lengths in metres.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "bullet_plugin/core/probe/bvh_layout.h"
#include "bullet_plugin/core/scene/mesh_pool.h"
#include "reference/pair_contacts.h"
#include "scenes/mesh.h"

namespace drape::test
{
struct Side
{
    MeshPool m_pool;
    std::vector<std::uint32_t> m_order;  // triangle per leaf
    BvhLayout m_layout;
    std::vector<BvhNode> m_nodes;
    std::vector<float> m_start, m_end;
    std::vector<NormalCone> m_vertexCones, m_edgeCones;

    ClothView cloth() const;
    ObstacleView obstacle() const;
};

// Ids are 0, 1, …; edges: of the first mesh, besides those of triangles (see MeshDescription).
Side makeSide(const std::vector<TriangleMesh>& meshes, const std::vector<std::int32_t>& edges = {});

// Recomputes the hierarchy's volumes; radius in m per mesh, negative to leave a mesh out. Returns the invalid vertices.
std::size_t refitSide(Side& side, const std::vector<float>& radius);

// The pairs whose leaf volumes overlap, by testing every one. thickness: m, cloth slots × obstacle slots,
// negative where the pair is not tested. Sorted.
std::vector<Candidate> bruteForceCandidates(const Side& cloth, const Side& obstacle,
                                            const std::vector<float>& thickness);

// Every pair of triangles, sorted.
std::vector<Candidate> allPairs(const Side& cloth, const Side& obstacle);

// Contacts of every pair of triangles with the reach (m), in canonical order.
std::vector<Contact> contactsOfAllPairs(const Side& cloth, const Side& obstacle, float reach,
                                        std::uint32_t mode = DRAPE_AUTOMATIC);

bool contains(const std::vector<Candidate>& sorted, std::uint32_t cloth, std::uint32_t obstacle);

// Names a contact by its kind and the vertices of its features, whatever the numbers of triangles and edges and the
// order of their corners. The key is the kind, up to three vertices of the cloth's feature, and up to three of the
// obstacle's, each sorted.
using FeatureKey = std::array<std::uint32_t, 7>;
FeatureKey featureKey(const Contact& contact, const Side& cloth, const Side& obstacle);

// All bytes equal, in number and order.
template <typename T>
bool sameBytes(const std::vector<T>& a, const std::vector<T>& b)
{
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

std::string describe(const Contact& contact);
// Sizes, and the first contact in which the two differ; empty when they do not.
std::string difference(const std::vector<Contact>& a, const std::vector<Contact>& b);
}  // namespace drape::test
