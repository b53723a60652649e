// The methods that the study compares: who builds a tree of triangles, how it is refitted, and how two trees are
// traversed. All methods of a kind give the same result, bit for bit; they differ in time and memory.
#pragma once

#include <cstdint>

namespace drape
{
enum class TreeBuilder
{
    Balanced,  // triangles in Morton order, neighbours paired height by height: the shape depends on the count alone
    Radix,     // triangles in Morton order, split where the codes' first differing bit is (Karras 2012)
    TopDown,   // level by level, at the mean or median of the centroids along the longest direction (the thesis)
    Ploc       // nearest neighbours merged bottom-up (Meister and Bittner 2018): fewest nodes visited, slowest build
};

enum class RefitMethod
{
    Levels,   // a launch per height (the thesis); waits once per topology
    Subtrees  // whole subtrees per work-group: three launches, two up to 2,048 triangles
};

// The shape in which kernels spread their work; results do not depend on it.
enum class WorkShape
{
    Device,  // groups on a GPU, serial elsewhere
    Groups,  // many work-items share a stretch through local memory
    Serial   // a work-item runs through a stretch alone, as a CPU's core likes it
};

// The thesis's construction and its optimisations, each a switch.
struct TopDownSettings
{
    bool m_medianSplit = false;    // at the median of the centroids instead of the mean
    bool m_adaptiveGroups = true;  // work-groups shrink with what a level's nodes would have in a full tree
    bool m_smallSplits = true;     // small nodes get a work-item instead of a work-group
    bool m_largeNodes = true;      // large nodes get many work-groups
    // The thesis's leaf threshold, ≥ 1: nodes of at most so many triangles are no longer split by the rule, but halved
    // as they lie. A tree's leaves are always single triangles, which is what traversals hand on; leaves of more are
    // measured apart (part `shape`).
    std::uint32_t m_leafSize = 1;
    std::uint32_t m_groupSize = 128;  // work-items of a group, a power of two, 16 to 256; the thesis's is 128
    std::uint32_t m_smallSize = 55;   // triangles up to which a node is small (the thesis's)
    // Share of small nodes from which a level has a work-item per node, ≥ 0 (its 30 %). Above 1: in no level.
    float m_smallShare = 0.3f;
    std::uint32_t m_largeSize = 8192;       // triangles from which a node is large, ≥ 1
    std::uint32_t m_compactionGroup = 256;  // work-items of the compaction's groups, a power of two, 16 to 256
};

// Methods that build and refit trees of triangles.
struct TreeMethods
{
    TreeBuilder m_builder = TreeBuilder::Radix;
    RefitMethod m_refit = RefitMethod::Subtrees;
    WorkShape m_workShape = WorkShape::Device;
    // 30 or 63; all but TopDown. More tell triangles apart that are close together in a large scene, and take longer.
    std::uint32_t m_mortonBits = 30;
    std::uint32_t m_plocRadius = 8;  // neighbours looked at on either side; 1 to 32. Larger: better trees, slower
    TopDownSettings m_topDown;
};

// Methods that find the pairs of triangles whose volumes overlap.
enum class Traversal
{
    Single,  // one work-group with a queue, both nodes open (the thesis's simple traversal)
    Full,    // work-groups with a shared stack walk both trees, from fixed pairs of nodes
    Front,   // like Full, from the pairs where the last step stopped (the thesis's front)
    Grid     // a uniform grid with sorted cells (Green 2008; Teschner et al. 2003)
};

struct Methods
{
    Traversal m_traversal = Traversal::Front;
    TreeMethods m_tree;         // for both sides, built once, from the positions at rest
    bool m_countTests = false;  // count volume tests on a device, which costs an atomic a work-item
};
}  // namespace drape
