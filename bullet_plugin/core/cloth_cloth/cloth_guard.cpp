#include "cloth_guard.h"

#include <algorithm>

#include "bullet_plugin/core/threads/ranges.h"

namespace drape
{
namespace
{
constexpr int kMostRounds = 8;
// Maximum number of times that held nodes carry others along in a step.
constexpr int kMostCarries = 16;
// Minimum pairs for sharing them among threads, and the pairs of a range.
constexpr std::size_t kLeastShared = 1024, kRange = 256;

// Returns the distance that each side keeps, m. Features that are nearer than the thickness at rest keep less.
double clearanceOf(const ClothSet& set, const FeatureTest& test, const std::uint32_t nodes[4],
                   const FeaturePaths& paths)
{
    const float thickness = set.thicknessOf(set.memberOf(nodes[0]), set.memberOf(nodes[3]));
    const double clearance = double(kGuardClearance) * double(thickness);
    if (separationOf(paths) > 2 * clearance) return clearance;
    return double(kGuardClearance) * double(selfThickness(thickness, set.restDistance(test)));
}
}  // namespace

template <class Work>
void ClothGuard::eachPair(ThreadTeam& threads, const Work& work)
{
    const auto range = [&](std::size_t first, std::size_t last)
    {
        for (std::size_t i = first; i < last; ++i)
            work(i);
    };
    forRanges(m_pairs.size(), kLeastShared, kRange, &threads, range);
}

// Forgets pairs that are not guarded.
void ClothGuard::dropOthers(const ClothSet& set, const IsGuarded& isGuarded)
{
    if (!isGuarded) return;
    const auto isOther = [&](const FeatureTest& test)
    {
        std::uint32_t nodes[4];
        set.nodesOf(test, nodes);
        return !isGuarded(nodes);
    };
    m_tests.erase(std::remove_if(m_tests.begin(), m_tests.end(), isOther), m_tests.end());
}

void ClothGuard::takePairs(const ClothSet& set, const std::vector<unsigned char>& isHeld, ThreadTeam& threads)
{
    m_pairs.resize(m_tests.size());
    const auto take = [&](std::size_t i)
    {
        Guarded& pair = m_pairs[i];
        pair.m_paths.m_split = set.nodesOf(m_tests[i], pair.m_nodes);
        for (int k = 0; k < 4; ++k)
        {
            pair.m_paths.m_start[k] = pointAt(set.start(), pair.m_nodes[k]);
            pair.m_paths.m_end[k] = pointAt(set.end(), pair.m_nodes[k]);
            pair.m_paths.m_isHeld[k] = isHeld[pair.m_nodes[k]] || m_isLeading[pair.m_nodes[k]];
        }
        pair.m_clearance = clearanceOf(set, m_tests[i], pair.m_nodes, pair.m_paths);
        pair.m_rests = pair.m_needsPlane = false;
    };
    eachPair(threads, take);
}

// Gives a resting plane to pairs that no moving one keeps apart on the way to where the nodes now end, or to all pairs.
// Returns whether any pair got one.
bool ClothGuard::checkPairs(const ClothSet& set, bool all, ThreadTeam& threads)
{
    const auto check = [&](std::size_t i)
    {
        Guarded& pair = m_pairs[i];
        pair.m_needsPlane = false;
        if (pair.m_rests) return;
        FeaturePaths now = pair.m_paths;
        for (int k = 0; k < 4; ++k)
            now.m_end[k] = pointAt(set.end(), pair.m_nodes[k]);
        if (!all && stayApart(now, pair.m_clearance)) return;
        pair.m_plane = separatingPlane(pair.m_paths, pair.m_clearance);
        pair.m_rests = pair.m_needsPlane = true;
    };
    eachPair(threads, check);
    return std::any_of(m_pairs.begin(), m_pairs.end(), [](const Guarded& pair) { return pair.m_needsPlane; });
}

// Lets every node go the least share of its path that its resting planes allow. rounded: instead stops nodes at their
// starts that fail at their rounded ends. Returns whether a share fell.
bool ClothGuard::shorten(const ClothSet& set, bool rounded)
{
    bool fell = false;
    for (const Guarded& pair : m_pairs)
    {
        for (int k = 0; pair.m_rests && pair.m_plane.m_isCertified && k < 4; ++k)
        {
            double& share = m_shares[pair.m_nodes[k]];
            if (pair.m_paths.m_isHeld[k] || !(share > 0)) continue;
            const double most = rounded ? 0 : clearShare(pair.m_plane, pair.m_paths, k);
            if (most >= share) continue;
            if (rounded && staysClear(pair.m_plane, pair.m_paths, k, pointAt(set.end(), pair.m_nodes[k]))) continue;
            share = most;
            fell = true;
        }
    }
    return fell;
}

// Writes the ends of nodes that go a share of their paths. Without a share that is the start, to the last bit.
void ClothGuard::place(ClothSet& set) const
{
    for (std::size_t i = 0; i < 3 * m_shares.size(); ++i)
    {
        const double share = m_shares[i / 3], start = set.start()[i], way = double(m_ends[i]) - start;
        if (share < 1) set.end()[i] = share > 0 ? float(start + share * way) : set.start()[i];
    }
}

// Returns whether held nodes leave their sides of a pair's resting plane.
bool ClothGuard::isForced(const Guarded& pair)
{
    if (!pair.m_rests || !pair.m_plane.m_isCertified) return false;
    for (int k = 0; k < 4; ++k)
        if (pair.m_paths.m_isHeld[k] && !staysClear(pair.m_plane, pair.m_paths, k, pair.m_paths.m_end[k])) return true;
    return false;
}

// Returns the feature of a forced pair that goes out of the way: 0, 1, or -1 if neither can. Beside held nodes it is
// the other one. Of two features that are pushed, it is the one in front.
int ClothGuard::yielding(const Guarded& pair) const
{
    const int split = pair.m_paths.m_split;
    bool isHeld[2] = {false, false};
    double forward = 0;  // to the first feature's side
    for (int k = 0; k < 4; ++k)
    {
        const bool isSecond = k >= split;
        isHeld[isSecond] = isHeld[isSecond] || (*m_isHeld)[pair.m_nodes[k]];
        const Vec3d way = pair.m_paths.m_end[k] - pair.m_paths.m_start[k];
        forward += dot(pair.m_plane.m_normal, way) / (isSecond ? 4 - split : split);
    }
    if (isHeld[0] || isHeld[1]) return isHeld[0] && isHeld[1] ? -1 : int(isHeld[0]);
    return forward > 0 ? 0 : 1;
}

// Moves the plane as far as one feature pushes it, and the ends of the other's free nodes with it. These lead from now
// on. Returns whether a node is to go elsewhere.
bool ClothGuard::carry(const Guarded& pair)
{
    const int split = pair.m_paths.m_split, yields = yielding(pair);
    if (yields < 0) return false;
    double pushed = 0;  // m
    for (int k = 0; k < 4; ++k)
        if (pair.m_paths.m_isHeld[k] && (k >= split) != (yields == 1))
            pushed = std::max(pushed, lackingDistance(pair.m_plane, pair.m_paths, k, pair.m_paths.m_end[k]));
    bool moved = false;
    for (int k = yields == 0 ? 0 : split; k < (yields == 0 ? split : 4); ++k)
    {
        const std::uint32_t node = pair.m_nodes[k];
        if ((*m_isHeld)[node]) continue;
        float* const end = m_ends.data() + 3 * node;
        const double side = yields == 0 ? 1 : -1;
        // The end has to be as far from the moved plane as this place is from the resting one.
        const Vec3d back = -side * (pushed + pair.m_clearance) * pair.m_plane.m_normal;
        const double lacking = lackingDistance(pair.m_plane, pair.m_paths, k, pointAt(m_ends.data(), node) + back);
        moved = moved || lacking > 0 || m_shares[node] < 1;
        m_isLeading[node] = 1;
        if (!(lacking > 0)) continue;
        const Vec3d by = side * lacking * pair.m_plane.m_normal;
        end[0] += float(by.x);
        end[1] += float(by.y);
        end[2] += float(by.z);
        m_isCarried[node] = 1;
    }
    return moved;
}

bool ClothGuard::carryForced()
{
    bool moved = false;
    for (const Guarded& pair : m_pairs)
        if (isForced(pair)) moved = carry(pair) || moved;
    return moved;
}

GuardResult ClothGuard::apply(ClothSet& set, const std::vector<unsigned char>& isHeld, const IsGuarded& isGuarded,
                              std::uint64_t limit, ThreadTeam& threads, bool mayCarry)
{
    const std::vector<float> ends(set.end(), set.end() + 3 * set.nodeCount());
    const auto restart = [&]
    {
        m_ends = ends;
        m_isCarried.assign(set.nodeCount(), 0);
        m_isLeading.assign(set.nodeCount(), 0);
    };
    m_isHeld = &isHeld;
    restart();
    set.allowSmooth();
    std::size_t forcedAtFirst = 0;
    for (int carries = 0;;)
    {
        const GuardResult result = applyOnce(set, isHeld, isGuarded, limit, threads);
        if (carries == 0) forcedAtFirst = result.m_forced;
        bool again = mayCarry && result.m_forced > 0 && carries < kMostCarries && carryForced();
        carries += again;
        if (!again && mayCarry && result.m_forced > forcedAtFirst)
        {
            // Nodes that lead came where there is no room.
            restart();
            mayCarry = false;
            again = true;
        }
        // Shortened paths may need pairs that findPairs() left out. Each turn lists more of them.
        if (!again && (result.m_shortened == 0 || result.m_tooMany || set.staysSmooth(threads))) return result;
        std::copy(m_ends.begin(), m_ends.end(), set.end());
    }
}

GuardResult ClothGuard::applyOnce(ClothSet& set, const std::vector<unsigned char>& isHeld, const IsGuarded& isGuarded,
                                  std::uint64_t limit, ThreadTeam& threads)
{
    GuardResult result;
    m_shares.assign(set.nodeCount(), 1.0);
    m_pairs.clear();
    result.m_tooMany = !set.findPairs(2 * kGuardClearance * set.thickness(), limit, threads, m_tests);
    if (result.m_tooMany)
    {
        for (std::size_t node = 0; node < set.nodeCount(); ++node)
            if (!isHeld[node]) m_shares[node] = 0;
        place(set);
    }
    else
    {
        dropOthers(set, isGuarded);
        takePairs(set, isHeld, threads);
    }
    for (int round = 1;; ++round)
    {
        const bool anyNew = checkPairs(set, round == kMostRounds, threads);
        if (!shorten(set, false) && !anyNew && !shorten(set, true)) break;
        place(set);
    }
    result.m_pairs = m_pairs.size();
    result.m_shortened =
        std::size_t(std::count_if(m_shares.begin(), m_shares.end(), [](double share) { return share < 1; }));
    for (const Guarded& pair : m_pairs)
    {
        if (!pair.m_rests) continue;
        result.m_startMeeting += !pair.m_plane.m_isCertified;
        result.m_forced += isForced(pair);
    }
    return result;
}
}  // namespace drape
