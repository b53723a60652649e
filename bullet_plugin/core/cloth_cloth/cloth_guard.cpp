#include "cloth_guard.h"

#include <algorithm>
#include <iterator>

#include "bullet_plugin/core/threads/ranges.h"

namespace drape
{
namespace
{
// Maximum number of rounds until every pair gets a resting plane. Few pairs take part in late ones.
constexpr int kMostRounds = 64;
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

// Calls work(index) for all of `count` pairs.
template <class Work>
void eachPair(std::size_t count, ThreadTeam& threads, const Work& work)
{
    const auto range = [&](std::size_t first, std::size_t last)
    {
        for (std::size_t i = first; i < last; ++i)
            work(i);
    };
    forRanges(count, kLeastShared, kRange, &threads, range);
}
}  // namespace

// Forgets pairs that were listed before, and notes the others.
void ClothGuard::dropKnown()
{
    std::vector<FeatureTest> added, all;
    std::set_difference(m_tests.begin(), m_tests.end(), m_known.begin(), m_known.end(), std::back_inserter(added),
                        ClothSet::isBefore);
    std::merge(m_known.begin(), m_known.end(), added.begin(), added.end(), std::back_inserter(all), ClothSet::isBefore);
    m_tests.swap(added);
    m_known.swap(all);
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

// Returns the pair's paths to these ends.
FeaturePaths ClothGuard::pathsOf(const ClothSet& set, const Guarded& pair, const float* ends) const
{
    FeaturePaths paths;
    paths.m_split = pair.m_split;
    for (int k = 0; k < 4; ++k)
    {
        paths.m_start[k] = pointAt(set.start(), pair.m_nodes[k]);
        paths.m_end[k] = pointAt(ends, pair.m_nodes[k]);
        paths.m_isHeld[k] = (*m_isHeld)[pair.m_nodes[k]] || m_isLeading[pair.m_nodes[k]];
    }
    return paths;
}

// Adds the pairs that were listed last.
void ClothGuard::takePairs(const ClothSet& set, ThreadTeam& threads)
{
    const std::size_t first = m_pairs.size();
    m_pairs.resize(first + m_tests.size());
    m_isNew.resize(m_pairs.size());
    const auto take = [&](std::size_t i)
    {
        Guarded& pair = m_pairs[first + i];
        pair.m_split = set.nodesOf(m_tests[i], pair.m_nodes);
        pair.m_clearance = clearanceOf(set, m_tests[i], pair.m_nodes, pathsOf(set, pair, m_ends.data()));
        pair.m_round = 0;
        pair.m_rests = false;
    };
    eachPair(m_tests.size(), threads, take);
}

// Gives a resting plane to pairs that no moving one keeps apart on the way to where the nodes now end, or to all pairs.
// Returns whether any pair got one.
bool ClothGuard::checkPairs(const ClothSet& set, bool all, ThreadTeam& threads)
{
    const auto check = [&](std::size_t i)
    {
        Guarded& pair = m_pairs[i];
        m_isNew[i] = 0;
        if (pair.m_rests) return;
        const bool isKnown = std::all_of(pair.m_nodes, pair.m_nodes + 4,
                                         [&](std::uint32_t node) { return m_fellIn[node] < pair.m_round; });
        if (isKnown && !all) return;
        pair.m_round = m_round;
        m_isNew[i] = pair.m_rests = all || !stayApart(pathsOf(set, pair, set.end()), pair.m_clearance);
    };
    eachPair(m_pairs.size(), threads, check);
    const std::size_t first = m_resting.size();
    for (std::size_t i = 0; i < m_pairs.size(); ++i)
    {
        if (!m_isNew[i]) continue;
        m_resting.emplace_back();
        m_resting.back().m_pair = i;
    }
    const auto separate = [&](std::size_t i)
    {
        Resting& pair = m_resting[first + i];
        const Guarded& guarded = m_pairs[pair.m_pair];
        pair.m_paths = pathsOf(set, guarded, m_ends.data());
        pair.m_plane = separatingPlane(pair.m_paths, guarded.m_clearance);
    };
    eachPair(m_resting.size() - first, threads, separate);
    return first < m_resting.size();
}

// Lets the pair's nodes go the least share of their paths that its resting plane allows. set: if not null, instead
// stops nodes at their starts that fail at their rounded ends. Returns whether a share fell.
bool ClothGuard::shorten(const Resting& pair, const ClothSet* set)
{
    bool fell = false;
    for (int k = 0; pair.m_plane.m_isCertified && k < 4; ++k)
    {
        const std::uint32_t node = nodesOf(pair)[k];
        double& share = m_shares[node];
        if (pair.m_paths.m_isHeld[k] || !(share > 0)) continue;
        const double most = set ? 0 : clearShare(pair.m_plane, pair.m_paths, k);
        if (most >= share) continue;
        if (set && staysClear(pair.m_plane, pair.m_paths, k, pointAt(set->end(), node))) continue;
        share = most;
        m_fellIn[node] = m_round;
        fell = true;
    }
    return fell;
}

// Shortens paths for all pairs from the first resting one on.
bool ClothGuard::shortenFrom(std::size_t first, const ClothSet* set)
{
    bool fell = false;
    for (std::size_t i = first; i < m_resting.size(); ++i)
        fell = shorten(m_resting[i], set) || fell;
    return fell;
}

// Shortens paths until all pairs stay apart.
void ClothGuard::settle(ClothSet& set, ThreadTeam& threads)
{
    for (int rounds = 1;; ++rounds)
    {
        ++m_round;
        const std::size_t known = m_resting.size();
        const bool anyNew = checkPairs(set, rounds == kMostRounds, threads);
        if (!shortenFrom(known, nullptr) && !anyNew && !shortenFrom(0, &set)) return;
        place(set);
    }
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
bool ClothGuard::isForced(const Resting& pair)
{
    if (!pair.m_plane.m_isCertified) return false;
    for (int k = 0; k < 4; ++k)
        if (pair.m_paths.m_isHeld[k] && !staysClear(pair.m_plane, pair.m_paths, k, pair.m_paths.m_end[k])) return true;
    return false;
}

// Returns the feature of a forced pair that goes out of the way: 0, 1, or -1 if neither can. Beside held nodes it is
// the other one. Of two features that are pushed, it is the one in front.
int ClothGuard::yielding(const Resting& pair) const
{
    const int split = pair.m_paths.m_split;
    bool isHeld[2] = {false, false};
    double forward = 0;  // to the first feature's side
    for (int k = 0; k < 4; ++k)
    {
        const bool isSecond = k >= split;
        isHeld[isSecond] = isHeld[isSecond] || (*m_isHeld)[nodesOf(pair)[k]];
        const Vec3d way = pair.m_paths.m_end[k] - pair.m_paths.m_start[k];
        forward += dot(pair.m_plane.m_normal, way) / (isSecond ? 4 - split : split);
    }
    if (isHeld[0] || isHeld[1]) return isHeld[0] && isHeld[1] ? -1 : int(isHeld[0]);
    return forward > 0 ? 0 : 1;
}

// Moves the plane as far as one feature pushes it, and the ends of the other's free nodes with it. These lead from now
// on. Returns whether a node is to go elsewhere.
bool ClothGuard::carry(const Resting& pair)
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
        const std::uint32_t node = nodesOf(pair)[k];
        if ((*m_isHeld)[node]) continue;
        float* const end = m_ends.data() + 3 * node;
        const double side = yields == 0 ? 1 : -1;
        // The end has to be as far from the moved plane as this place is from the resting one.
        const Vec3d back = -side * (pushed + m_pairs[pair.m_pair].m_clearance) * pair.m_plane.m_normal;
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
    for (const Resting& pair : m_resting)
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
        if (!again) return result;
        std::copy(m_ends.begin(), m_ends.end(), set.end());
    }
}

void ClothGuard::stopAll(ClothSet& set, const std::vector<unsigned char>& isHeld)
{
    m_pairs.clear();
    m_resting.clear();
    for (std::size_t node = 0; node < set.nodeCount(); ++node)
        m_shares[node] = isHeld[node] ? 1 : 0;
    place(set);
}

GuardResult ClothGuard::applyOnce(ClothSet& set, const std::vector<unsigned char>& isHeld, const IsGuarded& isGuarded,
                                  std::uint64_t limit, ThreadTeam& threads)
{
    GuardResult result;
    m_shares.assign(set.nodeCount(), 1.0);
    m_fellIn.assign(set.nodeCount(), 0);
    m_round = 0;
    m_pairs.clear();
    m_resting.clear();
    m_known.clear();
    const float reach = 2 * kGuardClearance * set.thickness();
    bool isWhole = set.findPairs(reach, limit, threads, m_tests);
    for (;;)
    {
        if (isWhole) dropKnown();
        result.m_tooMany = !isWhole || m_known.size() > limit;
        if (result.m_tooMany)
        {
            stopAll(set, isHeld);
            break;
        }
        dropOthers(set, isGuarded);
        takePairs(set, threads);
        settle(set, threads);
        m_isMoved.resize(set.nodeCount());
        std::transform(m_shares.begin(), m_shares.end(), m_isMoved.begin(), [](double share) { return share < 1; });
        // Shortened paths may need pairs that findPairs() left out.
        if (set.findLost(m_isMoved, threads) == 0) break;
        isWhole = set.listLost(reach, limit, threads, m_tests);
    }
    std::sort(m_resting.begin(), m_resting.end(),
              [](const Resting& a, const Resting& b) { return a.m_pair < b.m_pair; });
    result.m_pairs = m_pairs.size();
    result.m_shortened =
        std::size_t(std::count_if(m_shares.begin(), m_shares.end(), [](double share) { return share < 1; }));
    for (const Resting& pair : m_resting)
    {
        result.m_startMeeting += !pair.m_plane.m_isCertified;
        result.m_forced += isForced(pair);
    }
    return result;
}
}  // namespace drape
