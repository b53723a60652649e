// Moves a cloth that begins a step with its triangles through a closed mesh out of the mesh.
#include <algorithm>
#include <map>
#include <utility>

#include "bullet_plugin/adapter/mirrors/mirrors.h"
#include "bullet_plugin/adapter/collision/pair_starts.h"
#include "bullet_plugin/adapter/wiring/plugin_state.h"
#include "bullet_plugin/adapter/solver/body_nodes.h"

namespace drape
{
namespace
{
// Speed at which a node is pushed out, m/s: the minimum, and the addition per metre of depth. Cloth moves as fast after
// a fall of a centimetre.
constexpr btScalar kLeastSpeed = btScalar(0.5);
constexpr btScalar kSpeedPerMetre = 2;

// Maximum steps with nodes on the wrong side before a direction other than to the nearest surface is taken.
constexpr int kMostPushedSteps = 240;

// Maximum steps in which faces may pass through an obstacle between nodes that are all on the right side, before
// another direction is taken. Parts that can come out over an edge or a corner have done so by then.
constexpr int kPassingSteps = 30;

// Maximum steps for which parts of a cloth are drawn back, and for which all of it is moved out; the second where
// nodes are pinned. Longer pushes would stretch the cloth.
constexpr int kBackSteps = 180;
constexpr int kOutSteps = 1200;
constexpr int kOutStepsOfPinned = 90;

// Steps after the last push in which links may still be stretched.
constexpr int kCalmSteps = 30;

// Rows of nodes that are drawn back at a time, and the depth, m, that determines the speed of nodes that are drawn back
// or moved out.
constexpr int kRowsDrawn = 3;
constexpr btScalar kDrawnDepth = btScalar(0.1);

// Minimum nodes for waking threads to find their nearest surface points.
constexpr std::size_t kLeastShared = 64;

// Marks every node that is connected with the first over faces that do not meet the obstacle.
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

// Fills m_regions and m_wrong from m_meeting.
void PairStarts::findRegions(const ClothFaces& faces, const MeshProbe& probe)
{
    std::vector<unsigned char> faceMeets(faces.triangles().size() / 3, 0), seen(m_places.size(), 0);
    for (const MeetingFace& meeting : m_meeting)
        faceMeets[meeting.m_face] = 1;
    m_regions.assign(m_places.size(), 0);
    m_wrong.assign(m_places.size(), 0);
    std::size_t insideCount = 0;
    for (std::size_t i = 0; i < m_places.size(); ++i)
    {
        if (seen[i]) continue;
        // A region whose faces meet nothing lies on one side.
        const bool inside = probe.isInside(m_places[i]);
        const auto mark = [&](std::size_t node)
        {
            m_regions[node] = static_cast<int>(i);
            m_wrong[node] = inside;
            insideCount += inside;
        };
        forRegionOf(faces, i, faceMeets, seen, mark);
    }
    m_insideIsRight = 2 * insideCount > m_places.size() && probe.volume() < 0;
    if (!m_insideIsRight) return;
    for (unsigned char& wrong : m_wrong)
        wrong = !wrong;
}

// displacement: to the surface point where the node comes out, in the frame of the obstacle's positions.
void PairStarts::pushNode(const StartingPair& pair, int node, Vec3 displacement, BodyContacts& body) const
{
    const btVector3 there = vectorOf(displacement);
    const btScalar depth = there.length();
    if (!(depth > 0) || !(movableInverseMass(body.m_body->m_nodes[node]) > 0)) return;
    NodePush push;
    push.m_node = node;
    push.m_normal = (pair.m_isMovable ? pair.m_motion.m_end.getBasis() * there : there).normalized();
    push.m_distance = std::min(depth + DRAPE_RECOVERED_SHARE * body.m_contacts.m_leastThickness,
                               (kLeastSpeed + kSpeedPerMetre * depth) * body.m_body->m_sst.sdt);
    push.m_speedLimit = SIMD_INFINITY;
    push.m_carry.m_map = m_state.m_found.source().mapOf(pair.m_obstacle->id());
    body.m_pushes.push_back(push);
}

// Finds faces that the obstacle's edges and corners pass through between nodes that are all on the right side.
void PairStarts::pushFaces(const StartingPair& pair, const MeshProbe& probe, BodyContacts& body)
{
    const std::vector<std::int32_t>& triangles = pair.m_cloth->faces().triangles();
    for (const MeetingFace& meeting : m_meeting)
    {
        const std::int32_t* const nodes = &triangles[3 * std::size_t(meeting.m_face)];
        const auto isWrong = [&](std::int32_t node) { return m_wrong[std::size_t(node)] != 0; };
        if (std::any_of(nodes, nodes + 3, isWrong)) continue;
        const Vec3 corners[3] = {m_places[std::size_t(nodes[0])], m_places[std::size_t(nodes[1])],
                                 m_places[std::size_t(nodes[2])]};
        Vec3 middle;
        if (!probe.middleOfMeeting(corners, meeting.m_triangles, middle)) continue;
        if (probe.isInside(middle) == m_insideIsRight) continue;
        const Vec3 displacement = vec3Sub(probe.nearest(middle), middle);
        for (int k = 0; k < (nodes[1] == nodes[2] ? 2 : 3); ++k)
            pushNode(pair, nodes[k], displacement, body);
    }
}

// Pushes the nodes on the wrong side, each to the nearest point of the surface.
void PairStarts::pushToSurface(const StartingPair& pair, const MeshProbe& probe, BodyContacts& body)
{
    std::vector<std::size_t> wrong;
    for (std::size_t i = 0; i < m_places.size(); ++i)
        if (m_wrong[i]) wrong.push_back(i);
    std::vector<Vec3> pushes(wrong.size());
    const auto find = [&](std::size_t i)
    { pushes[i] = vec3Sub(probe.nearest(m_places[wrong[i]]), m_places[wrong[i]]); };
    runShared(m_state.threads(), wrong.size() > kLeastShared, wrong.size(), find);
    for (std::size_t i = 0; i < wrong.size(); ++i)
        pushNode(pair, static_cast<int>(wrong[i]), pushes[i], body);
    pushFaces(pair, probe, body);
}

// Returns a node of the largest region on the right side with faces that meet the obstacle, and the number of such
// regions.
int PairStarts::largestPart(const TangledPair& tangled, std::size_t& count) const
{
    std::map<int, std::size_t> sizes;
    for (std::size_t i = 0; i < m_places.size(); ++i)
        if (tangled.m_meets[i] && !m_wrong[i]) sizes.emplace(m_regions[i], 0);
    for (const int region : m_regions)
    {
        const auto found = sizes.find(region);
        if (found != sizes.end()) ++found->second;
    }
    count = sizes.size();
    const auto smaller = [](const auto& a, const auto& b) { return a.second < b.second; };
    const auto largest = std::max_element(sizes.begin(), sizes.end(), smaller);
    return largest == sizes.end() ? -1 : largest->first;
}

// Collects nodes of faces that reach from the kept region into the obstacle or through it, each with its direction
// back: out of the surface on the kept side.
PairStarts::Row PairStarts::firstRow(const ClothFaces& faces, const MeshProbe& probe, int kept) const
{
    Row row;
    for (const MeetingFace& meeting : m_meeting)
    {
        const std::int32_t* const nodes = &faces.triangles()[3 * std::size_t(meeting.m_face)];
        const auto isKept = [&](std::int32_t node) { return m_regions[std::size_t(node)] == kept; };
        const std::int32_t* const from = std::find_if(nodes, nodes + 3, isKept);
        if (from == nodes + 3) continue;
        const Vec3 outward = probe.sumOfNormals(meeting.m_triangles, m_places[std::size_t(*from)]);
        for (int k = 0; k < 3; ++k)
            if (!isKept(nodes[k]))
                row.emplace(nodes[k], btVector3(0, 0, 0)).first->second += btVector3(outward.x, outward.y, outward.z);
    }
    return row;
}

// Collects the nodes beside a row that are neither kept nor drawn yet. They move in the same direction.
PairStarts::Row PairStarts::nextRow(const ClothFaces& faces, const Row& row, const Row& drawn, int kept) const
{
    Row next;
    for (const auto& entry : row)
    {
        const auto follow = [&](const std::int32_t* nodes)
        {
            for (int k = 0; k < 3; ++k)
                if (m_regions[std::size_t(nodes[k])] != kept && drawn.count(nodes[k]) == 0)
                    next.emplace(nodes[k], btVector3(0, 0, 0)).first->second += entry.second;
        };
        faces.forFacesOf(std::size_t(entry.first), follow);
    }
    return next;
}

// Draws the nodes next to the kept part through the surface, towards that part.
void PairStarts::drawBack(const StartingPair& pair, const MeshProbe& probe, int keptNode, BodyContacts& body)
{
    const ClothFaces& faces = pair.m_cloth->faces();
    const int kept = m_regions[std::size_t(keptNode)];
    Row drawn;
    Row row = firstRow(faces, probe, kept);
    for (int rows = 0; rows < kRowsDrawn && !row.empty(); ++rows)
    {
        drawn.insert(row.begin(), row.end());
        row = nextRow(faces, row, drawn, kept);
    }
    for (const auto& entry : drawn)
    {
        if (!(entry.second.length2() > 0)) continue;
        m_wrong[std::size_t(entry.first)] = 1;
        pushNode(pair, entry.first, vec3Of(entry.second.normalized() * kDrawnDepth), body);
    }
}

void PairStarts::moveOut(const StartingPair& pair, const MeshProbe& probe, Guard& guard, BodyContacts& body)
{
    if (guard.m_outSteps++ == 0) guard.m_out = probe.directionOutOfBox(m_places);
    const Vec3 step = vec3Scale(guard.m_out, static_cast<float>(kDrawnDepth));
    for (std::size_t i = 0; i < m_places.size(); ++i)
    {
        m_wrong[i] = 1;
        pushNode(pair, static_cast<int>(i), step, body);
    }
}

// Pushes in the current direction. Returns false if none is left.
bool PairStarts::push(const StartingPair& pair, const MeshProbe& probe, const TangledPair& tangled, Guard& guard,
                      BodyContacts& body)
{
    bool anyWrong = false, anyPinned = false, anyPinnedInside = false;
    for (std::size_t i = 0; i < m_wrong.size(); ++i)
    {
        const bool pinned = !(movableInverseMass(body.m_body->m_nodes[static_cast<int>(i)]) > 0);
        anyPinned = anyPinned || pinned;
        anyPinnedInside = anyPinnedInside || (m_wrong[i] && pinned);
        anyWrong = anyWrong || (m_wrong[i] && !pinned);
    }
    if (!anyWrong || ++guard.m_pushedSteps > kMostPushedSteps) ++guard.m_passingSteps;
    std::size_t parts = 0;
    const int largest = largestPart(tangled, parts);
    if (guard.m_passingSteps <= kPassingSteps)
    {
        pushToSurface(pair, probe, body);
    }
    else if (guard.m_backSteps < kBackSteps && guard.m_outSteps == 0 && parts > 1)
    {
        ++guard.m_backSteps;
        if (guard.m_keptNode < 0 || m_wrong[std::size_t(guard.m_keptNode)]) guard.m_keptNode = largest;
        drawBack(pair, probe, guard.m_keptNode, body);
    }
    else
    {
        const int most = anyPinned ? kOutStepsOfPinned : kOutSteps;
        if (guard.m_outSteps >= most || anyPinnedInside || m_insideIsRight) return false;
        moveOut(pair, probe, guard, body);
    }
    return true;
}

void PairStarts::pushApart(const StartingPair& pair, const MeshProbe& probe, Guard& guard, BodyContacts& body)
{
    TangledPair tangled;
    tangled.m_obstacle = pair.m_obstacle->id();
    tangled.m_meets.assign(m_places.size(), 0);
    const std::vector<std::int32_t>& triangles = pair.m_cloth->faces().triangles();
    for (const MeetingFace& meeting : m_meeting)
        for (std::size_t k = 0; k < 3; ++k)
            tangled.m_meets[std::size_t(triangles[3 * std::size_t(meeting.m_face) + k])] = 1;
    findRegions(pair.m_cloth->faces(), probe);
    guard.m_calmUntil = m_step + kCalmSteps;
    body.m_wasTangled = true;
    if (!push(pair, probe, tangled, guard, body)) return;
    tangled.m_wrongSide = m_wrong;
    body.m_tangled.push_back(std::move(tangled));
}

// Returns whether a cloth that is moved out, and meets nothing any more, still has nodes on the wrong side.
bool PairStarts::isInsideOnItsPath(const StartingPair& pair, const MeshProbe& probe, const Guard& guard)
{
    if (guard.m_outSteps == 0 || guard.m_outSteps >= kOutSteps) return false;
    findRegions(pair.m_cloth->faces(), probe);
    return std::find(m_wrong.begin(), m_wrong.end(), 1) != m_wrong.end();
}
}  // namespace drape
