// Shortens the paths of cloths' nodes so that no two features of cloth meet on their way: the guarantee for cloth
// against itself and against other cloth, whatever a solver did.
//
// Input: a set whose nodes start a step where no two triangles meet, and end it where a solver put them. Output: ends
// on the same straight paths. Guarantee: features that start apart stay apart on the whole way, for each pair alone
// that the result does not count. Nodes that nothing threatens are not moved. The same bits with any number of
// threads. Cost: that of finding pairs within kGuardClearance of the thickness, and some 200 ns for each.
//
// Method: a pair is left alone if a moving plane keeps its features apart on the way to their rounded ends. Otherwise
// it gets a plane that rests (separating_plane.h), and a node goes the least share of its path that its resting planes
// allow. Shorter paths change what other pairs need, so those with such nodes are checked again until nothing changes.
// After kMostRounds every pair gets a resting plane. Pairs of patches that lay smoothly on the whole paths and do not
// on the shorter ones are listed then. A node that stays where it started is on its side of all resting planes. Held
// nodes stay on theirs only if they move little. Where they do not, the other feature is carried along: the ends of its
// free nodes move with the plane, and all pairs are checked anew. Nodes that are carried then count as held, so that
// they carry what lies behind them. If more pairs are forced in the end than without carrying, none is carried.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "bullet_plugin/core/threads/thread_team.h"
#include "cloth_set.h"
#include "separating_plane.h"

namespace drape
{
// Distance from a plane that each side keeps, as a share of the pair's thickness.
constexpr float kGuardClearance = 1.0f / 32;

struct GuardResult
{
    std::size_t m_pairs = 0;         // pairs that were checked
    std::size_t m_shortened = 0;     // nodes
    std::size_t m_startMeeting = 0;  // pairs that meet at their start, or nearly so; they are not guarded
    std::size_t m_forced = 0;        // pairs that held nodes bring together; they may meet
    bool m_tooMany = false;          // more pairs than the limit: all paths are shortened to nothing
};

class ClothGuard
{
public:
    // Returns whether the guard keeps two features with these four nodes of the set apart.
    using IsGuarded = std::function<bool(const std::uint32_t*)>;
    // isHeld: by node of the set; held nodes go where they go. isGuarded: null if all are. mayCarry:
    // held nodes may carry others along.
    GuardResult apply(ClothSet& set, const std::vector<unsigned char>& isHeld, const IsGuarded& isGuarded,
                      std::uint64_t limit, ThreadTeam& threads, bool mayCarry = true);
    // Returns the share of its path that each node went in the last apply().
    const std::vector<double>& shares() const { return m_shares; }
    // Calls visit(nodes, split, isForced) for each pair that the last result counts as forced, or else as meeting at
    // its start. Of its four nodes the first `split` are the first feature's.
    template <class Visit>
    void forFlagged(const Visit& visit) const
    {
        for (const Resting& pair : m_resting)
            if (!pair.m_plane.m_isCertified || isForced(pair))
                visit(nodesOf(pair), pair.m_paths.m_split, pair.m_plane.m_isCertified);
    }
    // Calls visit(nodes) for each pair that the last apply() checked.
    template <class Visit>
    void forPairs(const Visit& visit) const
    {
        for (const Guarded& pair : m_pairs)
            visit(pair.m_nodes);
    }
    // Calls visit(nodes) for each pair whose features stopped each other.
    template <class Visit>
    void forStopped(const Visit& visit) const
    {
        const auto isStopped = [this](std::uint32_t node) { return m_shares[node] < 1; };
        for (const Resting& pair : m_resting)
            if (pair.m_plane.m_isCertified && std::any_of(nodesOf(pair), nodesOf(pair) + 4, isStopped))
                visit(nodesOf(pair));
    }
    // Returns whether held nodes carried a node in the last apply(): its path is another one then.
    bool isCarried(std::size_t node) const { return m_isCarried[node] != 0; }

private:
    struct Guarded
    {
        std::uint32_t m_nodes[4];
        std::uint32_t m_round;  // the last check's; 0: none
        std::int32_t m_split;   // see FeaturePaths
        double m_clearance;     // m
        bool m_rests;           // the pair is one of m_resting
    };

    // A pair with a resting plane.
    struct Resting
    {
        std::size_t m_pair;    // in m_pairs
        FeaturePaths m_paths;  // the whole ones
        SeparatingPlane m_plane;
    };

    GuardResult applyOnce(ClothSet& set, const std::vector<unsigned char>& isHeld, const IsGuarded& isGuarded,
                          std::uint64_t limit, ThreadTeam& threads);
    void stopAll(ClothSet& set, const std::vector<unsigned char>& isHeld);
    void dropKnown();
    void dropOthers(const ClothSet& set, const IsGuarded& isGuarded);
    const std::uint32_t* nodesOf(const Resting& pair) const { return m_pairs[pair.m_pair].m_nodes; }
    FeaturePaths pathsOf(const ClothSet& set, const Guarded& pair, const float* ends) const;
    void takePairs(const ClothSet& set, ThreadTeam& threads);
    void settle(ClothSet& set, ThreadTeam& threads);
    bool checkPairs(const ClothSet& set, bool all, ThreadTeam& threads);
    bool shorten(const Resting& pair, const ClothSet* set);
    bool shortenFrom(std::size_t first, const ClothSet* set);
    void place(ClothSet& set) const;
    static bool isForced(const Resting& pair);
    int yielding(const Resting& pair) const;
    bool carry(const Resting& pair);
    bool carryForced();

    std::vector<FeatureTest> m_tests;  // pairs that were listed last
    std::vector<FeatureTest> m_known;  // all that were listed, in canonical order
    std::vector<Guarded> m_pairs;
    std::vector<Resting> m_resting;
    std::vector<unsigned char> m_isNew;    // by pair: it needs a resting plane from this round on
    std::uint32_t m_round = 0;             // counted from the start of applyOnce()
    std::vector<std::uint32_t> m_fellIn;   // by node: the round in which its share fell last, 0: in none
    std::vector<unsigned char> m_isMoved;  // by node: it does not go its whole path
    std::vector<double> m_shares;
    std::vector<float> m_ends;                             // ends of the whole paths
    const std::vector<unsigned char>* m_isHeld = nullptr;  // the caller's, during apply()
    std::vector<unsigned char> m_isCarried;
    std::vector<unsigned char> m_isLeading;  // by node: held nodes push it, and it pushes others as these do
};
}  // namespace drape
