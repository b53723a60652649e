// Construction and refit, repeated and timed.
#pragma once

#include <string>
#include <vector>

#include "study/programs/trees/tree_input.h"

namespace drape::bench
{
// Times of repeated builds of one variant.
struct Builds
{
    Samples m_host;                                   // from host memory to the finished tree, ms
    Samples m_kernels;                                // all kernels of a build, ms
    std::vector<std::vector<KernelTime>> m_launches;  // a build
    std::vector<TopDownLevel> m_levels;
    std::string m_hash;  // treeHash()
};
Builds buildOnDevice(Device& device, TreeInput& input, const TreeMethods& methods, const StudyOptions& options);
// On the host, one thread: the last tree, and how long each took, ms.
Samples buildOnOneThread(const TreeInput& input, const TreeMethods& methods, const StudyOptions& options, Tree& tree);

// Times of repeated refits of one tree, from TreeInput::m_positions to m_moved.
struct Refits
{
    Samples m_host;                    // from positions in host memory to the refitted tree, ms
    Samples m_kernels;                 // all kernels of a refit, ms
    std::vector<Samples> m_launches;   // each launch of a refit
    std::vector<std::string> m_names;  // names of their kernels
    std::string m_hash;                // treeHash()
};
Refits refitOnDevice(Device& device, TreeInput& input, const Tree& tree, RefitMethod method,
                     const StudyOptions& options);

// Refits on one thread of the host: sets m_host and m_hash. valid: whether every volume then is exactly that of its
// triangles.
Refits refitOnOneThread(Tree tree, const TreeInput& input, const StudyOptions& options, bool& valid);
}  // namespace drape::bench
