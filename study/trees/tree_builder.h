// A tree by the builder that the methods name: order, links and volumes.
//
// Same triangles and positions, same tree, bit for bit, on the host and on every device, in every shape of the work.
#pragma once

#include "study/trees/ploc.h"
#include "study/trees/radix_tree.h"
#include "study/trees/top_down.h"
#include "study/trees/tree_refit.h"

namespace drape
{
// positions: m, x y z per vertex. Order and links; of all but TopDown no volumes.
Tree linkTreeOnHost(const TreeMethods& methods, const std::vector<Triangle>& triangles, const float* positions);

// Builds with volumes, without a radius. meshCount: slots that triangles refer to.
Tree buildTreeOnHost(const TreeMethods& methods, const std::vector<Triangle>& triangles, const float* positions,
                     std::size_t meshCount);

class TreeBuilderStage
{
public:
    // Makes the kernels of the one builder that methods name, and those of the refit that gives its nodes volumes.
    void create(Device& device, const ProgramLoader& load, const TreeMethods& methods);

    // Order, links and volumes, and what the methods' refit of the tree needs (TreeRefitStage::prepare). Returns after
    // enqueueing where builder and refit need no answer in between (Balanced, Radix; Subtrees); TopDown waits once a
    // level and Ploc once in some rounds. TopDown's own kernels make the volumes, the other builders' a refit makes.
    void enqueue(Device& device, Buffer<Triangle>& triangles, Buffer<float>& positions, cl_uint count,
                 std::size_t meshCount, DeviceTree& tree);

    // Returns the levels of the last build; empty unless the builder is TopDown.
    const std::vector<TopDownLevel>& topDownLevels() const { return m_topDown.levels(); }

private:
    TreeMethods m_methods;
    RadixTreeStage m_radix;
    TopDownStage m_topDown;
    PlocStage m_ploc;
    TreeRefitStage m_refit;
    Buffer<float> m_noRadius;
    Buffer<StepCounters> m_counters;
};
}  // namespace drape
