#include "tools/cloth_drop/ray_scene.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace drape
{
namespace
{
// Corners whose smooth normal leans farther than 40 degrees from the face are creases and are drawn flat.
constexpr double kCreaseCosine = 0.766;

// The floor hides points deeper than this below it, in radii of the view. Larger than the rounding of points on it.
constexpr double kFloorDepth = 1e-4;

RTCRay makeRay(const Vector3& origin, const Vector3& direction, double distance)
{
    RTCRay ray{};
    ray.org_x = static_cast<float>(origin.x);
    ray.org_y = static_cast<float>(origin.y);
    ray.org_z = static_cast<float>(origin.z);
    ray.dir_x = static_cast<float>(direction.x);
    ray.dir_y = static_cast<float>(direction.y);
    ray.dir_z = static_cast<float>(direction.z);
    ray.tfar = static_cast<float>(distance);
    ray.mask = 0xffffffffu;
    return ray;
}

// Returns the distance from the point with these weights to the triangle's nearest edge that is drawn.
double distanceToEdge(const ShadedMesh& shaded, unsigned triangle, const double weights[3])
{
    const std::int32_t* corner = &shaded.m_mesh.m_triangles[3 * static_cast<std::size_t>(triangle)];
    Vector3 points[3];
    for (int i = 0; i < 3; ++i)
    {
        const float* p = &shaded.m_mesh.m_positions[3 * static_cast<std::size_t>(corner[i])];
        points[i] = {p[0], p[1], p[2]};
    }
    const double area = length(cross(points[1] - points[0], points[2] - points[0]));
    double nearest = SurfacePoint().m_edge;
    for (int i = 0; i < 3; ++i)
        if ((shaded.m_edges[triangle] >> i & 1) != 0)
            nearest = std::min(nearest, weights[(i + 2) % 3] * area / length(points[(i + 1) % 3] - points[i]));
    return nearest;
}

// Embree 4 dropped the context that version 3 asks for.
#if RTC_VERSION_MAJOR >= 4
void intersect(RTCScene scene, RTCRayHit& query)
{
    rtcIntersect1(scene, &query);
}
void occlude(RTCScene scene, RTCRay& ray)
{
    rtcOccluded1(scene, &ray);
}
#else
void intersect(RTCScene scene, RTCRayHit& query)
{
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &query);
}
void occlude(RTCScene scene, RTCRay& ray)
{
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, &ray);
}
#endif
}  // namespace

View viewOf(const TriangleMesh& cloth, const TriangleMesh& obstacle)
{
    constexpr double kFar = std::numeric_limits<double>::infinity();
    double low[3] = {kFar, kFar, kFar}, high[3] = {-kFar, -kFar, -kFar};
    for (const TriangleMesh* mesh : {&cloth, &obstacle})
        for (std::size_t i = 0; i < mesh->m_positions.size(); ++i)
        {
            const double value = mesh->m_positions[i];
            if (!std::isfinite(value)) continue;
            low[i % 3] = std::min(low[i % 3], value);
            high[i % 3] = std::max(high[i % 3], value);
        }
    const Vector3 first = {low[0], low[1], low[2]}, last = {high[0], high[1], high[2]};
    View view;
    view.m_centre = 0.5 * (first + last);
    view.m_radius = std::max(0.5 * length(last - first), 1e-6);
    view.m_floor = first.y;
    return view;
}

RayScene::RayScene(ShadedMesh cloth, ShadedMesh obstacle, const View& view)
    : m_meshes{std::move(cloth), std::move(obstacle)}, m_view(view)
{
    m_device = rtcNewDevice(nullptr);
    if (m_device == nullptr) return;
    m_scene = rtcNewScene(m_device);
    for (int index = 0; index < 2; ++index)
        addMesh(m_meshes[index].m_mesh, index);
    rtcCommitScene(m_scene);
    m_good = rtcGetDeviceError(m_device) == RTC_ERROR_NONE;
}

RayScene::~RayScene()
{
    if (m_scene != nullptr) rtcReleaseScene(m_scene);
    if (m_device != nullptr) rtcReleaseDevice(m_device);
}

void RayScene::addMesh(const TriangleMesh& mesh, int index)
{
    if (mesh.m_triangles.empty()) return;
    RTCGeometry geometry = rtcNewGeometry(m_device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                             mesh.vertexCount());
    void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned),
                                            mesh.triangleCount());
    if (vertices != nullptr) std::memcpy(vertices, mesh.m_positions.data(), mesh.m_positions.size() * sizeof(float));
    if (indices != nullptr)
        std::memcpy(indices, mesh.m_triangles.data(), mesh.m_triangles.size() * sizeof(std::int32_t));
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(m_scene, geometry, static_cast<unsigned>(index));
    rtcReleaseGeometry(geometry);
}

SurfacePoint RayScene::trace(const Vector3& origin, const Vector3& direction) const
{
    RTCRayHit query{};
    query.ray = makeRay(origin, direction, std::numeric_limits<float>::infinity());
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    intersect(m_scene, query);
    SurfacePoint hit;
    const double height = origin.y + static_cast<double>(query.ray.tfar) * direction.y;
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID || height < m_view.m_floor - kFloorDepth * m_view.m_radius)
    {
        const double toFloor = direction.y < 0 ? (m_view.m_floor - origin.y) / direction.y : -1;
        if (toFloor <= 0) return hit;
        hit.m_surface = Surface::Floor;
        hit.m_point = origin + toFloor * direction;
        hit.m_normal = hit.m_flat = {0, 1, 0};
        return hit;
    }
    const ShadedMesh& shaded = m_meshes[query.hit.geomID];
    const std::int32_t* corner = &shaded.m_mesh.m_triangles[3 * static_cast<std::size_t>(query.hit.primID)];
    const double weights[3] = {1.0 - query.hit.u - query.hit.v, query.hit.u, query.hit.v};
    hit.m_flat = normalized({query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z});
    for (int i = 0; i < 3; ++i)
    {
        const Vector3& smooth = shaded.m_normals[static_cast<std::size_t>(corner[i])];
        const bool flat = shaded.m_creases && dot(smooth, hit.m_flat) < kCreaseCosine;
        hit.m_normal += weights[i] * (flat ? hit.m_flat : smooth);
    }
    if (!shaded.m_edges.empty()) hit.m_edge = distanceToEdge(shaded, query.hit.primID, weights);
    hit.m_surface = query.hit.geomID == 0 ? Surface::Cloth : Surface::Obstacle;
    hit.m_point = origin + static_cast<double>(query.ray.tfar) * direction;
    hit.m_back = dot(hit.m_flat, direction) > 0;
    const double towards = hit.m_back ? -1 : 1;
    hit.m_flat = towards * hit.m_flat;
    hit.m_normal = towards * normalized(hit.m_normal);
    return hit;
}

bool RayScene::blocked(const Vector3& origin, const Vector3& direction, double distance) const
{
    RTCRay ray = makeRay(origin, direction, distance);
    occlude(m_scene, ray);
    return ray.tfar < 0;
}
}  // namespace drape
