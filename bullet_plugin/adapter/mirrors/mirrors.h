// Keeps the pipeline's mesh of one soft body, or of one obstacle, up to date with Bullet.
//
// Input: the live body or shape of the current step, never one remembered from before. Output: the pipeline's mesh
// id, or kNoMesh for a mesh without triangles.
//
// Guarantee: a cloth whose faces, solid links or nodes were replaced, cut or refined is rebuilt. This happens at once
// if a count or an array reveals it. Otherwise it takes as many steps as the cloth has runs of 32,768 faces, or twice
// its runs of 1,024 links. An obstacle that moved, was scaled or deformed is moved, and rebuilt when its triangles
// changed.
//
// Cost: meshSignature() for an unchanged obstacle or a kinematic one that only moved; a comparison of some indices
// for an unchanged cloth. A plane or height field is read around the cloths near it, and anew when one of them leaves
// what was read. Metres; positions are in a movable obstacle's own frame, else in the world's.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "LinearMath/btTransform.h"
#include "bullet_plugin/core/solver/topology/cloth_faces.h"
#include "bullet_plugin/core/solver/topology/feature_order.h"
#include "bullet_plugin/adapter/motion/kinematic_motion.h"
#include "bullet_plugin/adapter/mirrors/mesh_reader.h"
#include "bullet_plugin/adapter/mirrors/solid_links.h"
#include "bullet_plugin/core/pipeline/pipeline.h"
#include "bullet_plugin/core/probe/mesh_probe.h"
#include "bullet_plugin/core/threads/thread_team.h"

namespace drape
{
// An obstacle in Bullet's dispatch: a compound gives one for each child, distinguished by the chain of child indices.
struct ObstacleKey
{
    const btCollisionObject* m_object;
    const btCollisionShape* m_shape;
    std::uint64_t m_child;

    bool operator==(const ObstacleKey& other) const
    {
        return m_object == other.m_object && m_shape == other.m_shape && m_child == other.m_child;
    }
};

struct ObstacleKeyHash
{
    std::size_t operator()(const ObstacleKey& key) const
    {
        const std::hash<const void*> hash;
        return (hash(key.m_object) * 31 + hash(key.m_shape)) * 31 + std::size_t(key.m_child);
    }
};

class ClothMirror
{
public:
    explicit ClothMirror(const btSoftBody* body) : m_body(body) {}

    const btSoftBody* body() const { return m_body; }
    MeshId id() const { return m_id; }

    // Adds the body to the pipeline, or replaces what is there when the topology changed. readNodes: called before the
    // nodes' positions are read, which cut the parts.
    MeshId refresh(Pipeline& pipeline, const std::function<void()>& readNodes = nullptr);
    // Adds a further mesh of the body to the pipeline, as refresh() left the first; the caller's to remove.
    MeshId addCopy(Pipeline& pipeline) const;
    // Faces as the pipeline has them: the body's faces, then its solid links, each as a face that repeats its second
    // node.
    const ClothFaces& faces() const { return m_faces; }
    // Returns whether faces, or links that would be solid, name nodes outside the body. The pipeline omits them.
    bool hasForeignFaces() const { return m_hasForeignFaces || m_links.hasForeign(); }
    // Parts cut by the nodes' positions when the topology was read or last revalidated.
    const ClothParts& parts() const { return m_parts; }
    // Order in which sweeps visit the features.
    const FeatureOrder& order() const { return m_order; }
    // Requests a full check, before a first or renewed use: the body may be another one at the same address.
    void takeUp() { m_fullCheck = m_takenUp = true; }
    // Declares that the nodes are no longer where the last step left them. Each pair of the cloth is then checked for
    // intersections before it counts as free of them.
    void startAnew() { ++m_startRevision; }
    // A watched cloth is checked after its next step, whatever its solver says: in the last one it would have passed a
    // surface.
    void watch(bool isWatched) { m_isWatched = isWatched; }
    bool isWatched() const { return m_isWatched; }
    // Counts up with each startAnew().
    std::uint64_t startRevision() const { return m_startRevision; }
    // Records the nodes' positions at a step's end: m_x after it, m_q for nodes that were brought to the host since.
    void rememberEnds(ThreadTeam& threads, btVector3 btSoftBody::Node::*where = &btSoftBody::Node::m_x);
    // Lists the nodes whose step starts (m_q) away from the last recorded end; all nodes if no end was recorded.
    void listJumped(ThreadTeam& threads, std::vector<int>& nodes) const;
    // Returns whether, before a step's motion is predicted, a node was moved from its position after the last step as
    // the map moves it, to within `slack` (m). The body is alive, and the last step was the one before this.
    bool movedAlong(const btTransform& map, btScalar slack) const;

