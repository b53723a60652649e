#include "bullet_plugin/adapter/collision/pair_starts.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "bullet_plugin/adapter/mirrors/mirrors.h"
#include "bullet_plugin/adapter/pairs/margins.h"
#include "bullet_plugin/adapter/solver/body_nodes.h"
#include "bullet_plugin/adapter/wiring/plugin_state.h"
#include "kernels/lib/geometry/vec3.h"

namespace drape
{
namespace
{
// Steps after which an absent pair, or an obstacle without queries, is forgotten: as long as a mirror without a pair
// is kept.
constexpr std::uint64_t kKeepSteps = 120;

// Passes over all of an obstacle's triangles for one pair, before its tree is built for the queries that follow.
constexpr int kMostPasses = 8;

// Faces that a thread processes per turn.
constexpr std::size_t kFacesPerJob = 512;

// Calls visit(i) for the index of every face with three nodes of the cloth.
template <class Visit>
void forWholeFaces(const ClothFaces& faces, const Visit& visit)
{
    const std::vector<std::int32_t>& triangles = faces.triangles();
    const auto isNode = [&](std::int32_t node) { return node >= 0 && std::size_t(node) < faces.nodeCount(); };
    for (std::size_t i = 0; 3 * i + 2 < triangles.size(); ++i)
        if (std::all_of(&triangles[3 * i], &triangles[3 * i] + 3, isNode)) visit(static_cast<std::uint32_t>(i));
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

// Lists the faces of the given nodes, or all faces if `nodes` is null.
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

// Computes the nodes' positions at one end of the step in the frame of the obstacle's positions: of all nodes, or of
// those in m_faces.
void PairStarts::findPlaces(const StartingPair& pair, bool all, PathEnd end)
{
    const btSoftBody& body = *pair.m_cloth->body();
    const bool atStart = end == PathEnd::Start;
    const btTransform toObstacle = (atStart ? pair.m_motion.m_start : pair.m_motion.m_end).inverse();
    m_places.resize(static_cast<std::size_t>(body.m_nodes.size()));
    const auto find = [&](std::size_t node)
    {
        const btSoftBody::Node& at = body.m_nodes[static_cast<int>(node)];
        const btVector3& place = atStart ? at.m_q : at.m_x;
        m_places[node] = vec3Of(pair.m_isMovable ? toObstacle * place : place);
    };
    for (std::size_t node = 0; all && node < m_places.size(); ++node)
        find(node);
    if (all) return;
    const std::vector<std::int32_t>& triangles = pair.m_cloth->faces().triangles();
    for (const std::uint32_t face : m_faces)
        for (std::size_t k = 0; k < 3; ++k)
            find(std::size_t(triangles[3 * std::size_t(face) + k]));
}

// Returns whether a triangle of the obstacle may come near one of the faces.
bool PairStarts::mayMeet(const StartingPair& pair, Guard& guard)
{
    constexpr float infinity = std::numeric_limits<float>::infinity();
    float low[3] = {infinity, infinity, infinity}, high[3] = {-infinity, -infinity, -infinity};
    const std::vector<std::int32_t>& triangles = pair.m_cloth->faces().triangles();
    for (const std::uint32_t face : m_faces)
    {
        for (std::size_t k = 0; k < 3; ++k)
        {
            const Vec3& place = m_places[std::size_t(triangles[3 * std::size_t(face) + k])];
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
    // Builds the obstacle's tree for a pair that is checked repeatedly because an app moves nodes.
    if (pair.m_obstacle->before() || m_probes.count(pair.m_obstacle->id()) > 0 || guard.m_passes >= kMostPasses)
        return true;
    ++guard.m_passes;
    return m_state.pipeline().anyTriangleIn(pair.m_obstacle->id(), low, high);
}

MeshProbe* PairStarts::probeOf(const StartingPair& pair)
{
    if (MeshProbe* before = pair.m_obstacle->before()) return before;  // the pipeline has it as it is at the end
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
    runShared(m_state.threads(), found.size() > 1, found.size(), look);
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

// Lists the pairs of triangles in m_meeting for Plugin::flaggedPairs().
void PairStarts::flag(const StartingPair& pair, const MeshProbe& probe)
{
    const std::vector<std::int32_t>& triangles = pair.m_cloth->faces().triangles();
    const ObstacleKey& obstacle = pair.m_obstacle->key();
    FlaggedPair flagged = {};
    flagged.m_flag = PairFlag::StartsIntersecting;
    flagged.m_body = pair.m_cloth->body();
    flagged.m_object = obstacle.m_object;
    flagged.m_shape = obstacle.m_shape;
    std::fill_n(flagged.m_otherNodes, 3, -1);
    for (const MeetingFace& meeting : m_meeting)
    {
        std::copy_n(&triangles[3 * std::size_t(meeting.m_face)], 3, flagged.m_nodes);
        if (flagged.m_nodes[2] == flagged.m_nodes[1]) flagged.m_nodes[2] = -1;  // a solid link
        for (const std::uint32_t triangle : meeting.m_triangles)
        {
            const std::int32_t source = m_state.pipeline().sourceTriangle(pair.m_obstacle->id(), triangle);
            const TriangleName name = source < 0 ? TriangleName{-1, -1} : pair.m_obstacle->nameOf(std::size_t(source));
            flagged.m_part = name.m_part;
            flagged.m_triangle = name.m_triangle;
            for (int k = 0; k < 3; ++k)
            {
                const btVector3 own = vectorOf(probe.corner(triangle, k));
                float* corner = flagged.m_corners[k];
                writePosition(pair.m_isMovable ? pair.m_motion.m_start * own : own, corner);
            }
            m_state.m_flagged.push_back(flagged);
        }
    }
}

void PairStarts::tellMargins(const StartingPair& pair) const
{
    const btSoftBody& cloth = *pair.m_cloth->body();
    const ObstacleKey& obstacle = pair.m_obstacle->key();
    const std::string remark = marginRemark(cloth, *obstacle.m_shape);
    if (remark.empty()) return;
    m_state.log(m_state.namesOf(cloth, *obstacle.m_object) + ": " + remark);
}

void PairStarts::tell(const StartingPair& pair, Guard& guard, bool pushed)
{
    if (guard.m_told) return;
    guard.m_told = true;
    m_state.log(m_state.nameOf(*pair.m_cloth->body()) + " begins a step with " + std::to_string(m_meeting.size()) +
                " of its faces and links through the mesh of " + m_state.nameOf(*pair.m_obstacle->key().m_object) +
                " (" + std::to_string(guard.m_intersections) + " pairs with its triangles); " +
                (pushed ? "the mesh is closed, so that the cloth is pushed out"
                        : "the mesh is open, so that the right side is unknown, and the cloth stays as it is"));
}

// A pair that was absent may have got into each other: its boxes were apart, or one was not in the world.
bool PairStarts::startsAnew(const StartingPair& pair, const Guard& guard) const
{
    return !guard.m_checked || guard.m_lastStep + 1 < m_step || guard.m_intersections > 0 || guard.m_outSteps > 0 ||
           guard.m_clothRevision != pair.m_cloth->startRevision() ||
           guard.m_obstacleRevision != pair.m_obstacle->startRevision();
}

bool PairStarts::startsAnew(const StartingPair& pair) const
{
    const auto guard = m_guards.find(std::uint64_t(pair.m_cloth->id()) << 32 | pair.m_obstacle->id());
    return guard == m_guards.end() || startsAnew(pair, guard->second);
}

bool PairStarts::endsMeeting(const StartingPair& pair)
{
    const auto guard = m_guards.find(std::uint64_t(pair.m_cloth->id()) << 32 | pair.m_obstacle->id());
    if (guard == m_guards.end() || guard->second.m_intersections > 0) return false;
    listFaces(pair, nullptr);
    const std::vector<std::int32_t>& triangles = pair.m_cloth->faces().triangles();
    const auto isHeld = [&](std::uint32_t face)
    {
        const std::int32_t* const nodes = &triangles[3 * std::size_t(face)];
        return std::any_of(nodes, nodes + 3,
                           [&](std::int32_t node)
                           { return !(movableInverseMass(pair.m_cloth->body()->m_nodes[node]) > 0); });
    };
    m_faces.erase(std::remove_if(m_faces.begin(), m_faces.end(), isHeld), m_faces.end());
    findPlaces(pair, true, PathEnd::End);
    return findMeeting(pair, pair.m_obstacle->before() ? pair.m_obstacle->moveBefore() : *probeOf(pair)) > 0;
}

void PairStarts::check(const StartingPair& pair, const std::vector<int>& jumped, BodyContacts& body)
{
    Guard& guard = m_guards[std::uint64_t(pair.m_cloth->id()) << 32 | pair.m_obstacle->id()];
    body.m_wasTangled = body.m_wasTangled || m_step < guard.m_calmUntil;
    const bool anew = startsAnew(pair, guard);
    guard.m_lastStep = m_step;
    if (!anew && jumped.empty()) return;
    if (!guard.m_checked) tellMargins(pair);
    guard.m_checked = true;
    guard.m_clothRevision = pair.m_cloth->startRevision();
    guard.m_obstacleRevision = pair.m_obstacle->startRevision();
    guard.m_intersections = 0;
    listFaces(pair, anew ? nullptr : &jumped);
    findPlaces(pair, anew);
    if (!mayMeet(pair, guard)) return;
    MeshProbe& probe = *probeOf(pair);
    guard.m_intersections = findMeeting(pair, probe);
    if (guard.m_intersections == 0 && !isInsideOnItsPath(pair, probe, guard))
    {
        guard.m_pushedSteps = guard.m_passingSteps = guard.m_backSteps = guard.m_outSteps = 0;
        guard.m_keptNode = -1;
        return;
    }
    if (!anew)
    {
        listFaces(pair, nullptr);
        findPlaces(pair, true);
        guard.m_intersections = findMeeting(pair, probe);
    }
    ++m_intersectingPairs;
    m_intersections += guard.m_intersections;
    flag(pair, probe);
    const bool pushed = probe.isClosed();
    tell(pair, guard, pushed);
    if (pushed) pushApart(pair, probe, guard, body);
}
}  // namespace drape
