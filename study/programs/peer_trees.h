// Construction and refit of the peers' hierarchies over a mesh, timed.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/support/samples.h"
#include "scenes/mesh.h"

namespace drape::bench
{
struct PeerTree
{
    std::string m_name;    // embree_morton, embree_sah, fcl
    std::string m_driver;  // with its version
    int m_threads = 1;
    std::string m_buildHash, m_refitHash;  // boundsHash() of the box that the tree says it has
    Samples m_build;                       // from positions and triangles in memory
    Samples m_refit;                       // from new positions in memory
};

// Hashes a box: least and largest x, y and z.
std::string boundsHash(const float* low, const float* high);
// Hashes the mesh's box, which every tree over the mesh must have.
std::string boundsHash(const TriangleMesh& mesh);

// Embree's triangle geometry by its Morton and its SAH builder, on one and on two threads, each warmed up by a build
// that is not counted. moved: the mesh as refits find it, see refitPositions(). repeats: at most, within seconds each;
// two at least, and of what is short kLeastRepeats.
std::vector<PeerTree> measureEmbreeTrees(const TriangleMesh& mesh, const TriangleMesh& moved, int repeats,
                                         double seconds);

// FCL's float 18-DOP tree; likewise.
PeerTree measureFclTree(const TriangleMesh& mesh, const TriangleMesh& moved, int repeats, double seconds);
}  // namespace drape::bench
