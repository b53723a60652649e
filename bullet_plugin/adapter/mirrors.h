// What the pipeline holds of one soft body and of one obstacle, kept up to date with Bullet.
//
// Input: the live body or shape of the current step, never one remembered from before. Output: the pipeline's mesh id,
// or kNoMesh for a mesh without triangles. Guarantee: a cloth whose faces or nodes were replaced, cut or refined is
// rebuilt, at once where a count or an array tells, else within as many steps as it has stretches of 32,768 faces; an
// obstacle that moved, was scaled or deformed is moved, and rebuilt when its triangles changed. An unchanged obstacle,
// and a kinematic one that only moved, costs meshSignature(), an unchanged cloth a comparison of some indices. Metres;
// a kinematic obstacle's positions are in its own frame, all others in the world's.
#pragma once

#include <cstdint>
#include <functional>

#include "BulletSoftBody/btSoftBody.h"
#include "LinearMath/btTransform.h"
#include "bullet_plugin/adapter/cloth_faces.h"
#include "bullet_plugin/adapter/cloth_parts.h"
#include "bullet_plugin/adapter/kinematic_motion.h"
#include "bullet_plugin/core/pipeline.h"

namespace drape
{
// An obstacle as Bullet's dispatch sees it: a compound gives one for each child, told apart by the chain of child
// indices.
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

    // Adds the body to the pipeline, or replaces what is there when the topology changed.
    MeshId refresh(Pipeline& pipeline);
    // Writes nodes' positions at the step's start (m_q) and predicted end (m_x).
    void writeNodes(const NodeStretch& stretch) const;
    // As the pipeline has them.
    const ClothFaces& faces() const { return m_faces; }
    // Whether faces name nodes that are not the body's. The pipeline does not have these faces.
    bool hasForeignFaces() const { return m_hasForeignFaces; }
    // Of the nodes as they lay when the topology was read, or when it was last taken up.
    const ClothParts& parts() const { return m_parts; }
    // For who uses it first, or again: the body may be another one in the same place.
    void takeUp() { m_fullCheck = m_takenUp = true; }

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
    ClothParts m_parts;
    const void* m_nodeArray = nullptr;
    const void* m_faceArray = nullptr;
    int m_cursor = 0;
    bool m_hasForeignFaces = false;
    bool m_takenUp = false;  // since the parts were cut
    bool m_fullCheck = true;
};

class ObstacleMirror
{
public:
    explicit ObstacleMirror(const ObstacleKey& key) : m_key(key) {}

    const ObstacleKey& key() const { return m_key; }
    MeshId id() const { return m_id; }

    // The obstacle rests at the motion's end unless it is kinematic.
    MeshId refresh(Pipeline& pipeline, bool kinematic, const BodyMotion& motion);
    // True for the shape itself and for the mesh shape that a scaled shape shows, as they were last refreshed.
    bool uses(const btCollisionShape* shape) const { return shape == m_key.m_shape || shape == m_meshShape; }
    void requireReading() { m_read = false; }

    int m_owners = 0;
    bool m_prepared = false;
    std::uint64_t m_lastSeen = 0;
    bool m_oneSided = false;  // wanted; the next refresh() heeds it

private:
    void reload(Pipeline& pipeline, const btTransform& pose);
    void drop(Pipeline& pipeline);

    ObstacleKey m_key;
    const btCollisionShape* m_meshShape = nullptr;  // compared, never followed
    MeshId m_id = kNoMesh;
    btTransform m_pose = btTransform::getIdentity();
    std::uint64_t m_signature = 0, m_topologyHash = 0, m_positionHash = 0;
    bool m_kinematic = false;
    bool m_heldOneSided = false;  // by the pipeline
    bool m_read = false;          // the pipeline holds what the shape held when it was last read
};
}  // namespace drape
