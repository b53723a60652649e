// Several cloths joined into one mesh, so that pairs of features within a cloth and between two are found in one way.
//
// Input: the members' triangles and nodes at rest, then in each step their nodes at its start and end. Output: pairs of
// features whose paths may come near each other, and their contacts (self_step.h). Guarantee: as there. On the host, or
// on a device for as long as it has room.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "bullet_plugin/core/lists/contact_view.h"
#include "bullet_plugin/core/scene/scene.h"
#include "host_self_patches.h"

namespace drape
{
class DeviceClothSearch;
struct SearchDevice;
// A cloth as the caller has it: arrays that are read during the call only. Lengths in metres.
struct SetMember
{
    const std::int32_t* m_triangles;  // 3 nodes each
    std::size_t m_triangleCount;
    const std::int32_t* m_edges;  // 2 nodes each; those that belong to no triangle
    std::size_t m_edgeCount;
    const float* m_rest;  // x y z per node
    std::size_t m_nodeCount;
    float m_thickness;  // m, of its contacts with itself
};

// Share of their distance at rest that two points must keep to need no guard.
constexpr float kGuardedShare = 0.1f;

class ClothSet
{
public:
    ClothSet();
    ~ClothSet();

    // Lets a device make the searches; null: the host. Results are the same. Loses the nodes if the device is another
    // one.
    void useDevice(const SearchDevice& device);
    // Replaces the members.
    void assign(const std::vector<SetMember>& members, ThreadTeam& threads);

    std::size_t memberCount() const { return m_firstNodes.empty() ? 0 : m_firstNodes.size() - 1; }
    std::size_t nodeCount() const { return m_firstNodes.empty() ? 0 : m_firstNodes.back(); }
    // Returns the first of a member's nodes in the arrays below; for memberCount() their end.
    std::size_t firstNode(std::size_t member) const { return m_firstNodes[member]; }
    std::size_t memberOf(std::size_t node) const;
    // Returns the thickness of two members' features, m: the mean of theirs.
    float thicknessOf(std::size_t first, std::size_t second) const
    {
        return 0.5f * (m_thicknesses[first] + m_thicknesses[second]);
    }
    // Returns the greatest thickness of any pair, m.
    float thickness() const { return m_thickness; }
    // x y z per node, m, at the step's start and end; the caller writes them.
    float* start() { return m_scene->m_clothNodes.start(); }
    float* end() { return m_scene->m_clothNodes.end(); }
    const float* start() const { return m_scene->m_clothNodes.start(); }
    const float* end() const { return m_scene->m_clothNodes.end(); }

    // Returns the pairs of features that share no node and whose paths come within `reach` (m) of each other, and maybe
    // others, in a canonical order. Valid until the next call. More than `limit` give false. Leaves out pairs of
    // patches that keep kGuardedShare of their distance at rest on the whole way.
    bool findPairs(float reach, std::uint64_t limit, ThreadTeam& threads, std::vector<FeatureTest>& pairs);
    // Returns whether a pair comes before another one in the canonical order.
    static bool isBefore(const FeatureTest& first, const FeatureTest& second);
    // Writes the four nodes of a pair, the first feature's first. Returns how many of them are the first's.
    int nodesOf(const FeatureTest& pair, std::uint32_t nodes[4]) const;
    // Returns a pair's distance at rest, m; that of features of two members is beyond the thickness.
    float restDistance(const FeatureTest& pair) const;

    // Looks for pairs of patches that findPairs() left out and that do not keep their distance with the ends as they
    // are now. Returns how many there are. No findPairs() leaves them out until allowSmooth(). isMoved: by node,
    // whether its end is another one than in the last call of either function.
    std::size_t findLost(const std::vector<unsigned char>& isMoved, ThreadTeam& threads);
    // Returns the pairs of features in the pairs of patches of the last findLost(), and maybe others, like findPairs().
    bool listLost(float reach, std::uint64_t limit, ThreadTeam& threads, std::vector<FeatureTest>& pairs);
    void allowSmooth();

    // Lists, for all pairs of triangles that intersect where they start, the six nodes. Exact. Triangles with a common
    // vertex need another common point; those with a common edge are left out. O(n log n).
    void findMeeting(ThreadTeam& threads, std::vector<std::uint32_t>& nodes);

    // Finds the contacts along the paths that reach to `reachScale` times the greatest thickness, in canonical order.
    // More than `mostPairs` of features or `most` contacts give false and no contacts.
    bool findContacts(float reachScale, std::uint64_t mostPairs, std::uint64_t most, ThreadTeam& threads,
                      std::vector<Contact>& contacts);
    // Returns how many pairs of patches the last search left out. A device finds contacts without.
    std::size_t smoothPairs() const { return m_smoothPairs; }
    // Resolves a contact; nodes are counted over all members.
    SelfContactView view(const Contact& contact) const { return viewSelfContact(*m_scene, contact); }

private:
    SelfStep stepFor(float reach, float reachScale, bool forContacts);
    void dropSmooth(ThreadTeam& threads, std::vector<FeatureTest>& pairs) const;
    bool listPairs(const SelfStep& step, std::uint64_t limit, ThreadTeam& threads, std::vector<FeatureTest>& pairs);

    std::unique_ptr<DeviceClothSearch> m_search;  // null: the host searches
    std::unique_ptr<Scene> m_scene;               // with all members as its only mesh
    std::unique_ptr<HostSelfPatches> m_patches;
    SelfReach m_reach;
    std::vector<float> m_noObstacles;  // see SelfStep
    std::vector<std::size_t> m_firstNodes;
    std::vector<float> m_thicknesses;  // m, by member
    float m_thickness = 0;             // the greatest
    std::size_t m_smoothPairs = 0;
};
}  // namespace drape
