#include "benchmarks/study/peer_trees.h"
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
}  // namespace

PeerTree measureFclTree(const TriangleMesh& mesh, int repeats, double seconds)
{
    PeerTree tree;
    tree.m_name = "fcl";
    tree.m_driver = "FCL " FCL_VERSION;
    tree.m_build = repeat(2, std::size_t(repeats), seconds,
                          [&]
                          {
                              FclModel model;
                              const Clock::time_point start = Clock::now();
                              build(model, mesh);
                              return millisecondsSince(start);
                          });
    FclModel kept;
    build(kept, mesh);
    tree.m_refit = repeat(2, std::size_t(repeats), seconds,
                          [&]
                          {
                              const Clock::time_point start = Clock::now();
                              refitFclModel(kept, mesh.m_positions.data(), mesh.vertexCount());
                              return millisecondsSince(start);
                          });
    return tree;
}
}  // namespace drape::bench
