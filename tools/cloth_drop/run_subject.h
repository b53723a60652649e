// The subject of a run's measurements: its cloths and obstacles as triangles.
#pragma once

#include <string>
#include <vector>

#include "scenes/mesh.h"
#include "scenes/vector3.h"

namespace drape
{
// The pose of an obstacle: axes as the columns of a rotation, row after row, and its origin, m.
struct ObstacleFrame
{
    double m_axes[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    Vector3 m_origin;

    // Returns true where coordinates are those of the world. They keep their bits then.
    bool isWorld() const;
    // Returns x y z of points of the world in the obstacle's frame, and the other way round.
    std::vector<float> into(const std::vector<float>& points) const;
    std::vector<float> outOf(const std::vector<float>& points) const;
};

// A cloth that passes through an obstacle because its anchors say so: the obstacle's index, and the cloth's nodes.
struct PassingCloth
{
    std::size_t m_obstacle, m_firstNode, m_lastNode;  // the last one is that after the cloth's
};

struct RunSubject
{
    TriangleMesh m_cloths;                  // all of them at the start, one after the other
    std::vector<std::int32_t> m_lines;      // links of ropes: two nodes of m_cloths each
    std::vector<float> m_rest;              // x y z per node, with the edges' lengths at rest
    std::vector<TriangleMesh> m_obstacles;  // each in its own frame
    std::vector<ObstacleFrame> m_starts;    // their frames at the start
    std::vector<std::string> m_names;       // obstacles, then cloths, for recordings; may be empty
    std::vector<bool> m_isShown;            // in pictures: all but planes, which have no end
    std::vector<PassingCloth> m_passing;    // left out of the checks against their obstacles
    double m_thickness = 0;                 // m
    double m_dt = 0;                        // s, of a step of the run
    bool m_obstaclesMove = false;           // any of them may leave its start
    bool m_countsClothPairs = false;        // counts pairs of cloth triangles that intersect

    std::size_t obstacleTriangles() const;
    // Returns the obstacles that pictures show, with their poses, as one mesh.
    TriangleMesh shown(const std::vector<ObstacleFrame>& frames) const;
};
}  // namespace drape
