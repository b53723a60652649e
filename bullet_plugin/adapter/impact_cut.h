// Ends the predicted path of nodes just before the first surface that the nodes, or their faces or edges, would pass.
// Contacts behind that surface belong to positions that the node cannot reach, and may push it to either side.
// Detection runs again after a cut.
//
// Input: a body between predictMotion and the end of solveConstraints, the starts of its paths and its contacts along
// the current paths. Before a moving obstacle, a path ends where the obstacle carries it. The rest of the path is
// lost for the step, as if the node had stopped there. Cloth that would pass no surface within the step (it rests,
// slides, or falls by less than the thickness) is not changed. Cost: linear in the contacts.
#pragma once

#include <vector>

#include "bullet_plugin/adapter/node_paths.h"

namespace drape
{
// Maximum detections per step. Faces and edges between a cut and an uncut node may pass other features than before,
// so one cut is not always enough. Three were enough at 200 m/s, measured.
constexpr int kMostDetections = 6;

enum class Cut
{
    EachNode,  // cuts each node at its own first impact
    WholeBody  // cuts every node at the first impact of all, which is free of impacts: all keep their order in
               // time, except for obstacles that move unlike the one of that impact
};

// Returns whether a path would be cut at any of the contacts.
bool anyCuts(const std::vector<StepContact>& contacts);

// Returns whether any path was cut. Updates velocities too, for a body that Bullet has solved.
bool cutAtImpacts(btSoftBody& body, const NodePaths& paths, const std::vector<StepContact>& contacts, Cut cut);
}  // namespace drape
