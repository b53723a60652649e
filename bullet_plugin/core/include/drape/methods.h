// Which algorithm each stage uses, where there are several. All of them give the same contacts, bit for bit: the choice
// is one of time and memory. The defaults are those that were fastest on each class of device. C++11, no OpenCL header
// needed.
#pragma once

namespace drape
{
// How the broad phase finds what may touch.
enum class Traversal
{
    // What was fastest. On a device: pairs of features, over patches of obstacle triangles
    // (core/broad_phase/patch_cull.h); where pairs of triangles are asked for, and on the host: WideGroups on a GPU,
    // else WideLeaves. The others all find the pairs of triangles whose volumes overlap.
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

    // Count the broad phase's volume tests (StepStatistics::m_volumeTests). Costs an atomic a work-item.
    bool m_countTests = false;
};
}  // namespace drape
