// Finds the side of a triangle mesh that a point is on, and its distance, in double precision for the independent
// check.
//
// The angle-weighted pseudonormal of the closest feature determines the side (Baerentzen and Aanaes 2005). It is right
// for watertight meshes without self-intersections. On closed meshes the generalised winding number confirms a verdict
// "inside" (Jacobson et al. 2013; far groups of triangles count as one dipole, Barill et al. 2018). Self-intersections
// and inner sheets therefore cause no false alarm. At edges of more than two faces the winding number alone decides. On
// open meshes the side is only known away from the boundary.
#pragma once

#include <array>
#include <vector>

#include "scenes/mesh.h"
#include "oracle/triangle_tree.h"

namespace drape
{
class SignedSurface
{
public:
    explicit SignedSurface(const TriangleMesh& mesh);

    const TriangleTree& tree() const { return m_tree; }

    // Every edge is shared by as many faces in one direction as in the other: the surface bounds a solid.
    bool closed() const { return m_closed; }

    // Returns the side of the point at its closest point: +1 outside (in front), −1 inside (behind). Returns 0 if the
    // closest feature is on the boundary of an open mesh, where no side is defined.
    int sideOf(const Vector3& point, const ClosestPoint& closest) const;

    // Returns whether the point is in the solid of a closed mesh, including the winding number.
    bool inside(const Vector3& point, const ClosestPoint& closest) const;

private:
    struct Group  // a tree node's triangles seen from afar
    {
        Vector3 m_area;  // sum of area vectors
        Vector3 m_centre;
        double m_radius = 0;
    };
    struct EdgeSum
    {
        Vector3 m_normal;
        int m_balance = 0;  // faces along the edge minus faces against it
        int m_faces = 0;
    };

    bool simple(const ClosestPoint& closest) const;
    void sumNormals();
    void makeGroups();
    double windingNumber(const Vector3& point) const;
    double solidAngle(const Vector3& point, std::int32_t triangle) const;

    TriangleTree m_tree;
    bool m_closed = true;
    double m_orientation = 1;  // −1: the closed mesh's normals point inwards
    std::vector<Vector3> m_faceNormals;
    std::vector<Vector3> m_vertexNormals;
    std::vector<std::array<EdgeSum, 3>> m_edges;  // per triangle and corner the edge starts from
    std::vector<bool> m_boundaryVertex;
    std::vector<bool> m_tangledVertex;  // at an edge of more than two faces: its pseudonormal means nothing
    std::vector<Group> m_groups;
};
}  // namespace drape
