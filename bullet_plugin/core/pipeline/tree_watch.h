// When the cloths' hierarchy is built anew.
//
// A refit keeps the topology, so a hierarchy fits worse the further the cloth is from the shape that it was built for.
// Every few steps the back end adds up its nodes' areas over the root's (core/bvh/tree_cost.h), with what the step
// reads back anyway; when the sum has grown past Methods::m_rebuildDecay times the first one, a thread builds a new
// hierarchy from the step's end positions while the caller's solver goes on, and the first step that finds it done uses
// it. Steps never wait for it, and contacts do not depend on it. Cost: a launch over the nodes in one step of eight.
#pragma once

#include <future>

#include "drape/settings.h"
#include "side_hierarchy.h"

namespace drape
{
// Whether steps go over patches; reported intersections are found among pairs of triangles.
bool goesOverPatches(const Settings& settings);
// Whether a step's traversal walks the cloths' hierarchy and its decay matters. Where it does not go over patches, Auto
// is another traversal on the host.
bool watchesClothTree(const Settings& settings, bool onHost);

class TreeWatch
{
public:
    // The hierarchy is new: the next cost is what later ones are held against. What is being built is dropped when it
    // is there, and nothing else is built before.
    void begin();

    // Once a step: whether its cost is to be measured.
    bool isDue();
    // Whether a hierarchy of that cost is to be built anew; false while one is being built.
    bool isDecayed(double cost, float rebuildDecay);

    // Starts to build from copies of its own; see buildMeshTrees(). positions: m, x y z per vertex.
    void rebuild(const TreeMethods& methods, std::vector<Triangle> triangles, std::vector<std::uint32_t> firstTriangles,
                 std::vector<float> positions);
    // Waits until the hierarchy that is being built is there; returns at once where none is.
    void wait();
    // Gives the new trees once, when they are there.
    bool take(RebuiltTrees& rebuilt);

private:
    std::future<RebuiltTrees> m_rebuilt;
    bool m_superseded = false;  // m_rebuilt will not be used
    double m_costAtBuild = 0;   // 0: not measured yet
    std::uint32_t m_step = 0;
};
}  // namespace drape
