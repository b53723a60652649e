#include "cloth_set.h"

#include <algorithm>
#include <utility>

#include "bullet_plugin/core/backends/device_cloth_search.h"
#include "bullet_plugin/core/exact/triangles.h"
#include "bullet_plugin/core/probe/mesh_probe.h"
#include "bullet_plugin/core/threads/ranges.h"
#include "bullet_plugin/core/threads/shared_sort.h"

namespace drape
{
namespace
{
// Distance at rest between two members, as a multiple of the thickness.
constexpr float kApart = 4;
// Factor on the share of the distance at rest that contacts of neighbours reach, for rounding.
constexpr float kSmoothContactMargin = 1.01f;
// Minimum pairs of features for sharing them among threads, and those of a range.
constexpr std::size_t kLeastShared = 1 << 14, kRange = 1 << 12;
// Distance at rest, as a multiple of the thickness, up to which pairs of patches may be left out.
constexpr float kSmoothReach = 2;

// Appends a member's nodes at rest, moved beside those that are there.
void appendRest(const SetMember& member, float distance, std::vector<float>& rest)
{
    float right = 0, left = 0;
    for (std::size_t i = 0; i < rest.size(); i += 3)
        right = i == 0 ? rest[i] : std::max(right, rest[i]);
    for (std::size_t i = 0; i < 3 * member.m_nodeCount; i += 3)
        left = i == 0 ? member.m_rest[i] : std::min(left, member.m_rest[i]);
    const float shift = rest.empty() ? 0 : right + distance - left;
    for (std::size_t i = 0; i < 3 * member.m_nodeCount; ++i)
        rest.push_back(member.m_rest[i] + (i % 3 == 0 ? shift : 0));
}
// Returns whether the side of one triangle opposite to a vertex meets the other triangle.
bool sideMeets(const Triangle& one, std::uint32_t vertex, const Triangle& other, const float* positions)
{
    ExactTriangle side, face;
    int count = 0;
    for (int k = 0; k < 3; ++k)
    {
        for (int axis = 0; axis < 3; ++axis)
            face.m_p[k][axis] = positions[3 * other.m_vertices[k] + std::uint32_t(axis)];
        if (one.m_vertices[k] == vertex) continue;
        for (int axis = 0; axis < 3; ++axis)
            side.m_p[count][axis] = positions[3 * one.m_vertices[k] + std::uint32_t(axis)];
        ++count;
    }
    side.m_p[2] = side.m_p[1];
    return trianglesMeet(side, face);
}

// Returns whether two triangles that meet do so beyond a vertex that they share.
bool meetBeyond(const Triangle& first, const Triangle& second, const float* positions)
{
    int shared = 0;
    std::uint32_t vertex = 0;
    for (const std::uint32_t own : first.m_vertices)
    {
        if (std::count(second.m_vertices, second.m_vertices + 3, own) == 0) continue;
        vertex = own;
        ++shared;
    }
    if (shared != 1) return shared == 0;
    return sideMeets(first, vertex, second, positions) || sideMeets(second, vertex, first, positions);
}

// Packs what orders pairs of features. Nodes and edges are counted in 31 bits.
std::pair<std::uint64_t, std::uint32_t> keyOf(const FeatureTest& pair)
{
    return {std::uint64_t(pair.m_motion) << 32 | pair.m_cloth, pair.m_lane};
}
}  // namespace

ClothSet::ClothSet() = default;

ClothSet::~ClothSet()
{
    if (m_search) m_search->wait();
}

void ClothSet::useDevice(const SearchDevice& device)
{
    if (device.m_device.get() == (m_search ? m_search->device() : nullptr)) return;
    std::unique_ptr<DeviceClothSearch> search(device.m_device ? new DeviceClothSearch(device) : nullptr);
    if (m_search) m_search->wait();
    // Without nodes there are no members, should memory run out.
    std::vector<std::size_t> firstNodes;
    firstNodes.swap(m_firstNodes);
    if (m_scene) m_scene->m_clothNodes.release();
    m_search.swap(search);
    if (m_scene && !firstNodes.empty()) m_scene->m_clothNodes.reserve(device.m_device.get(), 3 * firstNodes.back());
    m_firstNodes.swap(firstNodes);
}

void ClothSet::assign(const std::vector<SetMember>& members, ThreadTeam& threads)
{
    m_thicknesses.clear();
    for (const SetMember& member : members)
        m_thicknesses.push_back(member.m_thickness);
    const float thickness = members.empty() ? 0 : *std::max_element(m_thicknesses.begin(), m_thicknesses.end());
    m_thickness = thickness;
    m_firstNodes.assign(1, 0);
    std::vector<std::int32_t> triangles, edges;
    std::vector<float> rest;
    for (const SetMember& member : members)
    {
        const auto first = std::int32_t(m_firstNodes.back());
        for (std::size_t i = 0; i < 3 * member.m_triangleCount; ++i)
            triangles.push_back(first + member.m_triangles[i]);
        for (std::size_t i = 0; i < 2 * member.m_edgeCount; ++i)
            edges.push_back(first + member.m_edges[i]);
        appendRest(member, kApart * thickness, rest);
        m_firstNodes.push_back(m_firstNodes.back() + member.m_nodeCount);
    }
    MeshDescription mesh;
    mesh.m_triangles = triangles.data();
    mesh.m_triangleCount = triangles.size() / 3;
    mesh.m_edges = edges.data();
    mesh.m_edgeCount = edges.size() / 2;
    mesh.m_positions = rest.data();
    mesh.m_vertexCount = nodeCount();
    mesh.m_looseVertices = true;
    mesh.m_selfThickness = thickness;
    if (m_search) m_search->wait();  // it may still read the nodes
    m_scene.reset(new Scene);
    m_scene->addCloth(mesh);
    m_scene->join(m_search ? m_search->device() : nullptr);
    if (m_search) m_search->forgetScene();
    m_patches.reset(new HostSelfPatches);
    m_patches->update(m_scene->m_cloths, m_scene->m_clothRest.data());
    m_patches->findSmoothPairs(m_scene->m_cloths, m_scene->m_clothRest.data(), kSmoothReach * thickness, threads);
}

std::size_t ClothSet::memberOf(std::size_t node) const
{
    return std::size_t(std::upper_bound(m_firstNodes.begin(), m_firstNodes.end(), node) - m_firstNodes.begin()) - 1;
}

SelfStep ClothSet::stepFor(float reach, float reachScale, bool forContacts)
{
    const MeshPool& cloths = m_scene->m_cloths;
    m_reach.m_thickness.assign(1, m_thickness);
    m_reach.m_radius.assign(1, selfGrowth(reach));
    m_noObstacles.assign(1, -1.0f);
    const ClothView view =
        clothView(start(), end(), cloths.triangles().data(), cloths.edges().data(), std::uint32_t(cloths.vertexCount()),
                  std::uint32_t(cloths.triangles().size()), kClothSearchMode, nullptr);
    const float smoothShare = forContacts ? kSmoothContactMargin * DRAPE_REST_SHARE * reachScale : kGuardedShare;
    return {cloths, selfView(view, m_scene->m_clothRest.data(), reachScale), m_reach, m_noObstacles, smoothShare};
}

bool ClothSet::listPairs(const SelfStep& step, std::uint64_t limit, ThreadTeam& threads,
                         std::vector<FeatureTest>& pairs)
{
    if (m_search)
    {
        m_search->submitPairs(*m_scene, m_reach, limit);
        m_patches->checkSmooth(step, threads);
        if (m_search->finishPairs(pairs))
        {
            dropSmooth(threads, pairs);
            return true;
        }
    }
    m_patches->cull(step, limit, threads);
    return m_patches->copyTests(limit, pairs);
}

// Drops what cull() leaves out.
void ClothSet::dropSmooth(ThreadTeam& threads, std::vector<FeatureTest>& pairs) const
{
    std::vector<unsigned char> isSmooth(pairs.size());
    const auto check = [&](std::size_t first, std::size_t last)
    {
        for (std::size_t i = first; i < last; ++i)
            isSmooth[i] = m_patches->isSmooth(pairs[i]);
    };
    forRanges(pairs.size(), kLeastShared, kRange, &threads, check);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        if (!isSmooth[i]) pairs[kept++] = pairs[i];
    pairs.resize(kept);
}

bool ClothSet::findPairs(float reach, std::uint64_t limit, ThreadTeam& threads, std::vector<FeatureTest>& pairs)
{
    const bool isWhole = listPairs(stepFor(reach, 1.0f, false), limit, threads, pairs);
    m_smoothPairs = m_patches->counts().m_smoothPairs;
    if (!isWhole) return false;
    sharedSort(pairs, threads, isBefore);
    return true;
}

bool ClothSet::isBefore(const FeatureTest& first, const FeatureTest& second)
{
    return keyOf(first) < keyOf(second);
}

std::size_t ClothSet::findLost(const std::vector<unsigned char>& isMoved, ThreadTeam& threads)
{
    return m_patches->findLost(stepFor(0, 1.0f, false), isMoved.data(), threads);
}

bool ClothSet::listLost(float reach, std::uint64_t limit, ThreadTeam& threads, std::vector<FeatureTest>& pairs)
{
    m_patches->cullLost(stepFor(reach, 1.0f, false), limit, threads);
    if (!m_patches->copyTests(limit, pairs)) return false;
    sharedSort(pairs, threads, isBefore);
    return true;
}

void ClothSet::allowSmooth()
{
    m_patches->smoothPairs().allowAll();
}

int ClothSet::nodesOf(const FeatureTest& pair, std::uint32_t nodes[4]) const
{
    const MeshPool& cloths = m_scene->m_cloths;
    if (pair.m_motion == DRAPE_SELF_TEST_NODE)
    {
        nodes[0] = pair.m_cloth;
        std::copy_n(cloths.triangles()[pair.m_lane].m_vertices, 3, nodes + 1);
        return 1;
    }
    std::copy_n(cloths.edges()[pair.m_cloth].m_vertices, 2, nodes);
    std::copy_n(cloths.edges()[pair.m_lane].m_vertices, 2, nodes + 2);
    return 2;
}

float ClothSet::restDistance(const FeatureTest& pair) const
{
    const MeshPool& cloths = m_scene->m_cloths;
    const float* const rest = m_scene->m_clothRest.data();
    if (pair.m_motion == DRAPE_SELF_TEST_NODE)
        return restDistanceOfNode(rest, pair.m_cloth, cloths.triangles()[pair.m_lane].m_vertices);
    return restDistanceOfEdges(rest, cloths.edges()[pair.m_cloth].m_vertices, cloths.edges()[pair.m_lane].m_vertices);
}

void ClothSet::findMeeting(ThreadTeam& threads, std::vector<std::uint32_t>& nodes)
{
    const std::vector<Triangle>& triangles = m_scene->m_cloths.triangles();
    nodes.clear();
    const PooledMesh& mesh = m_scene->m_cloths.mesh(0);
    const MeshProbe probe(mesh.m_topology, mesh.m_order, {start(), start() + 3 * nodeCount()});
    SmoothPairs& smooth = m_patches->smoothPairs();
    smooth.check(start(), start(), kGuardedShare, threads);
    std::vector<std::uint32_t> others;
    for (std::uint32_t first = 0; first < triangles.size(); ++first)
    {
        Vec3 corners[3];
        for (int k = 0; k < 3; ++k)
            corners[k] = vec3Load(start(), triangles[first].m_vertices[k]);
        probe.listMeeting(corners, others,
                          [&](std::uint32_t second) { return second > first && !smooth.isSmooth(first, second); });
        for (const std::uint32_t second : others)
        {
            if (!meetBeyond(triangles[first], triangles[second], start())) continue;
            nodes.insert(nodes.end(), triangles[first].m_vertices, triangles[first].m_vertices + 3);
            nodes.insert(nodes.end(), triangles[second].m_vertices, triangles[second].m_vertices + 3);
        }
    }
}

bool ClothSet::findContacts(float reachScale, std::uint64_t mostPairs, std::uint64_t most, ThreadTeam& threads,
                            std::vector<Contact>& contacts)
{
    const SelfStep step = stepFor(m_thickness * reachScale, reachScale, true);
    m_smoothPairs = 0;
    if (m_search && m_search->findContacts(*m_scene, m_reach, reachScale, mostPairs, most, contacts)) return true;
    m_patches->cull(step, mostPairs, threads);
    m_smoothPairs = m_patches->counts().m_smoothPairs;
    contacts.clear();
    m_patches->findContacts(step, {mostPairs, most}, threads, contacts);
    return m_patches->counts().m_candidates <= mostPairs && m_patches->counts().m_contacts <= most;
}
}  // namespace drape
