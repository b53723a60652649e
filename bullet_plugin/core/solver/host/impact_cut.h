// Ends the predicted path of nodes just before the first surface that the nodes, or their faces or edges, would pass.
// Contacts behind that surface belong to positions that the node cannot reach, and may push it to either side.
// Detection runs again after a cut.
//
// Input: nodes at the ends of the paths along which the contacts were found. Before a moving obstacle, a path ends
// where the obstacle carries it. The rest of the path is lost for the step, as if the node had stopped there; the
// velocity along the surface can be given back at the step's end. Cloth that would pass no surface within the step (it
// rests, slides, or falls by less than the thickness) is not changed. Cost: linear in the contacts.
#pragma once

#include <vector>

#include "bullet_plugin/core/solver/solver_contact.h"
#include "bullet_plugin/core/solver/solver_nodes.h"

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
bool anyCuts(const std::vector<SolverContact>& contacts);

// Cuts the paths of nodes that constraints move. Shifts the nodes to the new ends; their velocities lose perSecond
// (1/s) times the rest of the path. slides: if not null, gets by node, m/s, what friction leaves of that along the
// surface, after that of the step's earlier cuts. A node that starts where its path ends is held there and gets none.
// Returns whether any path was cut. impulses: if not null, gets by contact what its cuts gave the cloth, N s; slides
// count.
bool cutAtImpacts(SolverNodes& nodes, const std::vector<SolverContact>& contacts, Cut cut, float perSecond,
                  std::vector<Vec3>* slides = nullptr, std::vector<Vec3>* impulses = nullptr);
}  // namespace drape
