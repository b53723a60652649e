// Cloth, obstacle and floor as Embree sees them: rays in, surface points out. Metres; threads may trace at the same
// time.
#pragma once

#include <vector>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "tools/cloth_drop/smooth_mesh.h"
#include "scenes/mesh.h"
#include "scenes/vector3.h"

namespace drape
{
enum class Surface
{
    None,
    Cloth,
    Obstacle,
    Floor
};

struct SurfacePoint
{
    Surface m_surface = Surface::None;
    Vector3 m_point;
    Vector3 m_normal;     // smooth, towards the ray's origin
    Vector3 m_flat;       // normal of the triangle, towards the ray's origin
    bool m_back = false;  // seen from the triangle's back
    double m_edge = 1e9;  // m, distance to the nearest edge of ShadedMesh::m_edges of this triangle
};

// Holds the ball that fills a picture, and the height of the floor, which hides everything below. Metres.
struct View
{
    Vector3 m_centre;
    double m_radius = 1;
    double m_floor = 0;
};

// Returns the view of both meshes, on a floor at their lowest vertex. Vertices that are not finite are ignored.
View viewOf(const TriangleMesh& cloth, const TriangleMesh& obstacle);

class RayScene
{
public:
    RayScene(ShadedMesh cloth, ShadedMesh obstacle, const View& view);
    ~RayScene();
    RayScene(const RayScene&) = delete;
    RayScene& operator=(const RayScene&) = delete;

    bool good() const { return m_good; }

    SurfacePoint trace(const Vector3& origin, const Vector3& direction) const;
    bool blocked(const Vector3& origin, const Vector3& direction, double distance) const;

    const View& view() const { return m_view; }

private:
    void addMesh(const TriangleMesh& mesh, int index);

    RTCDevice m_device = nullptr;
    RTCScene m_scene = nullptr;
    ShadedMesh m_meshes[2];  // cloth, obstacle
    View m_view;
    bool m_good = false;
};
}  // namespace drape
