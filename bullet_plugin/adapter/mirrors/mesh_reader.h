// Reads a Bullet triangle mesh shape: all parts, strides, float or double vertices, 8, 16 or 32 bit indices, scaling.
//
// Input: a mesh, a convex shape (convex_reader.h) or a surface (surface_reader.h), and a pose. Output: triangles and
// world positions (m) for the core, transformed in btScalar before they are rounded to float. Unused vertices are left
// out, and so are triangles with a negative index or a vertex that is not finite. Like Bullet, this trusts indices and
// not the number of vertices that a part states. Cost: a few passes over the mesh; meshSignature() reads a bounded
// number of a mesh's vertices.
#pragma once

#include <cstdint>
#include <vector>

#include "LinearMath/btTransform.h"
#include "bullet_plugin/adapter/mirrors/surface_reader.h"
#include "bullet_plugin/adapter/mirrors/triangle_names.h"

class btCollisionShape;

namespace drape
{
struct WorldMesh
{
    std::vector<std::int32_t> m_triangles;  // 3 per triangle
    TriangleNames m_names;                  // the triangles as Bullet names them; none of a convex shape
    std::vector<float> m_positions;         // x y z per vertex, m, world frame
    std::uint64_t m_topologyHash = 0;       // hash of the triangles and the number of vertices
    std::uint64_t m_positionHash = 0;
};

// The part of a shape that is read.
struct ReadPart
{
    std::vector<SurfaceBox> m_boxes;           // a surface around cloth, in its own frame
    const TriangleFilter* m_filter = nullptr;  // a mesh or height field; null for all triangles
};

// Returns whether readMesh() may accept shapes of that type.
bool isReadableType(int shapeType);
// btBvhTriangleMeshShape, btScaledBvhTriangleMeshShape, btMultimaterialTriangleMeshShape, btGImpactMeshShape.
bool isMeshShape(const btCollisionShape& shape);
// Returns whether readMesh() accepts the shape.
bool isReadable(const btCollisionShape& shape);

// Returns how far the surface with which cloth collides lies outside of the mesh, m, at least 0.
btScalar meshMargin(const btCollisionShape& shape);

// The shape that owns the triangles: the child of a scaled shape, else the shape itself.
const btCollisionShape* meshShapeOf(const btCollisionShape& shape);

// Returns the part of its margin that Bullet's bounds of the shape lack, m, at least 0. Bounds of a scaled shape
// include its child's margin, and a negative margin makes them smaller than the mesh.
btScalar marginBeyondBounds(const btCollisionShape& shape);

// Returns the mean edge of a mesh's triangles, m, from samples of each part; 0 for shapes that are no mesh.
double sampledEdge(const btCollisionShape& shape);

void readMesh(const btCollisionShape& shape, const btTransform& pose, const ReadPart& part, WorldMesh& mesh);

// Changes when the mesh's arrays, counts, scaling, bounding box or one of the sampled vertices change. All points of a
// convex shape count (listSurface()), some 480 of a round one, and samples of a surface (sampleSurface()).
std::uint64_t meshSignature(const btCollisionShape& shape, const ReadPart& part);
}  // namespace drape
