#include "bullet_plugin/adapter/pair_starts.h"

#include <algorithm>
#include <cstdio>
#include <string>

#include "bullet_plugin/adapter/mirrors.h"
#include "bullet_plugin/adapter/plugin_state.h"
#include "bullet_plugin/adapter/step_contact.h"
#include "kernels/lib/vec3.h"

namespace drape
{
namespace
{
// Steps after which a pair that is not seen, or an obstacle that nothing is asked of, is forgotten: as long as a mirror
// without a pair is kept.
constexpr std::uint64_t kKeepSteps = 120;

// Faces that a thread looks at in one go.
constexpr std::size_t kFacesPerJob = 512;

// Speed at which a node is pushed out, m/s: the least, and what is added for each metre of depth. Cloth moves as fast
// when it is let fall by a centimetre.
constexpr btScalar kLeastSpeed = btScalar(0.5);
constexpr btScalar kSpeedPerMetre = 2;

Vec3 vec3Of(const btVector3& v)
{
    return vec3(static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()));
}

// Calls visit(i) for every face that has three nodes of the cloth, its index.
template <class Visit>
void forWholeFaces(const ClothFaces& faces, const Visit& visit)
{
    const std::vector<std::int32_t>& triangles = faces.triangles();
    const auto isNode = [&](std::int32_t node) { return node >= 0 && std::size_t(node) < faces.nodeCount(); };
    for (std::size_t i = 0; 3 * i + 2 < triangles.size(); ++i)
        if (std::all_of(&triangles[3 * i], &triangles[3 * i] + 3, isNode)) visit(static_cast<std::uint32_t>(i));
}

// Marks every node that can be reached from the first over faces that do not meet the obstacle.
template <class Visit>
void forRegionOf(const ClothFaces& faces, std::size_t first, const std::vector<unsigned char>& faceMeets,
                 std::vector<unsigned char>& seen, const Visit& visit)
{
    std::vector<std::size_t> stack = {first};
    seen[first] = 1;
    while (!stack.empty())
    {
        const std::size_t node = stack.back();
        stack.pop_back();
        visit(node);
        const auto follow = [&](const std::int32_t* nodes)
        {
            if (faceMeets[std::size_t(nodes - faces.triangles().data()) / 3]) return;
            for (int k = 0; k < 3; ++k)
            {
                const std::size_t other = std::size_t(nodes[k]);
                if (seen[other]) continue;
                seen[other] = 1;
                stack.push_back(other);
            }
        };
        faces.forFacesOf(node, follow);
    }
}
}  // namespace

void PairStarts::beginStep()
{
    ++m_step;
    m_intersectingPairs = 0;
    m_intersections = 0;
    const auto drop = [this](auto& all)
    {
        for (auto entry = all.begin(); entry != all.end();)
            entry = entry->second.m_lastStep + kKeepSteps < m_step ? all.erase(entry) : std::next(entry);
    };
    drop(m_guards);
    drop(m_probes);
}

// Of all nodes where `nodes` is null.
void PairStarts::listFaces(const StartingPair& pair, const std::vector<int>* nodes)
{
    const ClothFaces& faces = pair.m_cloth->faces();
    m_faces.clear();
    if (!nodes) return forWholeFaces(faces, [this](std::uint32_t face) { m_faces.push_back(face); });
    for (const int node : *nodes)
        faces.forFacesOf(std::size_t(node), [&](const std::int32_t* face)
                         { m_faces.push_back(std::uint32_t(std::size_t(face - faces.triangles().data()) / 3)); });
    std::sort(m_faces.begin(), m_faces.end());
    m_faces.erase(std::unique(m_faces.begin(), m_faces.end()), m_faces.end());
}

// Where the nodes are at the step's start, in the frame of the obstacle's positions. Returns whether a triangle of the
// obstacle may come near one of the faces.
bool PairStarts::findPlaces(const StartingPair& pair, const btSoftBody& body)
{
    const btTransform toObstacle = pair.m_kinematic ? pair.m_motion.m_start.inverse() : btTransform::getIdentity();
    m_places.resize(static_cast<std::size_t>(body.m_nodes.size()));
    for (std::size_t i = 0; i < m_places.size(); ++i)
    {
        const btVector3& start = body.m_nodes[static_cast<int>(i)].m_q;
        m_places[i] = vec3Of(pair.m_kinematic ? toObstacle * start : start);
    }
    float low[3] = {SIMD_INFINITY, SIMD_INFINITY, SIMD_INFINITY}, high[3] = {-low[0], -low[1], -low[2]};
    const std::vector<std::int32_t>& triangles = pair.m_cloth->faces().triangles();
    for (const std::uint32_t face : m_faces)
    {
        for (int k = 0; k < 3; ++k)
        {
            const Vec3& place = m_places[std::size_t(triangles[3 * std::size_t(face) + std::size_t(k)])];
            if (!positionIsValid(place)) continue;
            const float coordinates[3] = {place.x, place.y, place.z};
            for (int axis = 0; axis < 3; ++axis)
            {
                low[axis] = std::min(low[axis], coordinates[axis]);
                high[axis] = std::max(high[axis], coordinates[axis]);
            }
        }
    }
    if (!(low[0] <= high[0])) return false;
    return m_probes.count(pair.m_obstacle->id()) > 0 ||
           m_state.pipeline().anyTriangleIn(pair.m_obstacle->id(), low, high);
}

