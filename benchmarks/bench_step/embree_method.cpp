// Embree as a peer: rtcCollide over boxes, alone or with Drape's host narrow phase behind it.
#include <algorithm>
#include <limits>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_sort.h>

#include "benchmarks/support/peer_scene.h"
#include "benchmarks/bench_step/peer_methods.h"
#include "benchmarks/support/embree.h"
#include "benchmarks/support/result_hash.h"
#include "benchmarks/support/samples.h"

namespace drape::bench
{
namespace
{
// The boxes that the bounds callback reads.
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

// rtcCollide reports a pair of a scene with itself from both sides, or from one of them.
void keepEachOnce(std::vector<Candidate>& pairs)
{
    for (Candidate& pair : pairs)
        if (pair.m_obstacle < pair.m_cloth) std::swap(pair.m_cloth, pair.m_obstacle);
    tbb::parallel_sort(pairs.begin(), pairs.end(),
                       [](const Candidate& a, const Candidate& b)
                       { return a.m_cloth != b.m_cloth ? a.m_cloth < b.m_cloth : a.m_obstacle < b.m_obstacle; });
    const auto same = [](const Candidate& a, const Candidate& b)
    { return a.m_cloth == b.m_cloth && a.m_obstacle == b.m_obstacle; };
    pairs.erase(std::unique(pairs.begin(), pairs.end(), same), pairs.end());
    const auto itself = [](const Candidate& pair) { return pair.m_cloth == pair.m_obstacle; };
    pairs.erase(std::remove_if(pairs.begin(), pairs.end(), itself), pairs.end());
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
        m_selfBoxes = {m_scene.clothTriangles().data(), nodes, nodes, selfReach(scene) / 2};
        m_obstacleBoxes = {m_scene.obstacleTriangles().data(), surface, surface, 0};
        const Clock::time_point start = Clock::now();
        m_obstacle = addScene(m_obstacleBoxes, m_scene.obstacleTriangles().size(), RTC_BUILD_QUALITY_MEDIUM, nullptr);
        m_buildMs = millisecondsSince(start);
        m_cloth = addScene(m_clothBoxes, m_scene.clothTriangles().size(), RTC_BUILD_QUALITY_REFIT, &m_clothGeometry);
        if (m_selfBoxes.m_reach > 0)
            m_self = addScene(m_selfBoxes, m_scene.clothTriangles().size(), RTC_BUILD_QUALITY_REFIT, &m_selfGeometry);
    }
    ~EmbreeMethod() override
    {
        rtcReleaseScene(m_obstacle);
        rtcReleaseScene(m_cloth);
        if (m_self != nullptr) rtcReleaseScene(m_self);
        rtcReleaseDevice(m_device);
    }

    bool good() const { return rtcGetDeviceError(m_device) == RTC_ERROR_NONE; }

    StepOutcome step(const float* start, const float* end) override
    {
        StepOutcome outcome;
        const Clock::time_point begin = Clock::now();
        refit(m_clothBoxes, m_clothGeometry, m_cloth, start, end);
        if (m_self != nullptr) refit(m_selfBoxes, m_selfGeometry, m_self, start, end);
        const double refitMs = millisecondsSince(begin);
        collide(m_cloth, m_obstacle, m_candidates);
        outcome.m_candidates = m_candidates.size();
        if (m_self != nullptr)
        {
            collide(m_self, m_self, m_selfPairs);
            keepEachOnce(m_selfPairs);
            outcome.m_candidates += m_selfPairs.size();
        }
        const double broadMs = millisecondsSince(begin);
        if (m_contacts) m_scene.narrowPhase(m_candidates, start, end, m_threads, m_found);
        if (m_contacts && m_self != nullptr) m_scene.selfContacts(m_selfPairs, start, end, m_threads, m_selfFound);
        const double stepMs = millisecondsSince(begin);
        outcome.m_stages = {{"step", stepMs}, {"refit", refitMs}, {"broad", broadMs - refitMs}};
        if (!m_contacts) return outcome;
        outcome.m_stages.push_back({"narrow", stepMs - broadMs});
        outcome.m_contacts = m_found.size() + m_selfFound.size();
        std::uint64_t hash = hashOf(m_found);
        if (m_self != nullptr) hash = hashOf(m_selfFound, hash);
        outcome.m_hash = hashText(hash);
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
    static void refit(Boxes& boxes, RTCGeometry geometry, RTCScene scene, const float* start, const float* end)
    {
        boxes.m_start = start;
        boxes.m_end = end;
        rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
        rtcCommitGeometry(geometry);
        rtcCommitScene(scene);
    }
    void collide(RTCScene a, RTCScene b, std::vector<Candidate>& pairs)
    {
        for (std::vector<Candidate>& list : m_lists)
            list.clear();
        rtcCollide(a, b, takePairs, &m_lists);
        pairs.clear();
        for (const std::vector<Candidate>& list : m_lists)
            pairs.insert(pairs.end(), list.begin(), list.end());
    }
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
    RTCScene m_cloth = nullptr, m_obstacle = nullptr, m_self = nullptr;  // m_self: grown by half the reach
    RTCGeometry m_clothGeometry = nullptr, m_selfGeometry = nullptr;
    Boxes m_clothBoxes, m_obstacleBoxes, m_selfBoxes;
    std::vector<Candidate> m_selfPairs;
    PairLists m_lists;
    std::vector<Candidate> m_candidates;
    std::vector<Contact> m_found, m_selfFound;
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
