#include "bullet_plugin/adapter/mirrors/mirrors.h"

#include <algorithm>
#include <utility>

#include "bullet_plugin/adapter/pairs/margins.h"
#include "bullet_plugin/adapter/vectors.h"
#include "bullet_plugin/core/scene/scene.h"

namespace drape
{
namespace
{
// Faces whose indices are compared per step. Every change by Bullet's own functions (appendFace, cutLink, refine)
// alters a count or an array and is detected at once. A face that gets other nodes in place, as from
// randomizeConstraints, is detected within faces / 32768 steps.
constexpr int kFacesPerCheck = 32768;

// Share of a mesh's size that vertices may move in a step. Farther motion counts as another pose set by the app.
constexpr float kMostMotion = 0.5f;

// Part of a plane or height field that is read, in sizes of the cloths near it, at most. More was needed before.
constexpr btScalar kWidestPart = 4;

// Steps after which an object that is put elsewhere again does not do so in step after step.
constexpr std::uint64_t kJumpGap = 8;

// Nodes that a thread checks per turn; fewer do not justify waking one.
constexpr std::size_t kNodesPerJob = 4096;

// Turns each triangle with a foreign node into one that repeats an index, which the pipeline ignores, so that the
// others keep their indices.
void ignoreForeign(std::vector<std::int32_t>& triangles)
{
    for (std::size_t i = 0; i < triangles.size(); i += 3)
        if (std::count(&triangles[i], &triangles[i] + 3, kForeign) > 0) std::fill(&triangles[i], &triangles[i] + 3, 0);
}

// Returns the sum of the boxes' diagonals, m.
btScalar sizeOf(const std::vector<SurfaceBox>& boxes)
{
    btScalar sum = 0;
    for (const SurfaceBox& box : boxes)
        sum += (box.m_high - box.m_low).length();
    return sum;
}

// Returns whether a shape that goes from one place to the other in a step was put there instead: farther than its size,
// or turned by more than a right angle.
bool isPut(const btCollisionShape& shape, const btTransform& from, const btTransform& to)
{
    btVector3 low, high;
    shape.getAabb(btTransform::getIdentity(), low, high);
    const btMatrix3x3 turn = to.getBasis() * from.getBasis().transpose();
    return (to.getOrigin() - from.getOrigin()).length() > (high - low).length() ||
           turn[0][0] + turn[1][1] + turn[2][2] < 1;
}
}  // namespace

bool ClothMirror::sameFaces(int begin, int end) const
{
    for (int f = begin; f < end; ++f)
        for (int k = 0; k < 3; ++k)
            if (nodeIndex(*m_body, m_body->m_faces[f].m_n[k]) !=
                m_faces.triangles()[static_cast<std::size_t>(3 * f + k)])
                return false;
    return true;
}

bool ClothMirror::topologyChanged()
{
    const int faces = m_body->m_faces.size();
    if (static_cast<std::size_t>(m_body->m_nodes.size()) != m_faces.nodeCount() || faces != m_faceCount) return true;
    if (m_body->m_nodes.size() == 0) return false;
    const void* const faceArray = faces > 0 ? &m_body->m_faces[0] : nullptr;
    const bool all = m_fullCheck || m_nodeArray != &m_body->m_nodes[0] || m_faceArray != faceArray;
    m_fullCheck = false;
    m_nodeArray = &m_body->m_nodes[0];
    m_faceArray = faceArray;
    if (m_links.changed(*m_body, all)) return true;
    if (all) return !sameFaces(0, faces);
    const int begin = m_cursor < faces ? m_cursor : 0;
    m_cursor = std::min(faces, begin + kFacesPerCheck);
    return !sameFaces(begin, m_cursor);
}

void ClothMirror::readTopology()
{
    const int faces = m_body->m_faces.size(), nodes = m_body->m_nodes.size();
    std::vector<std::int32_t> triangles;
    for (int f = 0; f < faces; ++f)
        for (int k = 0; k < 3; ++k)
            triangles.push_back(nodeIndex(*m_body, m_body->m_faces[f].m_n[k]));
    m_hasForeignFaces = std::count(triangles.begin(), triangles.end(), kForeign) > 0;
    m_faceCount = faces;
    m_links.read(*m_body, triangles);
    for (std::size_t i = 0; i < m_links.nodes().size(); i += 2)
        triangles.insert(triangles.end(), {m_links.nodes()[i], m_links.nodes()[i + 1], m_links.nodes()[i + 1]});
    m_faces = ClothFaces(std::move(triangles), static_cast<std::size_t>(nodes));
    cutParts();
    m_nodeArray = nodes > 0 ? &m_body->m_nodes[0] : nullptr;
    m_faceArray = faces > 0 ? &m_body->m_faces[0] : nullptr;
    m_fullCheck = false;
    m_cursor = 0;
}

// Cuts the cloth anew: the trajectory depends on the cut, so nothing of a former body at this address may remain in
// it.
void ClothMirror::cutParts()
{
    std::vector<Vec3> places;
    for (int i = 0; i < m_body->m_nodes.size(); ++i)
        places.push_back(vec3Of(m_body->m_nodes[i].m_x));
    m_parts.cut(std::move(places));
    m_takenUp = false;
}

MeshId ClothMirror::refresh(Pipeline& pipeline, const std::function<void()>& readNodes)
{
    const std::vector<std::int32_t>& triangles = m_faces.triangles();
    const bool isNew = topologyChanged() || (m_id == kNoMesh && !triangles.empty());
    if (readNodes && (isNew || m_takenUp)) readNodes();
    if (isNew)
    {
        if (m_id != kNoMesh) pipeline.remove(m_id);
        m_id = kNoMesh;
        readTopology();
        if (!triangles.empty() && m_faces.nodeCount() > 0) m_id = addCopy(pipeline);
    }
    else if (m_takenUp)
        cutParts();
    // Also after a step in which memory ran out before the order was built.
    if (m_id != kNoMesh && m_order.partsRevision() != m_parts.revision())
        m_order.build(m_parts, pipeline.scene().m_cloths.existing(m_id).m_topology);
    return m_id;
}

MeshId ClothMirror::addCopy(Pipeline& pipeline) const
{
    const std::vector<std::int32_t>& triangles = m_faces.triangles();
    std::vector<float> positions(3 * m_faces.nodeCount());
    float* out = positions.data();
    for (int i = 0; i < m_body->m_nodes.size(); ++i)
        writePosition(m_body->m_nodes[i].m_x, out);
    const std::size_t faceIndices = 3 * static_cast<std::size_t>(m_faceCount);
    std::vector<std::int32_t> known;
    if (m_hasForeignFaces)
    {
        known.assign(triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(faceIndices));
        ignoreForeign(known);
    }
    MeshDescription mesh;
    mesh.m_triangles = m_hasForeignFaces ? known.data() : triangles.data();
    mesh.m_triangleCount = faceIndices / 3;
    mesh.m_edges = m_links.nodes().data();
    mesh.m_edgeCount = m_links.nodes().size() / 2;
    mesh.m_positions = positions.data();
    mesh.m_vertexCount = m_faces.nodeCount();
    mesh.m_looseVertices = true;  // nodes of links, or left over from faces that were cut away
    return pipeline.addCloth(mesh);
}

void ClothMirror::rememberEnds(ThreadTeam& threads, btVector3 btSoftBody::Node::*where)
{
    m_ends.resize(static_cast<std::size_t>(m_body->m_nodes.size()));
    const auto remember = [this, where](std::size_t job)
    {
        for (std::size_t i = job * kNodesPerJob; i < std::min(m_ends.size(), (job + 1) * kNodesPerJob); ++i)
            m_ends[i] = m_body->m_nodes[static_cast<int>(i)].*where;
    };
    const std::size_t jobs = (m_ends.size() + kNodesPerJob - 1) / kNodesPerJob;
    runShared(threads, jobs > 1, jobs, remember);
}

void ClothMirror::listJumped(ThreadTeam& threads, std::vector<int>& nodes) const
{
    const std::size_t count = static_cast<std::size_t>(m_body->m_nodes.size());
    const bool known = m_ends.size() == count;
    std::vector<std::vector<int>> found((count + kNodesPerJob - 1) / kNodesPerJob);
    const auto compare = [&](std::size_t job)
    {
        for (std::size_t i = job * kNodesPerJob; i < std::min(count, (job + 1) * kNodesPerJob); ++i)
        {
            const btScalar* const start = m_body->m_nodes[static_cast<int>(i)].m_q.m_floats;
            if (!known || !std::equal(start, start + 3, m_ends[i].m_floats)) found[job].push_back(static_cast<int>(i));
        }
    };
    runShared(threads, found.size() > 1, found.size(), compare);
    nodes.clear();
    for (const std::vector<int>& part : found)
        nodes.insert(nodes.end(), part.begin(), part.end());
}

bool ClothMirror::movedAlong(const btTransform& map, btScalar slack) const
{
    if (m_ends.size() != static_cast<std::size_t>(m_body->m_nodes.size())) return false;
    for (std::size_t i = 0; i < m_ends.size(); ++i)
    {
        const btVector3& place = m_body->m_nodes[static_cast<int>(i)].m_x;
        const btVector3 moved = map * m_ends[i];
        if ((place - m_ends[i]).length2() > (moved - place).length2() && (moved - place).length2() <= slack * slack)
            return true;
    }
    return false;
}

void ObstacleMirror::beginStep(bool oneSided, const TriangleFilter* filter)
{
    m_wanted.clear();
    m_oneSided = oneSided;
    m_part.m_filter = filter;
}

bool ObstacleMirror::countJump(const btTransform& body, bool moves)
{
    if (m_jumpChecked == m_lastSeen) return false;  // another cloth's pair has counted it
    m_jumpChecked = m_lastSeen;
    if (moves || !m_continued || m_isTeleported || body == m_bodyEnd) return false;
    const bool isOften = jumpsOften();
    if (!isOften && m_jumpStep + kJumpGap < m_lastSeen) m_jumps = 0;
    m_jumpStep = m_lastSeen;
    if (!isOften) ++m_jumps;
    return jumpsOften() && !isOften;
}

void ObstacleMirror::place(const btTransform& place)
{
    if (m_placedStep == m_lastSeen) return;  // another cloth's pair has placed it
    const bool isKnown = m_placedStep > 0 && m_continued && !m_isTeleported;
    m_placedStep = m_lastSeen;
    if (place == m_place)
        m_placing = Placing::Stays;
    else if (isKnown && !isPut(*m_key.m_shape, m_place, place))
        m_placing = Placing::Moves;
    else
        m_placing = Placing::Jumps;
    m_isTeleported = false;
    m_placeBefore = m_place;
    m_place = place;
    m_movesInCompound = m_movesInCompound || movesPlace();
}

btTransform ObstacleMirror::startOf(const btTransform& body, const btTransform& pose, bool isDynamic) const
{
    if (m_placing == Placing::Jumps) return pose;
    if (body == m_bodyEnd && (isDynamic || movesPlace())) return m_end;
    return movesPlace() ? body * m_placeBefore : pose;
}

// Returns whether a cloth needs more of the surface than was read, or all of them much less.
bool ObstacleMirror::leavesPart() const
{
    const std::vector<SurfaceBox>& read = m_part.m_boxes;
    const auto isRead = [&](const SurfaceBox& wanted)
    { return std::any_of(read.begin(), read.end(), [&](const SurfaceBox& box) { return box.contains(wanted); }); };
    return !std::all_of(m_wanted.begin(), m_wanted.end(), isRead) || sizeOf(read) > kWidestPart * sizeOf(m_wanted);
}

// Chooses the part of the surface that the step needs. Returns whether it is another than before.
bool ObstacleMirror::readsElsewhere()
{
    if (!leavesPart()) return false;
    m_part.m_boxes = m_wanted;
    for (SurfaceBox& box : m_part.m_boxes)
        box.grow(box.slack());
    m_isTooLarge = !isSurfaceReadable(*m_key.m_shape, m_part.m_boxes);
    if (m_isTooLarge) m_part.m_boxes.clear();
    return true;
}

void ObstacleMirror::reload(Pipeline& pipeline, const btTransform& pose, bool isElsewhere)
{
    WorldMesh mesh;
    readMesh(*m_key.m_shape, pose, m_part, mesh);
    if (m_id != kNoMesh && mesh.m_topologyHash == m_topologyHash && !isElsewhere)
    {
        if (mesh.m_positionHash != m_positionHash) deform(pipeline, mesh.m_positions, pose == m_pose);
    }
    else
    {
        ++m_positionRevision;
        startAnew();
        m_before.reset();
        m_positions.clear();
        if (m_id != kNoMesh) pipeline.remove(m_id);
        m_id = kNoMesh;
        if (!mesh.m_triangles.empty())
        {
            MeshDescription description;
            description.m_triangles = mesh.m_triangles.data();
            description.m_triangleCount = mesh.m_triangles.size() / 3;
            description.m_positions = mesh.m_positions.data();
            description.m_vertexCount = mesh.m_positions.size() / 3;
            description.m_oneSided = m_oneSided;
            m_id = pipeline.addObstacle(description);
        }
    }
    m_topologyHash = mesh.m_topologyHash;
    m_positionHash = mesh.m_positionHash;
    m_names = std::move(mesh.m_names);
}

// Takes new positions; the pose is unchanged unless it came with them.
void ObstacleMirror::deform(Pipeline& pipeline, std::vector<float>& positions, bool samePlace)
{
    if (samePlace && m_before && !m_positions.empty())
        m_before->move(m_positions);
    else
        m_before = samePlace ? pipeline.makeProbe(m_id) : nullptr;
    m_mostMotion = m_before ? m_before->mostMotion(positions) : 0;
    pipeline.moveObstacle(m_id, positions.data());
    ++m_positionRevision;
    m_positions.swap(positions);
    // A change by a margin at most counts as motion even if the mesh was not checked in the step before.
    const bool isMotion = m_continued || m_mostMotion <= static_cast<float>(meshMargin(*m_key.m_shape));
    if (m_before && isMotion && m_mostMotion <= kMostMotion * m_before->size())
        m_deformedStep = m_lastSeen;
    else
        startAnew();
}

MeshProbe& ObstacleMirror::moveBefore() const
{
    m_before->move(m_positions);
    return *m_before;
}

void ObstacleMirror::drop(Pipeline& pipeline)
{
    if (m_id != kNoMesh) pipeline.remove(m_id);
    m_id = kNoMesh;
    m_read = false;
}

MeshId ObstacleMirror::refresh(Pipeline& pipeline, bool movable, const BodyMotion& motion)
{
    if (movable != m_isMovable || m_oneSided != m_heldOneSided) drop(pipeline);
    m_isMovable = movable;
    m_heldOneSided = m_oneSided;
    const btTransform pose = movable ? btTransform::getIdentity() : motion.m_end;
    const bool isElsewhere = isSurfaceShape(*m_key.m_shape) && readsElsewhere();
    // Each cloth beside the surface refreshes it, and its samples grow with the cloths.
    const bool isSampled = isSurfaceShape(*m_key.m_shape) && !isElsewhere && m_sampledStep == m_lastSeen;
    const std::uint64_t signature = isSampled ? m_signature : meshSignature(*m_key.m_shape, m_part);
    m_sampledStep = m_lastSeen;
    if (!m_read || isElsewhere || signature != m_signature || !(pose == m_pose)) reload(pipeline, pose, isElsewhere);
    m_meshShape = meshShapeOf(*m_key.m_shape);
    m_signature = signature;
    m_pose = pose;
    m_read = true;
    // Each cloth beside the obstacle refreshes it.
    const bool isKnown = motion.m_start == m_end || (motion.m_start == m_start && motion.m_end == m_end);
    if (movable && !isKnown) startAnew();
    m_start = motion.m_start;
    m_end = motion.m_end;
    if (movable) follow(pipeline, motion);
    return m_id;
}

void ObstacleMirror::follow(Pipeline& pipeline, const BodyMotion& motion)
{
    m_end = motion.m_end;
    if (m_id == kNoMesh) return;
    float start[12], end[12];
    writePose(motion.m_start, start);
    writePose(motion.m_end, end);
    pipeline.placeObstacle(m_id, start, end);
}
}  // namespace drape
