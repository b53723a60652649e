// Embree as a peer: rtcCollide over boxes, alone or with Drape's host narrow phase behind it.
#include <algorithm>
#include <limits>

#include <tbb/enumerable_thread_specific.h>

#include "benchmarks/support/peer_scene.h"
#include "benchmarks/bench_step/peer_methods.h"
#include "benchmarks/support/embree.h"
#include "benchmarks/support/result_hash.h"
#include "benchmarks/support/samples.h"

namespace drape::bench
{
namespace
{
// What the bounds callback reads.
struct Boxes
{
    const Triangle* m_triangles = nullptr;
    const float* m_start = nullptr;
    const float* m_end = nullptr;
    float m_reach = 0;
};

void boundTriangle(const RTCBoundsFunctionArguments* arguments)
{
    const Boxes& boxes = *static_cast<const Boxes*>(arguments->geometryUserPtr);
    const Triangle& triangle = boxes.m_triangles[arguments->primID];
    float low[3], high[3];
    for (int axis = 0; axis < 3; ++axis)
    {
        low[axis] = std::numeric_limits<float>::infinity();
        high[axis] = -low[axis];
        for (const std::uint32_t vertex : triangle.m_vertices)
        {
            const float a = boxes.m_start[3 * vertex + static_cast<std::uint32_t>(axis)];
            const float b = boxes.m_end[3 * vertex + static_cast<std::uint32_t>(axis)];
            low[axis] = std::min(low[axis], std::min(a, b));
            high[axis] = std::max(high[axis], std::max(a, b));
        }
        low[axis] -= boxes.m_reach;
        high[axis] += boxes.m_reach;
    }
    *arguments->bounds_o = {low[0], low[1], low[2], 0, high[0], high[1], high[2], 0};
}

using PairLists = tbb::enumerable_thread_specific<std::vector<Candidate>>;

void takePairs(void* user, RTCCollision* pairs, unsigned count)
{
    std::vector<Candidate>& list = static_cast<PairLists*>(user)->local();
    for (unsigned i = 0; i < count; ++i)
        list.push_back(Candidate{pairs[i].primID0, pairs[i].primID1});
}

class EmbreeMethod : public StepMethod
{
public:
    EmbreeMethod(const StepScene& scene, int threads, float reach, bool contacts)
        : m_scene(scene), m_threads(threads), m_contacts(contacts)
    {
        m_device = rtcNewDevice(("threads=" + std::to_string(threads)).c_str());
        const float* nodes = scene.start(0);
        const float* surface = m_scene.obstaclePositions().data();
        m_clothBoxes = {m_scene.clothTriangles().data(), nodes, nodes, reach};
        m_obstacleBoxes = {m_scene.obstacleTriangles().data(), surface, surface, 0};
        const Clock::time_point start = Clock::now();
        m_obstacle = addScene(m_obstacleBoxes, m_scene.obstacleTriangles().size(), RTC_BUILD_QUALITY_MEDIUM, nullptr);
        m_buildMs = millisecondsSince(start);
        m_cloth = addScene(m_clothBoxes, m_scene.clothTriangles().size(), RTC_BUILD_QUALITY_REFIT, &m_clothGeometry);
    }
    ~EmbreeMethod() override
    {
        rtcReleaseScene(m_obstacle);
        rtcReleaseScene(m_cloth);
        rtcReleaseDevice(m_device);
    }

    bool good() const { return rtcGetDeviceError(m_device) == RTC_ERROR_NONE; }

    StepOutcome step(const float* start, const float* end) override
    {
        StepOutcome outcome;
        const Clock::time_point begin = Clock::now();
        m_clothBoxes.m_start = start;
        m_clothBoxes.m_end = end;
        rtcUpdateGeometryBuffer(m_clothGeometry, RTC_BUFFER_TYPE_VERTEX, 0);
        rtcCommitGeometry(m_clothGeometry);
        rtcCommitScene(m_cloth);
        const double refitMs = millisecondsSince(begin);
        for (std::vector<Candidate>& list : m_lists)
            list.clear();
        rtcCollide(m_cloth, m_obstacle, takePairs, &m_lists);
        m_candidates.clear();
        for (const std::vector<Candidate>& list : m_lists)
            m_candidates.insert(m_candidates.end(), list.begin(), list.end());
        const double broadMs = millisecondsSince(begin);
        outcome.m_candidates = m_candidates.size();
        if (m_contacts) m_scene.narrowPhase(m_candidates, start, end, m_threads, m_found);
        const double stepMs = millisecondsSince(begin);
        outcome.m_stages = {{"step", stepMs}, {"refit", refitMs}, {"broad", broadMs - refitMs}};
        if (!m_contacts) return outcome;
        outcome.m_stages.push_back({"narrow", stepMs - broadMs});
        outcome.m_contacts = m_found.size();
        outcome.m_hash = hashText(hashOf(m_found));
        return outcome;
    }

    void describe(Row& row) const override
    {
        row["backend"] = "embree";
        row["device"] = "host";
        row["driver"] = "Embree " RTC_VERSION_STRING;
        row["threads"] = m_threads;
        row["prepare_ms"] = m_buildMs;
    }

private:
    RTCScene addScene(Boxes& boxes, std::size_t count, RTCBuildQuality quality, RTCGeometry* kept)
    {
        RTCScene scene = rtcNewScene(m_device);
        if (quality == RTC_BUILD_QUALITY_REFIT)
        {
            // Only scenes of low quality keep a tree per geometry, which can be refitted; others build anew.
            rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_LOW);
            rtcSetSceneFlags(scene, RTC_SCENE_FLAG_DYNAMIC);
        }
        RTCGeometry geometry = rtcNewGeometry(m_device, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(count));
        rtcSetGeometryUserData(geometry, &boxes);
        rtcSetGeometryBoundsFunction(
            geometry, [](const RTCBoundsFunctionArguments* arguments) { boundTriangle(arguments); }, nullptr);
        rtcSetGeometryBuildQuality(geometry, quality);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcCommitScene(scene);
        if (kept != nullptr) *kept = geometry;  // the scene holds it
        rtcReleaseGeometry(geometry);
        return scene;
    }

    PeerScene m_scene;
    int m_threads;
    bool m_contacts;
    RTCDevice m_device = nullptr;
    RTCScene m_cloth = nullptr, m_obstacle = nullptr;
    RTCGeometry m_clothGeometry = nullptr;
    Boxes m_clothBoxes, m_obstacleBoxes;
    PairLists m_lists;
    std::vector<Candidate> m_candidates;
    std::vector<Contact> m_found;
    double m_buildMs = 0;
};
}  // namespace

std::unique_ptr<StepMethod> makeEmbreeMethod(const StepScene& scene, int threads, float reach, bool contacts,
                                             std::string& error)
{
    auto method = std::make_unique<EmbreeMethod>(scene, threads, reach, contacts);
    if (method->good()) return method;
    error = "Embree reported an error";
    return nullptr;
}
}  // namespace drape::bench