    int m_owners = 0;  // algorithms alive that use this mirror, and who had it prepared
    bool m_prepared = false;
    std::uint64_t m_lastSeen = 0;  // step

private:
    bool topologyChanged();
    bool sameFaces(int begin, int end) const;
    void readTopology();
    void cutParts();

    const btSoftBody* m_body;  // followed only while a pair of the current step names it
    MeshId m_id = kNoMesh;
    ClothFaces m_faces;
    SolidLinks m_links;
    int m_faceCount = 0;  // entries of m_faces without links
    ClothParts m_parts;
    FeatureOrder m_order;
    const void* m_nodeArray = nullptr;
    const void* m_faceArray = nullptr;
    int m_cursor = 0;
    std::uint64_t m_startRevision = 0;
    std::vector<btVector3> m_ends;  // end positions of the last step, by node
    bool m_hasForeignFaces = false;
    bool m_takenUp = false;  // since the parts were cut
    bool m_isWatched = false;
    bool m_fullCheck = true;
};

class ObstacleMirror
{
public:
    explicit ObstacleMirror(const ObstacleKey& key) : m_key(key) {}

    const ObstacleKey& key() const { return m_key; }
    MeshId id() const { return m_id; }

    // Begins the first use in a step. filter: null for all triangles; must live until the step's refresh() calls.
    void beginStep(bool oneSided, const TriangleFilter* filter);
    // Names a cloth near the plane or height field, by its box in the shape's frame, m. For the coming refresh() calls.
    void wantAround(const SurfaceBox& cloth) { m_wanted.push_back(cloth); }
    // Returns whether the last refresh() gave no mesh because the cloths cover too many cells of a height field.
    bool isTooLarge() const { return m_isTooLarge; }
    // movable: of a kinematic or dynamic object. Other obstacles rest at the motion's end.
    MeshId refresh(Pipeline& pipeline, bool movable, const BodyMotion& motion);
    // Gives a movable obstacle's motion in this step another end. Call after refresh().
    void follow(Pipeline& pipeline, const BodyMotion& motion);
    // True for the shape itself and for the mesh shape that a scaled shape shows, as they were last refreshed.
    bool uses(const btCollisionShape* shape) const { return shape == m_key.m_shape || shape == m_meshShape; }
    void requireReading() { m_read = false; }
    // Takes the shape's place in its object for the step: it changes where an app moves a compound's child. A change
    // that is too large for a motion, or announced as a teleport, is none.
    void place(const btTransform& place);
    // Returns whether the place moves in this step, and whether it ever did.
    bool movesPlace() const { return m_placing == Placing::Moves; }
    bool movesInCompound() const { return m_movesInCompound; }
    // Returns where the shape starts the step with its object at `body`. pose: where it is without a motion in its
    // object. isDynamic: it starts where it ended the last step if its object does; `pose` differs by rounding.
    btTransform startOf(const btTransform& body, const btTransform& pose, bool isDynamic) const;
    // Records where the object ends the step.
    void setBodyEnd(const btTransform& body) { m_bodyEnd = body; }
    // Declares that the coming change of the place is no motion.
    void teleport() { m_isTeleported = true; }
    // Counts the step if its object is somewhere else than where it ended the last one, without a motion and without
    // teleport(). Returns true in the step from which jumpsOften() is true. Call before place().
    bool countJump(const btTransform& body, bool moves);
    // Returns whether the object was put elsewhere in step after step.
    bool jumpsOften() const { return m_jumps >= kManyJumps; }
    // Declares that the obstacle is no longer where the last step left it, see ClothMirror. refresh() does so itself if
    // the pose or the mesh changed by anything except the motion over a step.
    void startAnew() { ++m_startRevision; }
    std::uint64_t startRevision() const { return m_startRevision; }
    // Counts up when the pipeline's positions of the obstacle change.
    std::uint64_t positionRevision() const { return m_positionRevision; }
    // Returns the mesh as it was in the step before if its vertices moved in place since, by no more than counts as
    // motion within this step; null otherwise. m_lastSeen is this step.
    MeshProbe* before() const { return m_deformedStep == m_lastSeen ? m_before.get() : nullptr; }
    // Moves before() to the pipeline's positions, where it stays until the next refresh(). Only if it is not null.
    MeshProbe& moveBefore() const;
    // The pipeline's positions at that time, and the largest displacement of a vertex, m.
    const std::vector<float>& positions() const { return m_positions; }
    // Returns how Bullet names a triangle of the pipeline's mesh.
    TriangleName nameOf(std::size_t triangle) const { return m_names.name(triangle); }
    float mostMotion() const { return m_mostMotion; }

