#include "bullet_plugin/adapter/collision/deformed_pairs.h"

#include <algorithm>
#include <iterator>

#include "bullet_plugin/adapter/mirrors/mirrors.h"
#include "bullet_plugin/adapter/vectors.h"
#include "bullet_plugin/adapter/wiring/plugin_state.h"

namespace drape
{
namespace
{
// Number of steps for which a pair's mesh is kept without a moving vertex: two seconds at 60 steps a second.
constexpr std::uint64_t kKeepSteps = 120;

// Nodes that a thread processes per turn.
constexpr std::size_t kNodesPerJob = 256;

// Computes a node's start in the frame of the obstacle's positions. The motion counts fully within `whole` of the
// surface, and fades to nothing at twice that distance.
Vec3 deformed(const ObstacleMirror& obstacle, Vec3 start, float whole)
{
    MeshProbe::Place place;
    if (!obstacle.before()->nearestWithin(start, 2 * whole, place)) return start;
    const Vec3 carried = obstacle.before()->carriedWith(place, start, obstacle.positions());
    const float share = std::min(1.0f, 2 - place.m_distance / whole);
    return share < 1 ? vec3Mix(start, carried, share) : carried;
}
}  // namespace

DeformedPairs::~DeformedPairs()
{
    if (!m_state.ready()) return;
    for (const auto& entry : m_pairs)
        m_state.pipeline().remove(entry.second.m_mesh);
}

void DeformedPairs::beginStep()
{
    ++m_step;
    for (auto entry = m_pairs.begin(); entry != m_pairs.end();)
    {
        const bool stays = entry->second.m_lastStep + kKeepSteps >= m_step;
        if (!stays) m_state.pipeline().remove(entry->second.m_mesh);
        entry = stays ? std::next(entry) : m_pairs.erase(entry);
    }
}

const DeformedPair& DeformedPairs::update(const ClothMirror& cloth, const ObstacleMirror& obstacle,
                                          const BodyMotion& motion, bool kinematic, btScalar reach)
{
    DeformedPair& pair = m_pairs[std::uint64_t(cloth.id()) << 32 | obstacle.id()];
    if (pair.m_mesh == kNoMesh) pair.m_mesh = cloth.addCopy(m_state.pipeline());
    pair.m_lastStep = m_step;
    const btSoftBody& body = *cloth.body();
    const std::size_t count = static_cast<std::size_t>(body.m_nodes.size());
    pair.m_starts.resize(count);
    pair.m_carried.resize(count);
    const btTransform toObstacle = motion.m_start.inverse();
    const float whole = static_cast<float>(reach) + obstacle.mostMotion();
    const auto move = [&](std::size_t job)
    {
        for (std::size_t i = job * kNodesPerJob; i < std::min(count, (job + 1) * kNodesPerJob); ++i)
        {
            const btVector3& start = body.m_nodes[static_cast<int>(i)].m_q;
            const btVector3 own = kinematic ? toObstacle * start : start;
            const Vec3 place = deformed(obstacle, vec3Of(own), whole);
            const btVector3 moved = vectorOf(place);
            pair.m_starts[i] = kinematic ? motion.m_start * moved : moved;
            pair.m_carried[i] = vec3Of(kinematic ? motion.m_end * moved : moved);
        }
    };
    const std::size_t jobs = (count + kNodesPerJob - 1) / kNodesPerJob;
    runShared(m_state.threads(), jobs > 1, jobs, move);
    return pair;
}
}  // namespace drape
