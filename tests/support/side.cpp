#include "tests/support/side.h"

#include <algorithm>
#include <sstream>
#include <tuple>

#include "bullet_plugin/core/scene/morton_order.h"
#include "bullet_plugin/core/queries/refit.h"
#include "bullet_plugin/core/ordering/canonical_order.h"
#include "bullet_plugin/core/scene/normal_cones.h"
#include "kernels/lib/geometry/dop.h"

namespace drape::test
{
ClothView Side::cloth() const
{
    return clothView(m_start.data(), m_end.data(), m_pool.triangles().data(), m_pool.edges().data(),
                     std::uint32_t(m_pool.vertexCount()), std::uint32_t(m_pool.triangles().size()), DRAPE_AUTOMATIC,
                     nullptr);
}

ObstacleView Side::obstacle() const
{
    return {m_start.data(), m_pool.triangles().data(), m_vertexCones.data(), m_edgeCones.data()};
}

Side makeSide(const std::vector<TriangleMesh>& meshes, const std::vector<std::int32_t>& edges)
{
    Side side;
    for (std::size_t i = 0; i < meshes.size(); ++i)
    {
        PooledMesh mesh;
        mesh.m_id = MeshId(i);
        mesh.m_positions = meshes[i].m_positions;
        mesh.m_topology =
            buildTopology(meshes[i].m_triangles.data(), meshes[i].triangleCount(), meshes[i].vertexCount());
        if (i == 0) addEdges(mesh.m_topology, edges.data(), edges.size() / 2);
        mesh.m_order = mortonOrderOnHost(mesh.m_topology.m_triangles, mesh.m_positions.data());
        std::vector<NormalCone> vertexCones, edgeCones;
        computeNormalCones(mesh.m_topology, mesh.m_positions.data(), vertexCones, edgeCones);
        side.m_vertexCones.insert(side.m_vertexCones.end(), vertexCones.begin(), vertexCones.end());
        side.m_edgeCones.insert(side.m_edgeCones.end(), edgeCones.begin(), edgeCones.end());
        side.m_start.insert(side.m_start.end(), mesh.m_positions.begin(), mesh.m_positions.end());
        side.m_pool.add(std::move(mesh));
    }
    side.m_pool.update();
    side.m_end = side.m_start;
    side.m_order = joinedOrder(side.m_pool);
    side.m_layout = makeBvhLayout(std::uint32_t(side.m_order.size()));
    side.m_nodes = makeBvhNodes(side.m_layout);
    return side;
}

std::size_t refitSide(Side& side, const std::vector<float>& radius)
{
    std::size_t invalid = 0;
    refitOnHost(side.m_nodes, side.m_layout, side.m_order, side.m_pool.triangles(), side.m_start.data(),
                side.m_end.data(), radius, invalid);
    return invalid;
}

std::vector<Candidate> bruteForceCandidates(const Side& cloth, const Side& obstacle,
                                            const std::vector<float>& thickness)
{
    std::vector<Candidate> candidates;
    const std::vector<std::uint32_t>&clothOrder = cloth.m_order, &obstacleOrder = obstacle.m_order;
    for (std::uint32_t i = 0; i < clothOrder.size(); ++i)
    {
        const BvhNode& clothLeaf = cloth.m_nodes[i];
        const std::size_t row = cloth.m_pool.triangles()[clothOrder[i]].m_mesh * obstacle.m_pool.meshCount();
        for (std::uint32_t j = 0; j < obstacleOrder.size(); ++j)
        {
            if (thickness[row + obstacle.m_pool.triangles()[obstacleOrder[j]].m_mesh] < 0.0f) continue;
            if (nodesOverlap(&clothLeaf, &obstacle.m_nodes[j]))
                candidates.push_back(Candidate{clothOrder[i], obstacleOrder[j]});
        }
    }
    sortCandidates(candidates);
    return candidates;
}

std::vector<Candidate> allPairs(const Side& cloth, const Side& obstacle)
{
    std::vector<Candidate> pairs;
    for (std::uint32_t i = 0; i < cloth.m_pool.triangles().size(); ++i)
    {
        for (std::uint32_t j = 0; j < obstacle.m_pool.triangles().size(); ++j)
            pairs.push_back(Candidate{i, j});
    }
    return pairs;
}

std::vector<Contact> contactsOfAllPairs(const Side& cloth, const Side& obstacle, float reach, std::uint32_t mode)
{
    const std::vector<float> thickness(cloth.m_pool.meshCount() * obstacle.m_pool.meshCount(), reach);
    const PairSettings settings = {thickness, obstacle.m_pool.meshCount(), 1.0f, mode};
    std::vector<Contact> contacts;
    contactsOfPairs(allPairs(cloth, obstacle), cloth.cloth(), obstacle.obstacle(), settings, contacts);
    return contacts;
}

bool contains(const std::vector<Candidate>& sorted, std::uint32_t cloth, std::uint32_t obstacle)
{
    return std::binary_search(sorted.begin(), sorted.end(), Candidate{cloth, obstacle},
                              [](const Candidate& a, const Candidate& b)
                              { return std::tie(a.m_cloth, a.m_obstacle) < std::tie(b.m_cloth, b.m_obstacle); });
}

FeatureKey featureKey(const Contact& contact, const Side& cloth, const Side& obstacle)
{
    FeatureKey key;
    key.fill(~0u);
    key[0] = contact.m_kind;
    const auto put = [&](std::size_t at, const std::uint32_t* vertices, std::size_t count)
    {
        std::copy(vertices, vertices + count, key.begin() + std::ptrdiff_t(at));
        std::sort(key.begin() + std::ptrdiff_t(at), key.begin() + std::ptrdiff_t(at + 3));
    };
    const std::uint32_t i = contact.m_clothFeature, j = contact.m_obstacleFeature;
    if (contact.m_kind == DRAPE_NODE_FACE) put(1, &i, 1), put(4, obstacle.m_pool.triangles()[j].m_vertices, 3);
    if (contact.m_kind == DRAPE_FACE_VERTEX) put(1, cloth.m_pool.triangles()[i].m_vertices, 3), put(4, &j, 1);
    if (contact.m_kind == DRAPE_EDGE_EDGE)
    {
        put(1, cloth.m_pool.edges()[i].m_vertices, 2);
        put(4, obstacle.m_pool.edges()[j].m_vertices, 2);
    }
    return key;
}

std::string describe(const Contact& contact)
{
    static const char* const kKinds[] = {"node-face", "face-vertex", "edge-edge"};
    std::ostringstream text;
    text.precision(9);
    text << (contact.m_kind < 3 ? kKinds[contact.m_kind] : "unknown kind") << " cloth " << contact.m_clothFeature
         << " obstacle " << contact.m_obstacleFeature << " slot " << contact.m_featureIndex << " normal "
         << contact.m_normal[0] << ' ' << contact.m_normal[1] << ' ' << contact.m_normal[2] << " gaps "
         << contact.m_gap0 << ' ' << contact.m_gap1 << " time " << contact.m_time << " weights " << contact.m_weights[0]
         << ' ' << contact.m_weights[1] << ' ' << contact.m_weights[2];
    return text.str();
}

std::string difference(const std::vector<Contact>& a, const std::vector<Contact>& b)
{
    if (sameBytes(a, b)) return std::string();
    std::string text = std::to_string(a.size()) + " and " + std::to_string(b.size()) + " contacts";
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    {
        if (std::memcmp(&a[i], &b[i], sizeof(Contact)) == 0) continue;
        return text + "; number " + std::to_string(i) + ":\n" + describe(a[i]) + "\n" + describe(b[i]);
    }
    return text;
}
}  // namespace drape::test
