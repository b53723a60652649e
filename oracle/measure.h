// The independent check of a cloth run: the position of the cloth relative to the obstacle's surface after a step.
//
// Shares no code with the product: double precision, own tree, exact predicates for intersections. Input: the obstacle
// (fixed), the cloth's triangles, the cloth's nodes after each step. Lengths in metres. Guarantee: the distances are
// true minima up to double rounding; intersections are exact. Cost: some milliseconds a step for 2,048 against 69,666
// triangles.
//
// A point is below the surface of a closed obstacle if it is inside. For an open obstacle it must have passed through
// the surface and be on the other side than the node was.
//
// An obstacle vertex is above the cloth if its piece of the obstacle sticks out through the cloth. The check starts at
// obstacle triangles that the cloth cuts. It follows the obstacle's surface over vertices on the cloth's outer side
// whose closest cloth point is below the obstacle's surface. A vertex' depth is the distance to that point. The outer
// side of a cloth face is the one away from the obstacle. The nodes of the face that are not below the surface
// determine it; if all are below, the face's normal at the start does.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/mesh.h"
#include "oracle/signed_surface.h"

namespace drape
{
struct StepMeasure
{
    double m_penetrationMax = 0;  // m, deepest node below the surface or obstacle vertex above the cloth
    double m_gapMin = 0;          // m, smallest distance node to obstacle or obstacle vertex to cloth; < 0: penetration
    std::vector<float> m_nodeDepths;      // m, of the nodes below the surface
    std::size_t m_intersectingPairs = 0;  // cloth and obstacle triangles that have a point in common
    std::size_t m_invalidNodes = 0;       // NaN or infinite; they take no part in the rest

    std::size_t nodesBelow() const { return m_nodeDepths.size(); }
};

class PenetrationMeter
{
public:
    // `cloth` gives triangles and the nodes' positions at the start, which count as correct.
    PenetrationMeter(const TriangleMesh& obstacle, const TriangleMesh& cloth);

    // Measures the nodes' new places: x y z per node. To be called after every step, since motion is followed.
    StepMeasure measure(const float* positions);

private:
    struct NodeState
    {
        Vector3 m_position;      // last valid one
        double m_lower = 0;      // m, no nearer to the surface than this
        double m_upper = 1e300;  // m, no farther
        int m_side = 0;          // open obstacles: the side it belongs to; 0: not known yet
        bool m_below = false;
    };

    void acceptPositions(const float* positions, StepMeasure& step);
    void measureNode(std::size_t node, StepMeasure& step);
    bool nodeBelow(std::size_t node, const ClosestPoint& closest);
    void countIntersections(StepMeasure& step);
    void followCuts(StepMeasure& step);
    bool clothPointBelow(const ClosestPoint& onCloth) const;
    Vector3 outerNormal(std::int32_t face) const;
    void lowerGapByVertices(StepMeasure& step) const;

    SignedSurface m_surface;
    TriangleTree m_clothTree;
    std::vector<float> m_positions;  // valid ones only
    std::vector<Vector3> m_before;   // places of the step before
    std::vector<NodeState> m_nodes;
    std::vector<std::vector<std::int32_t>> m_neighbours;  // neighbours of each obstacle vertex
    std::vector<std::int32_t> m_cutTriangles;             // obstacle triangles cut in this step; may repeat
    double m_reach;                                       // m, nodes nearer than this are measured each step
};
}  // namespace drape
