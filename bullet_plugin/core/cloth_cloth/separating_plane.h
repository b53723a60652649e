// A plane that keeps two features of cloth apart while their nodes move along straight paths: a node and a face, or two
// edges.
//
// Method: planar truncation (Chen, Hsu, Ayman and Macklin 2026, Divide and Truncate), with certified sides. Sides are
// half-spaces. If each node starts and ends on its feature's side, the features stay apart on the way, too. The plane
// may move along its normal, linearly in time.
//
// Every sign allows for rounding, so that a certified plane separates the features in exact arithmetic. Double
// precision; offsets from a node of the pair, so that errors grow with the pair's size and not with its position.
#pragma once

#include "bullet_plugin/core/vec3d.h"

namespace drape
{
// The first m_split nodes are the first feature's, the others the second's: 1 and 3, or 2 and 2.
struct FeaturePaths
{
    Vec3d m_start[4], m_end[4];  // m
    bool m_isHeld[4];            // nodes whose paths cannot be shortened
    int m_split;
};

struct SeparatingPlane
{
    Vec3d m_normal;      // towards the first feature
    Vec3d m_origin;      // m
    double m_offset;     // m, of the plane along the normal from the origin
    double m_clear[4];   // m, distance from the plane that each node keeps
    bool m_isCertified;  // the features start apart; without it nothing else is valid
    bool m_leavesHeld;   // held nodes end on their sides
};

// Returns how far features start apart, m; a lower bound, at most the true distance. 0 if they meet, or if no plane
// could be certified.
double separationOf(const FeaturePaths& paths);

// Returns whether a plane, which may move, surely keeps the features apart on their whole way. At the end they are at
// least twice the clearance apart (m), or as far as at their start if that is less.
bool stayApart(const FeaturePaths& paths, double clearance);

// Returns a resting plane between the features where they start. clearance: m, that each side keeps; a node that starts
// nearer keeps its distance.
SeparatingPlane separatingPlane(const FeaturePaths& paths, double clearance);

// Returns whether the position is surely on the node's side of the plane, as far away as the plane demands.
bool staysClear(const SeparatingPlane& plane, const FeaturePaths& paths, int node, Vec3d position);

// Returns how far the position is from where the node stays clear of the plane, m; 0 if it does.
double lackingDistance(const SeparatingPlane& plane, const FeaturePaths& paths, int node, Vec3d position);

// Returns the share of its path, 0 to 1, up to which a node stays clear; a little less where it would not to the end.
double clearShare(const SeparatingPlane& plane, const FeaturePaths& paths, int node);
}  // namespace drape