    int m_owners = 0;
    bool m_prepared = false;
    std::uint64_t m_lastSeen = 0;
    bool m_continued = false;  // there was a refresh() in the step before: what changed since is the motion of this one

private:
    // Tells a motion in the object since the last step from a jump.
    enum class Placing
    {
        Stays,
        Moves,
        Jumps
    };

    bool leavesPart() const;
    bool readsElsewhere();
    void reload(Pipeline& pipeline, const btTransform& pose, bool isElsewhere);
    void deform(Pipeline& pipeline, std::vector<float>& positions, bool samePlace);
    void drop(Pipeline& pipeline);

    ObstacleKey m_key;
    const btCollisionShape* m_meshShape = nullptr;  // compared, never followed
    MeshId m_id = kNoMesh;
    btTransform m_pose = btTransform::getIdentity();   // pose of the positions in the pipeline
    btTransform m_start = btTransform::getIdentity();  // poses of the obstacle at the last step's start and end
    btTransform m_end = btTransform::getIdentity();
    btTransform m_bodyEnd = btTransform(btMatrix3x3(0, 0, 0, 0, 0, 0, 0, 0, 0));  // see setBodyEnd(); no pose before
    btTransform m_place = btTransform::getIdentity(), m_placeBefore = m_place;    // in the object, see place()
    Placing m_placing = Placing::Stays;
    std::uint64_t m_placedStep = 0;
    bool m_isTeleported = false, m_movesInCompound = false;
    static constexpr int kManyJumps = 4;
    int m_jumps = 0;  // see countJump(), each within some steps of the one before
    std::uint64_t m_jumpStep = 0, m_jumpChecked = 0;
    std::uint64_t m_startRevision = 0, m_positionRevision = 0;
    std::unique_ptr<MeshProbe> m_before;  // probe of a mesh whose vertices moved
    std::vector<float> m_positions;       // its positions in the pipeline
    float m_mostMotion = 0;               // m
    std::uint64_t m_deformedStep = 0;
    std::uint64_t m_signature = 0, m_topologyHash = 0, m_positionHash = 0;
    ReadPart m_part;
    TriangleNames m_names;
    std::vector<SurfaceBox> m_wanted;  // in the coming or current step
    std::uint64_t m_sampledStep = 0;
    bool m_isTooLarge = false;
    bool m_oneSided = false;  // wanted; the next refresh() heeds it
    bool m_isMovable = false;
    bool m_heldOneSided = false;  // by the pipeline
    bool m_read = false;          // the pipeline has what the shape had when it was last read
};
}  // namespace drape
