// Ends the predicted path of nodes just before the first surface that they, or a face or an edge of theirs, would pass.
//
// Why: contacts are found along the whole predicted path and near its end. Behind the first surface they are of places
// that the node cannot get to, inside the obstacle or beyond, and push it to any side. After a cut detection runs
// again, with paths that end near the surfaces that count. Input: a body between predictMotion and the end of
// solveConstraints, the starts of its paths and its contacts along the present ones. Before an obstacle that moves, a
// path ends where the obstacle carries it. What a path loses is lost for the step, as if the node had come to a halt
// there. Cloth that would not pass a surface within the step (it rests, slides, or falls by less than the thickness) is
// not touched. Cost: linear in the contacts.
#pragma once

#include <vector>

#include "bullet_plugin/adapter/node_paths.h"

namespace drape
{
// Detections of one step at most. Faces and edges between a node that was cut and one that was not may pass other
// features than before, so that one cut is not always enough; measured, three are at 200 m/s.
constexpr int kMostDetections = 6;

enum class Cut
{
    EachNode,  // each node by its own first impact
    WholeBody  // every node by the first impact of all: free of impacts for certain, since all keep their order in
               // time; but for obstacles that move otherwise than the one of that impact
};

// Whether a path would be cut at any of them.
bool anyCuts(const std::vector<StepContact>& contacts);

// Returns whether any path was cut. Velocities follow, for a body that Bullet has solved.
bool cutAtImpacts(btSoftBody& body, const NodePaths& paths, const std::vector<StepContact>& contacts, Cut cut);
}  // namespace drape
