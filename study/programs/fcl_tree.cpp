#include "study/programs/peer_trees.h"
#include "benchmarks/support/fcl_model.h"

namespace drape::bench
{
namespace
{
void build(FclModel& model, const TriangleMesh& mesh)
{
    buildFclModel(
        model, mesh.triangleCount(), [&](std::size_t t) { return &mesh.m_triangles[3 * t]; }, mesh.m_positions.data(),
        mesh.vertexCount());
}

// A k-DOP's first three directions are the axes: least values, then, from 9 on, largest.
std::string hashOf(const FclModel& model)
{
    const FclVolume& root = model.getBV(0).bv;
    const float low[3] = {root.dist(0), root.dist(1), root.dist(2)};
    const float high[3] = {root.dist(9), root.dist(10), root.dist(11)};
    return boundsHash(low, high);
}
}  // namespace

PeerTree measureFclTree(const TriangleMesh& mesh, const TriangleMesh& moved, int repeats, double seconds)
{
    PeerTree tree;
    tree.m_name = "fcl";
    tree.m_driver = "FCL " FCL_VERSION;
    FclModel kept;  // the first one warms up
    build(kept, mesh);
    tree.m_build = repeat(2, std::size_t(repeats), seconds,
                          [&]
                          {
                              FclModel model;
                              const Clock::time_point start = Clock::now();
                              build(model, mesh);
                              const double ms = millisecondsSince(start);
                              tree.m_buildHash = hashOf(model);
                              return ms;
                          });
    tree.m_refit = repeat(2, std::size_t(repeats), seconds,
                          [&]
                          {
                              const Clock::time_point start = Clock::now();
                              refitFclModel(kept, moved.m_positions.data(), moved.vertexCount());
                              return millisecondsSince(start);
                          });
    tree.m_refitHash = hashOf(kept);
    return tree;
}
}  // namespace drape::bench