MeshProbe* PairStarts::probeOf(const StartingPair& pair)
{
    Probe& probe = m_probes[pair.m_obstacle->id()];
    probe.m_lastStep = m_step;
    if (!probe.m_probe || probe.m_revision != pair.m_obstacle->positionRevision())
        probe.m_probe = m_state.pipeline().makeProbe(pair.m_obstacle->id());
    probe.m_revision = pair.m_obstacle->positionRevision();
    return probe.m_probe.get();
}

// Fills m_meeting from m_faces, in their order. Returns how many pairs of triangles meet.
std::uint64_t PairStarts::findMeeting(const StartingPair& pair, const MeshProbe& probe)
{
    const std::vector<std::int32_t>& triangles = pair.m_cloth->faces().triangles();
    std::vector<std::vector<MeetingFace>> found((m_faces.size() + kFacesPerJob - 1) / kFacesPerJob);
    const auto look = [&](std::size_t job)
    {
        MeetingFace meeting;
        for (std::size_t i = job * kFacesPerJob; i < std::min(m_faces.size(), (job + 1) * kFacesPerJob); ++i)
        {
            meeting.m_face = m_faces[i];
            const std::int32_t* const nodes = &triangles[3 * std::size_t(meeting.m_face)];
            const Vec3 corners[3] = {m_places[std::size_t(nodes[0])], m_places[std::size_t(nodes[1])],
                                     m_places[std::size_t(nodes[2])]};
            probe.listMeeting(corners, meeting.m_triangles);
            if (!meeting.m_triangles.empty()) found[job].push_back(meeting);
        }
    };
    if (found.size() > 1)
        m_state.threads().run(found.size(), look);
    else if (!found.empty())
        look(0);
    std::uint64_t count = 0;
    m_meeting.clear();
    for (std::vector<MeetingFace>& part : found)
    {
        for (MeetingFace& meeting : part)
        {
            count += meeting.m_triangles.size();
            m_meeting.push_back(std::move(meeting));
        }
    }
    return count;
}

void PairStarts::tell(const StartingPair& pair, Guard& guard, bool pushed)
{
    if (guard.m_told) return;
    guard.m_told = true;
    char line[320];
    std::snprintf(line, sizeof(line),
                  "soft body %p begins a step with %zu of its triangles through the mesh of object %p (%llu pairs of "
                  "triangles); %s",
                  static_cast<const void*>(pair.m_cloth->body()), m_meeting.size(),
                  static_cast<const void*>(pair.m_obstacle->key().m_object),
                  static_cast<unsigned long long>(guard.m_intersections),
                  pushed ? "the mesh is closed, so that the cloth is pushed out"
                         : "the mesh is open, so that nothing tells which side is right, and the cloth stays as it is");
    m_state.log(line);
}

// Fills the pair's marks of nodes: those on the wrong side, and those of m_meeting.
void PairStarts::findWrongSide(const ClothFaces& faces, const MeshProbe& probe, TangledPair& tangled)
{
    std::vector<unsigned char> faceMeets(faces.triangles().size() / 3, 0), seen(m_places.size(), 0);
    tangled.m_wrongSide.assign(m_places.size(), 0);
    tangled.m_meets.assign(m_places.size(), 0);
    for (const MeetingFace& meeting : m_meeting)
    {
        faceMeets[meeting.m_face] = 1;
        for (std::size_t k = 0; k < 3; ++k)
            tangled.m_meets[std::size_t(faces.triangles()[3 * std::size_t(meeting.m_face) + k])] = 1;
    }
    std::size_t insideCount = 0;
    for (std::size_t i = 0; i < m_places.size(); ++i)
    {
        if (seen[i]) continue;
        // A region whose faces meet nothing lies on one side.
        const bool inside = probe.isInside(m_places[i]);
        forRegionOf(faces, i, faceMeets, seen,
                    [&](std::size_t node)
                    {
                        tangled.m_wrongSide[node] = inside;
                        insideCount += inside;
                    });
    }
    m_insideIsRight = 2 * insideCount > m_places.size() && probe.volume() < 0;
    if (!m_insideIsRight) return;
    for (unsigned char& wrong : tangled.m_wrongSide)
        wrong = !wrong;
}

