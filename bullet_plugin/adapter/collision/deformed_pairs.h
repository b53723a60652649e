// Computes where a cloth's nodes start in a step, relative to an obstacle whose vertices move in that step. Detection
// treats the obstacle as resting at the step's end; a rigid motion would be one transform of all starts
// (kernels/lib/geometry/rigid_motion.h).
//
// A node within reach of the surface starts where it would be had it moved along with the surface's nearest point,
// turned as the triangle turns: on the same side and at the same distance. Farther out the motion fades; nodes beyond
// the surface's reach in the step keep their starts.
//
// The pair has its own mesh of the cloth in the pipeline, whose contacts go to the same body. Cost: a second mesh
// during such motion, and O(log n) per node near the obstacle. The same bits with any number of threads.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "bullet_plugin/adapter/motion/kinematic_motion.h"
#include "bullet_plugin/core/scene/mesh_id.h"
#include "kernels/shared/types.h"

namespace drape
{
class ClothMirror;
class ObstacleMirror;
class PluginState;

struct DeformedPair
{
    MeshId m_mesh = kNoMesh;          // the cloth's mesh for this obstacle alone
    std::vector<btVector3> m_starts;  // by node, m: start positions for the pipeline
    std::vector<Vec3> m_carried;      // position to which the obstacle's whole motion carries it
    std::uint64_t m_lastStep = 0;
};

class DeformedPairs
{
public:
    explicit DeformedPairs(PluginState& state) : m_state(state) {}
    ~DeformedPairs();
    DeformedPairs(const DeformedPairs&) = delete;
    DeformedPairs& operator=(const DeformedPairs&) = delete;

    // Removes the meshes of pairs without moving vertices for a long time. Call before the step's first update().
    void beginStep();
    // Returns the pair's own mesh and starts in this step, for an obstacle with a before(). reach: m, of contacts.
    // The result stays valid until the next beginStep().
    const DeformedPair& update(const ClothMirror& cloth, const ObstacleMirror& obstacle, const BodyMotion& motion,
                               bool kinematic, btScalar reach);

private:
    PluginState& m_state;
    std::unordered_map<std::uint64_t, DeformedPair> m_pairs;  // by the cloth's id above the obstacle's
    std::uint64_t m_step = 0;
};
}  // namespace drape
