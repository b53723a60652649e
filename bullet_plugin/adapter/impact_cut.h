// Ends the predicted path of fast nodes just before the first surface that they, or a face or an edge of theirs, would
// pass.
//
// Why: contacts are found along the whole predicted path and near its end. For cloth that moves by more than the reach
// of a contact behind the first surface, all but the first impact are of places that it cannot get to, and their
// normals push it to any side. After a cut detection runs again, with paths that end near the surfaces that count.
// Input: a body between predictMotion and solveConstraints and its contacts along the present paths. What a node's path
// loses is lost for the step, its speed is as if it had come to a halt there. Slow cloth is not touched. Cost: linear
// in the contacts.
#pragma once

#include <vector>

#include "bullet_plugin/adapter/step_contact.h"

namespace drape
{
// Detections of one step at most. Faces and edges between a node that was cut and one that was not may pass other
// features than before, so that one cut is not always enough; measured, three are at 200 m/s.
constexpr int kMostDetections = 6;

enum class Cut
{
    EachNode,  // each node by its own first impact
    WholeBody  // every node by the first impact of all: free of impacts for certain, since all keep their order in time
};

// Returns whether any path was cut. beyond: by how much a path must go on behind the surface to be cut, as a share of
// the thickness. Velocities follow when the positions are final (Bullet has solved).
bool cutAtImpacts(btSoftBody& body, const std::vector<StepContact>& contacts, btScalar beyond, Cut cut);
}  // namespace drape
