// Records of a cloth world: descriptions of cloth and obstacles, contacts, and views of nodes; see drape/cloth_world.h
// and drape/c_api.h.
//
// C++ and C share these declarations. Start from defaultCloth() or defaultObstacle(), in C from drapeDefaultCloth() or
// drapeDefaultObstacle(). Arrays are the caller's and are read during the call only. SI units, world frame. C99, C++11.
#ifndef DRAPE_CLOTH_RECORDS_H
#define DRAPE_CLOTH_RECORDS_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
namespace drape
{
#endif

// A cloth: its mesh and its material. Every edge of a triangle is a link, and so is each edge of m_edges.
typedef struct ClothDescription
{
    // Positions of the nodes, x y z each, m.
    const float* m_positions;
    // Number of nodes, at least 1.
    size_t m_vertexCount;
    // Node indices, 3 per triangle.
    const int32_t* m_triangles;
    // Number of triangles.
    size_t m_triangleCount;
    // Edges that belong to no triangle, such as those of a rope, 2 node indices each.
    const int32_t* m_edges;
    // Number of edges in m_edges.
    size_t m_edgeCount;
    // Positions at rest, x y z per node, m: they give links their lengths. Null means m_positions.
    const float* m_restPositions;
    // Indices of nodes that the solver does not move.
    const int32_t* m_pins;
    // Number of indices in m_pins.
    size_t m_pinCount;
    // Mass of the whole cloth, kg, above 0; the nodes share it evenly. Ignored with m_masses.
    double m_mass;
    // Mass of each node, kg, above 0; null for m_mass.
    const float* m_masses;
    // Thickness of the cloth, m, above 0. Layers of cloth rest on each other at this distance. Above an obstacle cloth
    // rests at half of it and the obstacle's margin, together 0.1 mm at least.
    double m_thickness;
    // Stiffness of links, above 0 up to 1.
    double m_stiffness;
    // Stiffness of bending links between the opposite nodes of two triangles that share an edge, 0 to 1; 0 for none.
    double m_bendingStiffness;
    // Coefficient of friction, 0 to 1. Multiplied with the obstacle's.
    double m_friction;
    // Share of the velocity that a step takes away, 0 to 1.
    double m_damping;
    // Number of substeps in a step, 1 to 1,000; two at least are made. More of them stretch less.
    int m_iterations;
    // 1: the cloth collides with itself and with other cloth that has 1 here. 0: it passes through both.
    int m_selfCollision;
} ClothDescription;

// An obstacle: a triangle mesh that moves only as the app says.
typedef struct ObstacleDescription
{
    // Positions of the vertices in the obstacle's own frame, x y z each, m.
    const float* m_positions;
    // Number of vertices.
    size_t m_vertexCount;
    // Vertex indices, 3 per triangle.
    const int32_t* m_triangles;
    // Number of triangles, at least 1.
    size_t m_triangleCount;
    // Distance from the surface, m, at least 0; see ClothDescription::m_thickness.
    double m_margin;
    // Coefficient of friction, at least 0. Multiplied with the cloth's.
    double m_friction;
    // 1: only the front is solid, from which triangles run counter-clockwise. 0: both sides are.
    int m_oneSided;
    // Position of the obstacle's frame, m.
    double m_position[3];
    // Rotation of the frame: a quaternion x y z w of any length but 0.
    double m_rotation[4];
} ObstacleDescription;

// A contact of the last step between a cloth and an obstacle.
typedef struct ClothContact
{
    int32_t m_cloth;     // the cloth
    int32_t m_obstacle;  // the obstacle; -1 if it was put into Bullet's world directly
    int32_t m_nodes[3];  // nodes of the cloth's feature; -1 if unused
    float m_weights[3];  // weights of these nodes, with the sum 1
    float m_normal[3];   // unit vector from the obstacle to the cloth
    float m_point[3];    // point on the obstacle, m
    float m_gap;         // distance at the step's predicted end, thickness of the pair subtracted, m
    float m_thickness;   // distance at which the two rest, m
} ClothContact;

// A contact of the last step with what it did: with an obstacle, with another cloth or of a cloth with itself.
typedef struct ClothStepContact
{
    int32_t m_cloth;          // the cloth
    int32_t m_obstacle;       // the obstacle; -1 beside cloth, or if it was put into Bullet's world directly
    int32_t m_triangle;       // a triangle of the obstacle, as given, that has the contact's feature; -1 beside cloth
    int32_t m_other;          // the other cloth, or the same one; -1 beside an obstacle
    int32_t m_nodes[3];       // nodes of the cloth's feature; -1 if unused
    int32_t m_otherNodes[3];  // nodes of the other cloth's feature; -1 if unused
    float m_weights[3];       // weights of the first nodes, with the sum 1
    float m_otherWeights[3];  // weights of the others
    float m_normal[3];        // unit vector from the obstacle or the other feature to the cloth
    float m_point[3];         // point on the obstacle or the other feature, m
    float m_impulse[3];       // given to the cloth in the step, friction included, N s
    float m_gap;              // distance where the step ended, thickness of the pair subtracted, m
    float m_thickness;        // distance at which the two rest, m
    float m_timeOfImpact;     // share of the step, below 1 if the cloth's path met the surface
} ClothStepContact;

// Two triangles of cloth that intersected where the last step began.
typedef struct ClothTriangles
{
    int32_t m_cloths[2];    // the cloth of each triangle; one cloth twice if it intersects itself
    int32_t m_nodes[2][3];  // the nodes of each triangle
} ClothTriangles;

// Bullet's own arrays of a cloth's nodes. They stay where they are, and steps write them. A node's x, y and z are
// adjacent; the next node's begin m_strideBytes later.
typedef struct NodeView
{
    const void* m_positions;   // m
    const void* m_velocities;  // m/s
    const void* m_normals;     // unit
    size_t m_count;            // number of nodes
    size_t m_strideBytes;      // distance from one node to the next
    size_t m_scalarBytes;      // 4 for float; 8 for double, if Bullet is built in double precision
} NodeView;

#ifdef __cplusplus
}
#endif

#endif
