// Checks whether a soft body still has its own size, and keeps it from coming apart.
//
// Reason: cloth comes apart if its links lose against forces, or if its pins are moved elsewhere without the rest.
// Its faces then reach across whole obstacles. The features that they pass cost more than a step may take, and no
// contact restores the cloth (Pipeline::finish()).
#pragma once

#include <vector>

#include "bullet_plugin/core/solver/topology/cloth_faces.h"
#include "bullet_plugin/adapter/solver/body_nodes.h"

class btSoftBody;

namespace drape
{
// Maximum ratio of a link's length to its rest length in a step that may make all the tests that it needs. The most
// stretched links of a scene, at a few of Bullet's iterations, are two to three times as long as at rest.
constexpr btScalar kMostStretch = 4;

// Length of the most stretched link, as a multiple of its rest length; infinity if a node is not finite. For a body
// without links, the longest edge of a face as a multiple of the longest one at the start.
struct Stretch
{
    btScalar m_start;  // at the start of the nodes' paths
    btScalar m_end;    // at the nodes' current positions
};

// Returns the median of each component; zero for no vectors.
btVector3 medianOf(std::vector<btVector3> vectors);

// Returns the median of the links' rest lengths without bending links, m; for a body without links the longest edge at
// the start.
btScalar unitOf(const btSoftBody& body, const ClothFaces& faces, const SolverNodes& nodes);

// O(n) in the links and faces.
Stretch stretchOf(const btSoftBody& body, const ClothFaces& faces, const SolverNodes& nodes);

// Shortens each movable node's motion relative to the body's common motion, the median, to at most half a unit.
// Velocities follow, so that nodes which fly apart lose their speed. O(n).
void holdTogether(btSoftBody& body, const ClothFaces& faces, const SolverNodes& nodes);
}  // namespace drape
