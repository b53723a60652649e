// Which algorithm each stage uses, where there are several. All of them give the same contacts, bit for bit: the choice
// is one of time and memory. The defaults are those that were fastest on each class of device. C++11, no OpenCL header
// needed.
//
// Where a field has a range, Pipeline::create fails with an Error that names the field when it is out of it.
#pragma once

#include <cstdint>

namespace drape
{
enum class TreeBuilder
{
    Auto,      // Radix where the host walks the hierarchy: of the builders whose tree pays within tens of steps the one
               // with the fastest steps. Balanced on a device, where a step by default walks none: built fastest
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

// How kernels spread their work; results do not depend on it.
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
    // as they lie. A hierarchy's leaves always are single triangles, which is what traversals hand on; leaves of more
    // are measured apart (part `shape` of the study).
    std::uint32_t m_leafSize = 1;
    std::uint32_t m_groupSize = 128;  // work-items of a group, a power of two, 16 to 256; the thesis's is 128
    std::uint32_t m_smallSize = 55;   // triangles up to which a node is small (the thesis's)
    // Share of small nodes from which a level has a work-item per node, ≥ 0 (its 30 %). Above 1: in no level.
    float m_smallShare = 0.3f;
    std::uint32_t m_largeSize = 8192;       // triangles from which a node is large, ≥ 1
    std::uint32_t m_compactionGroup = 256;  // work-items of the compaction's groups, a power of two, 16 to 256
};

// How hierarchies of triangles are built and refitted. A pipeline builds its hierarchies on the host (core/bvh/
// joined_tree.h: buildMeshTree), so that of these it goes by the builder, m_mortonBits, m_plocRadius and the rule of
// m_topDown (m_medianSplit, m_leafSize), and refits them by levels (core/bvh/refit.h). The rest says how hierarchies
// are built and refitted on a device (TreeBuilderStage, TreeRefitStage), which the study measures.
struct TreeMethods
{
    TreeBuilder m_builder = TreeBuilder::Auto;
    RefitMethod m_refit = RefitMethod::Subtrees;
    WorkShape m_workShape = WorkShape::Device;
    // 30 or 63; all but TopDown. More tell triangles apart that are close together in a large scene, and take longer.
    std::uint32_t m_mortonBits = 30;
    std::uint32_t m_plocRadius = 8;  // neighbours looked at on either side; 1 to 32. Larger: better trees, slower
    TopDownSettings m_topDown;
};

// How the broad phase finds what may touch.
enum class Traversal
{
    // What was fastest: pairs of features, over patches of obstacle triangles (core/broad_phase/patch_cull.h), or,
    // where pairs of triangles are asked for, WideGroups on a GPU, Front on the host and else WideLeaves. The others
    // all find the pairs of triangles whose volumes overlap.
    Auto,
    Pairs,       // a work-item per pair of subtrees walks both hierarchies, the larger node opens first
    Single,      // one work-group with a queue, both nodes open (the thesis's simple traversal)
    Groups,      // work-groups with a shared stack walk both hierarchies from fixed pairs of nodes
    Front,       // as Groups, from the pairs where the last step stopped (the thesis's front)
    Leaves,      // a work-item per cloth triangle walks the obstacles' hierarchy
    WideLeaves,  // a work-item per cloth triangle walks it eight children at a time, as a vector
    WideGroups   // eight work-items test eight children; a work-group shares a stack for a few cloth triangles
};

struct Methods
{
    Traversal m_traversal = Traversal::Auto;

    // Who builds the hierarchies that traversals walk; unused by the default, which walks patches. Each mesh's tree is
    // built once, from the positions that it was given, before the first step that walks it; pairs of meshes come
    // above.
    TreeMethods m_tree;

    // The cloths' hierarchy is built anew, beside the steps, once its nodes' areas over the root's have grown by this
    // factor, ≥ 1, since it was built: see core/pipeline/tree_watch.h. 0: never. Only where a traversal walks it:
    // Pairs, Single, Groups and Front.
    float m_rebuildDecay = 1.5f;

    // Count the broad phase's volume tests (StepStatistics::m_volumeTests). Costs an atomic a work-item.
    bool m_countTests = false;
};
}  // namespace drape