// way: to the place of the surface where it is to come out, in the frame of the obstacle's positions.
void PairStarts::pushNode(const StartingPair& pair, int node, Vec3 way, BodyContacts& body) const
{
    const btVector3 there(way.x, way.y, way.z);
    const btScalar depth = there.length();
    if (!(depth > 0) || !(movableInverseMass(body.m_body->m_nodes[node]) > 0)) return;
    NodePush push;
    push.m_node = node;
    push.m_normal = (pair.m_kinematic ? pair.m_motion.m_end.getBasis() * there : there).normalized();
    push.m_distance = std::min(depth + kRecoveredShare * body.m_leastThickness,
                               (kLeastSpeed + kSpeedPerMetre * depth) * body.m_body->m_sst.sdt);
    push.m_speedLimit = SIMD_INFINITY;
    push.m_carry = m_state.m_found.carryOf(pair.m_obstacle->id());
    body.m_pushes.push_back(push);
}

// Faces that the obstacle's edges and corners go through between nodes that are all on the right side.
void PairStarts::pushFaces(const StartingPair& pair, const MeshProbe& probe, BodyContacts& body)
{
    const TangledPair& tangled = body.m_tangled.back();
    const std::vector<std::int32_t>& triangles = pair.m_cloth->faces().triangles();
    for (const MeetingFace& meeting : m_meeting)
    {
        const std::int32_t* const nodes = &triangles[3 * std::size_t(meeting.m_face)];
        const auto isWrong = [&](std::int32_t node) { return tangled.m_wrongSide[std::size_t(node)] != 0; };
        if (std::any_of(nodes, nodes + 3, isWrong)) continue;
        const Vec3 corners[3] = {m_places[std::size_t(nodes[0])], m_places[std::size_t(nodes[1])],
                                 m_places[std::size_t(nodes[2])]};
        Vec3 middle;
        if (!probe.middleOfMeeting(corners, meeting.m_triangles, middle)) continue;
        if (probe.isInside(middle) == m_insideIsRight) continue;
        const Vec3 way = vec3Sub(probe.nearest(middle), middle);
        for (int k = 0; k < 3; ++k)
            pushNode(pair, nodes[k], way, body);
    }
}

void PairStarts::pushApart(const StartingPair& pair, MeshProbe& probe, BodyContacts& body)
{
    body.m_tangled.emplace_back();
    TangledPair& tangled = body.m_tangled.back();
    tangled.m_obstacle = pair.m_obstacle->id();
    findWrongSide(pair.m_cloth->faces(), probe, tangled);
    std::vector<std::size_t> wrong;
    for (std::size_t i = 0; i < m_places.size(); ++i)
        if (tangled.m_wrongSide[i]) wrong.push_back(i);
    std::vector<Vec3> ways(wrong.size());
    const auto find = [&](std::size_t i) { ways[i] = vec3Sub(probe.nearest(m_places[wrong[i]]), m_places[wrong[i]]); };
    m_state.threads().run(wrong.size(), find);
    for (std::size_t i = 0; i < wrong.size(); ++i)
        pushNode(pair, static_cast<int>(wrong[i]), ways[i], body);
    pushFaces(pair, probe, body);
}

void PairStarts::check(const StartingPair& pair, const std::vector<int>& jumped, BodyContacts& body)
{
    Guard& guard = m_guards[std::uint64_t(pair.m_cloth->id()) << 32 | pair.m_obstacle->id()];
    guard.m_lastStep = m_step;
    const bool anew = !guard.m_checked || guard.m_intersections > 0 ||
                      guard.m_clothRevision != pair.m_cloth->startRevision() ||
                      guard.m_obstacleRevision != pair.m_obstacle->startRevision();
    if (!anew && jumped.empty()) return;
    guard.m_checked = true;
    guard.m_clothRevision = pair.m_cloth->startRevision();
    guard.m_obstacleRevision = pair.m_obstacle->startRevision();
    guard.m_intersections = 0;
    listFaces(pair, anew ? nullptr : &jumped);
    if (!findPlaces(pair, *body.m_body)) return;
    MeshProbe& probe = *probeOf(pair);
    guard.m_intersections = findMeeting(pair, probe);
    if (guard.m_intersections == 0) return;
    if (!anew)
    {
        listFaces(pair, nullptr);
        guard.m_intersections = findMeeting(pair, probe);
    }
    ++m_intersectingPairs;
    m_intersections += guard.m_intersections;
    const bool pushed = probe.isClosed();
    tell(pair, guard, pushed);
    if (pushed) pushApart(pair, probe, body);
}
}  // namespace drape
