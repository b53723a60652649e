#include <algorithm>

#include "study/programs/peer_trees.h"
#include "benchmarks/support/embree.h"

namespace drape::bench
{
namespace
{
// A scene of one mesh.
class EmbreeTree
{
public:
    EmbreeTree(RTCDevice device, const TriangleMesh& mesh, bool morton)
    {
        m_scene = rtcNewScene(device);
        rtcSetSceneBuildQuality(m_scene, morton ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM);
        if (morton) rtcSetSceneFlags(m_scene, RTC_SCENE_FLAG_DYNAMIC);  // keeps what a refit needs
        m_geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        // Padded: Embree reads 16 bytes at the last vertex.
        m_positions = mesh.m_positions;
        m_positions.push_back(0);
        rtcSetSharedGeometryBuffer(m_geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, m_positions.data(), 0,
                                   3 * sizeof(float), mesh.vertexCount());
        rtcSetSharedGeometryBuffer(m_geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.m_triangles.data(), 0,
                                   3 * sizeof(std::int32_t), mesh.triangleCount());
        rtcSetGeometryBuildQuality(m_geometry, morton ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM);
        rtcAttachGeometry(m_scene, m_geometry);
    }
    ~EmbreeTree()
    {
        rtcReleaseGeometry(m_geometry);
        rtcReleaseScene(m_scene);
    }
    EmbreeTree(const EmbreeTree&) = delete;
    EmbreeTree& operator=(const EmbreeTree&) = delete;

    double commit()
    {
        const Clock::time_point start = Clock::now();
        rtcCommitGeometry(m_geometry);
        rtcCommitScene(m_scene);
        return millisecondsSince(start);
    }
    // Sets the vertices that the next refit finds.
    void move(const TriangleMesh& moved)
    {
        std::copy(moved.m_positions.begin(), moved.m_positions.end(), m_positions.begin());
    }
    double refit()
    {
        rtcSetGeometryBuildQuality(m_geometry, RTC_BUILD_QUALITY_REFIT);
        rtcUpdateGeometryBuffer(m_geometry, RTC_BUFFER_TYPE_VERTEX, 0);
        return commit();
    }
    std::string hash() const
    {
        RTCBounds bounds;
        rtcGetSceneBounds(m_scene, &bounds);
        return boundsHash(&bounds.lower_x, &bounds.upper_x);
    }

private:
    RTCScene m_scene = nullptr;
    RTCGeometry m_geometry = nullptr;
    std::vector<float> m_positions;
};
}  // namespace

std::vector<PeerTree> measureEmbreeTrees(const TriangleMesh& mesh, const TriangleMesh& moved, int repeats,
                                         double seconds)
{
    std::vector<PeerTree> trees;
    for (const int threads : {1, 2})
    {
        const RTCDevice device = rtcNewDevice(("threads=" + std::to_string(threads)).c_str());
        for (const bool morton : {true, false})
        {
            PeerTree tree;
            tree.m_name = morton ? "embree_morton" : "embree_sah";
            tree.m_driver = "Embree " RTC_VERSION_STRING;
            tree.m_threads = threads;
            EmbreeTree(device, mesh, morton).commit();  // a device's first build of a kind makes its threads and memory
            tree.m_build = repeat(2, std::size_t(repeats), seconds,
                                  [&]
                                  {
                                      EmbreeTree built(device, mesh, morton);
                                      const double ms = built.commit();
                                      tree.m_buildHash = built.hash();
                                      return ms;
                                  });
            if (morton)
            {
                EmbreeTree kept(device, mesh, true);
                kept.commit();
                kept.refit();  // the first one prepares
                kept.move(moved);
                tree.m_refit = repeat(2, std::size_t(repeats), seconds, [&] { return kept.refit(); });
                tree.m_refitHash = kept.hash();
            }
            trees.push_back(tree);
        }
        rtcReleaseDevice(device);
    }
    return trees;
}
}  // namespace drape::bench
