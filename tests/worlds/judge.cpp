#include "tests/worlds/judge.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "oracle/exact_predicates.h"

namespace drape::test
{
namespace
{
constexpr std::uint64_t kOffsetSeed = 77;
constexpr double kOffset = 1e-7;  // m, far below every thickness

Vector3 vectorOf(const btVector3& p)
{
    return {p.x(), p.y(), p.z()};
}

bool isFinite(const Vector3& p)
{
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

std::vector<btVector3> positionsOf(const btSoftBody& body)
{
    std::vector<btVector3> positions;
    for (int i = 0; i < body.m_nodes.size(); ++i)
        positions.push_back(body.m_nodes[i].m_x);
    return positions;
}

// Inverts a pose whose basis is a rotation up to rounding: solves by Cramer's rule in double.
class InversePose
{
public:
    explicit InversePose(const btTransform& pose)
        : m_origin{pose.getOrigin().x(), pose.getOrigin().y(), pose.getOrigin().z()}
    {
        Vector3 columns[3];
        for (int i = 0; i < 3; ++i)
        {
            const btVector3 column = pose.getBasis().getColumn(i);
            columns[i] = {column.x(), column.y(), column.z()};
        }
        const double determinant = dot(columns[0], cross(columns[1], columns[2]));
        for (int i = 0; i < 3; ++i)
            m_rows[i] = (1 / determinant) * cross(columns[(i + 1) % 3], columns[(i + 2) % 3]);
    }

    Vector3 operator*(const Vector3& point) const
    {
        const Vector3 d = point - m_origin;
        return {dot(m_rows[0], d), dot(m_rows[1], d), dot(m_rows[2], d)};
    }

private:
    Vector3 m_rows[3], m_origin;
};

// Returns the positions in the frame of a mesh with the pose.
std::vector<Vector3> placesIn(const btTransform& pose, const std::vector<btVector3>& positions)
{
    const InversePose inverse(pose);
    std::vector<Vector3> places;
    for (const btVector3& position : positions)
        places.push_back(inverse * vectorOf(position));
    return places;
}

struct Box
{
    Vector3 m_low, m_high;

    explicit Box(const Vector3& p) : m_low(p), m_high(p) {}
    void add(const Vector3& p)
    {
        m_low = {std::min(m_low.x, p.x), std::min(m_low.y, p.y), std::min(m_low.z, p.z)};
        m_high = {std::max(m_high.x, p.x), std::max(m_high.y, p.y), std::max(m_high.z, p.z)};
    }
};

// Returns whether the triangle is wound clockwise where one looks at it from above.
bool facesDown(const std::vector<float>& positions, const std::int32_t* triangle)
{
    const float* corners[3];
    for (int k = 0; k < 3; ++k)
        corners[k] = &positions[3 * static_cast<std::size_t>(triangle[k])];
    const auto alongZ = [&](int k) { return double(corners[k][2]) - corners[0][2]; };
    const auto alongX = [&](int k) { return double(corners[k][0]) - corners[0][0]; };
    return alongZ(1) * alongX(2) < alongZ(2) * alongX(1);
}

// Returns +1 or -1 if the path crosses the triangle, by the side that it comes from, and 0 if it does not, or only
// touches.
int passes(const Vector3& from, const Vector3& to, const Vector3 triangle[3])
{
    const int before = orientation(triangle[0], triangle[1], triangle[2], from);
    const int after = orientation(triangle[0], triangle[1], triangle[2], to);
    if (before * after >= 0) return 0;
    const int side = orientation(from, to, triangle[0], triangle[1]);
    if (side == 0 || orientation(from, to, triangle[1], triangle[2]) != side ||
        orientation(from, to, triangle[2], triangle[0]) != side)
        return 0;
    return before;
}
}  // namespace

Judge::Judge(const World& world)
{
    for (const auto& obstacle : world.obstacles())
    {
        m_obstacles.push_back({obstacle.get(), obstacle->scaling(), nullptr, obstacle->m_object->getWorldTransform()});
        readSurface(m_obstacles.back());
    }
    for (const auto& owned : world.cloths())
    {
        Cloth cloth;
        cloth.m_body = owned->m_body.get();
        WorldRandom random(kOffsetSeed);
        for (int i = 0; i < cloth.m_body->m_nodes.size(); ++i)
        {
            Vector3 offset;
            offset.x = random.within(-kOffset, kOffset);
            offset.y = random.within(-kOffset, kOffset);
            offset.z = random.within(-kOffset, kOffset);
            cloth.m_offsets.push_back(offset);
        }
        cloth.m_held.resize(cloth.m_offsets.size(), false);
        cloth.m_valid.resize(cloth.m_offsets.size(), true);
        cloth.m_hasFace.resize(cloth.m_offsets.size(), false);
        for (int f = 0; f < cloth.m_body->m_faces.size(); ++f)
            for (const btSoftBody::Node* node : cloth.m_body->m_faces[f].m_n)
                cloth.m_hasFace[static_cast<std::size_t>(node - &cloth.m_body->m_nodes[0])] = true;
        cloth.m_follows.resize(m_obstacles.size());
        m_cloths.push_back(std::move(cloth));
    }
}

void Judge::markHeld(Cloth& cloth)
{
    for (std::size_t i = 0; i < cloth.m_held.size(); ++i)
    {
        const btSoftBody::Node& node = cloth.m_body->m_nodes[static_cast<int>(i)];
        if (!(node.m_im > 0) || node.m_battach) cloth.m_held[i] = true;
    }
}

void Judge::markValid(Cloth& cloth)
{
    for (std::size_t i = 0; i < cloth.m_valid.size(); ++i)
        cloth.m_valid[i] = isFinite(vectorOf(cloth.m_body->m_nodes[static_cast<int>(i)].m_x));
}

void Judge::noteBetween(bool reported)
{
    m_betweenReported.push_back(reported);
    for (Cloth& cloth : m_cloths)
        cloth.m_between.push_back(positionsOf(*cloth.m_body));
}

// Follows the nodes through the noted steps. An obstacle's motion is shared evenly by the steps of a call
// (docs/guarantees.md); other changes come before the first one.
void Judge::followBetween(Cloth& cloth, std::size_t obstacle)
{
    const btTransform& from = m_obstacles[obstacle].m_pose;
    const btTransform& to = m_obstacles[obstacle].m_obstacle->m_object->getWorldTransform();
    const std::size_t count = cloth.m_between.size();
    for (std::size_t i = 0; i < count; ++i)
    {
        const btScalar share = btScalar(i + 1) / btScalar(count + 1);
        const btTransform pose(from.getRotation().slerp(to.getRotation(), share),
                               from.getOrigin().lerp(to.getOrigin(), share));
        const btTransform meshPose = (from == to ? to : pose) * m_obstacles[obstacle].m_obstacle->m_inObject;
        follow(cloth, obstacle, placesIn(meshPose, cloth.m_between[i]), m_betweenReported[i]);
    }
}

void Judge::readSurface(Obstacle& obstacle)
{
    const TriangleMesh& mesh = obstacle.m_obstacle->m_mesh;
    obstacle.m_scaling = obstacle.m_obstacle->scaling();
    std::vector<float> positions = mesh.m_positions;
    for (std::size_t i = 0; i < positions.size(); ++i)
        positions[i] *= static_cast<float>(obstacle.m_scaling[static_cast<int>(i % 3)]);
    std::vector<std::int32_t> triangles;  // leaves out triangles that name a vertex twice: they have no surface
    for (std::size_t i = 0; i < mesh.m_triangles.size(); i += 3)
    {
        const std::int32_t* t = &mesh.m_triangles[i];
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
        const bool turns = obstacle.m_obstacle->m_frontsUp && facesDown(positions, t);
        triangles.insert(triangles.end(), {t[0], t[turns ? 2 : 1], t[turns ? 1 : 2]});
    }
    obstacle.m_surface =
        std::make_unique<TriangleTree>(positions.data(), mesh.vertexCount(), triangles.data(), triangles.size() / 3);
}

Findings Judge::look(bool reported)
{
    Findings findings;
    for (Obstacle& obstacle : m_obstacles)
        if (!(obstacle.m_scaling == obstacle.m_obstacle->scaling())) readSurface(obstacle);
    for (Cloth& cloth : m_cloths)
    {
        markHeld(cloth);
        markValid(cloth);
        const std::size_t count = cloth.m_held.size();
        findings.m_invalidNodes += int(std::count(cloth.m_valid.begin(), cloth.m_valid.end(), false));
        std::vector<bool> through(count, false);
        for (std::size_t o = 0; o < m_obstacles.size(); ++o)
        {
            const WorldObstacle& obstacle = *m_obstacles[o].m_obstacle;
            const std::vector<Vector3> places =
                placesIn(obstacle.m_object->getWorldTransform() * obstacle.m_inObject, positionsOf(*cloth.m_body));
            followBetween(cloth, o);
            countPairs(cloth, m_obstacles[o], places, findings);
            follow(cloth, o, places, reported);
            forgetWaysAroundRims(cloth, cloth.m_follows[o]);
            for (std::size_t i = 0; i < count; ++i)
                if (cloth.m_follows[o].m_passes[i] != 0) through[i] = true;
        }
        for (std::size_t i = 0; i < count; ++i)
            if (through[i]) ++(cloth.m_held[i] ? findings.m_heldThrough : findings.m_through);
        cloth.m_between.clear();
    }
    m_betweenReported.clear();
    for (Obstacle& obstacle : m_obstacles)
        obstacle.m_pose = obstacle.m_obstacle->m_object->getWorldTransform();
    return findings;
}

void Judge::countPairs(const Cloth& cloth, const Obstacle& obstacle, const std::vector<Vector3>& places,
                       Findings& findings) const
{
    const btSoftBody& body = *cloth.m_body;
    for (int f = 0; f < body.m_faces.size(); ++f)
        countPairsOf(body.m_faces[f].m_n, cloth, obstacle, places, findings);
    for (int i = 0; i < body.m_links.size(); ++i)
    {
        const btSoftBody::Link& link = body.m_links[i];
        const btSoftBody::Node* const nodes[3] = {link.m_n[0], link.m_n[1], link.m_n[1]};
        const auto hasFace = [&](int k)
        { return cloth.m_hasFace[static_cast<std::size_t>(nodes[k] - &body.m_nodes[0])]; };
        if (!link.m_bbending && !(hasFace(0) && hasFace(1))) countPairsOf(nodes, cloth, obstacle, places, findings);
    }
}

void Judge::countPairsOf(const btSoftBody::Node* const nodes[3], const Cloth& cloth, const Obstacle& obstacle,
                         const std::vector<Vector3>& places, Findings& findings) const
{
    Vector3 face[3];
    bool valid = true, held = false;
    for (int k = 0; k < 3; ++k)
    {
        const std::size_t node = static_cast<std::size_t>(nodes[k] - &cloth.m_body->m_nodes[0]);
        valid = valid && cloth.m_valid[node];
        held = held || cloth.m_held[node];
        face[k] = places[node];
    }
    if (!valid) return;
    Box box(face[0]);
    box.add(face[1]);
    box.add(face[2]);
    obstacle.m_surface->visitBox(box.m_low, box.m_high,
                                 [&](std::int32_t triangle)
                                 {
                                     Vector3 corners[3];
                                     obstacle.m_surface->corners(triangle, corners);
                                     if (trianglesIntersect(face, corners))
                                         ++(held ? findings.m_heldPairs : findings.m_pairs);
                                 });
}

void Judge::follow(Cloth& cloth, std::size_t obstacle, const std::vector<Vector3>& places, bool reported)
{
    Follow& follow = cloth.m_follows[obstacle];
    const TriangleTree& surface = *m_obstacles[obstacle].m_surface;
    std::vector<Vector3> now(places.size());
    for (std::size_t i = 0; i < places.size(); ++i)
        now[i] = places[i] + cloth.m_offsets[i];
    follow.m_passes.resize(places.size(), 0);
    follow.m_repeats.assign(places.size(), false);
    for (std::size_t i = 0; i < follow.m_last.size() && !reported; ++i)
    {
        const Vector3 from = follow.m_last[i], to = now[i];
        if (!isFinite(to) || !isFinite(from)) continue;
        Box box(from);
        box.add(to);
        int meetings = 0;
        surface.visitBox(box.m_low, box.m_high,
                         [&](std::int32_t triangle)
                         {
                             Vector3 corners[3];
                             surface.corners(triangle, corners);
                             const int pass = passes(from, to, corners);
                             follow.m_passes[i] += pass;
                             meetings += pass != 0 ? 1 : 0;
                         });
        follow.m_repeats[i] = meetings > 1;
    }
    follow.m_last = std::move(now);
}

// Cloth that flies over hills beyond their rim within a step follows them. The straight way of a node dives through a
// hill, and leaves the surface below the rim. Such a node counts as through only if one that it is linked to does, too.
void Judge::forgetWaysAroundRims(const Cloth& cloth, Follow& follow)
{
    std::vector<bool> alone = follow.m_repeats;
    const btSoftBody& body = *cloth.m_body;
    for (int i = 0; i < body.m_links.size(); ++i)
    {
        const std::size_t a = static_cast<std::size_t>(body.m_links[i].m_n[0] - &body.m_nodes[0]);
        const std::size_t b = static_cast<std::size_t>(body.m_links[i].m_n[1] - &body.m_nodes[0]);
        if (follow.m_passes[a] != 0 && follow.m_passes[b] != 0) alone[a] = alone[b] = false;
    }
    for (std::size_t i = 0; i < alone.size(); ++i)
        if (alone[i]) follow.m_passes[i] = 0;
}
}  // namespace drape::test
