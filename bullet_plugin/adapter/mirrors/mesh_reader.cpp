#include "bullet_plugin/adapter/mirrors/mesh_reader.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "BulletCollision/BroadphaseCollision/btBroadphaseProxy.h"
#include "BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h"
#include "BulletCollision/CollisionShapes/btScaledBvhTriangleMeshShape.h"
#include "BulletCollision/CollisionShapes/btStridingMeshInterface.h"
#include "BulletCollision/Gimpact/btGImpactShape.h"
#include "bullet_plugin/adapter/mirrors/convex_reader.h"
#include "bullet_plugin/adapter/pairs/margins.h"

namespace drape
{
namespace
{
// Number of corners per part that meshSignature() samples: all of a small part's. A larger part has enough samples to
// detect a deformation of the whole mesh, and few enough to cost only a microsecond.
constexpr std::int64_t kSmallPart = 384;
constexpr std::int64_t kSamplesPerPart = 32;

// Number of triangles per part that sampledEdge() measures, some: enough for a mean to within a tenth.
constexpr int kEdgeSamples = 256;

// Vertices of the stretch that a part uses, at most, for each corner of its triangles, for a table of that stretch.
constexpr std::int64_t kStretchPerCorner = 8;

// FNV-1a over 64-bit words (Fowler, Noll, Vo); only equality matters here.
class Hash
{
public:
    void add(std::uint64_t word) { m_value = (m_value ^ word) * 1099511628211ull; }
    void add(double value)
    {
        std::uint64_t word;
        std::memcpy(&word, &value, sizeof(word));
        add(word);
    }
    void add(const btVector3& v)
    {
        for (int axis = 0; axis < 3; ++axis)
            add(static_cast<double>(v[axis]));
    }
    std::uint64_t value() const { return m_value; }

private:
    std::uint64_t m_value = 14695981039346656037ull;
};

// One part of a striding mesh, locked for reading while this object lives.
class LockedPart
{
public:
    LockedPart(const btStridingMeshInterface& mesh, int part) : m_mesh(mesh), m_part(part)
    {
        mesh.getLockedReadOnlyVertexIndexBase(&m_vertices, m_vertexCount, m_vertexType, m_vertexStride, &m_indices,
                                              m_indexStride, m_triangleCount, m_indexType, part);
    }
    ~LockedPart() { m_mesh.unLockReadOnlyVertexBase(m_part); }
    LockedPart(const LockedPart&) = delete;
    LockedPart& operator=(const LockedPart&) = delete;

    int triangleCount() const { return m_triangleCount; }
    const void* vertices() const { return m_vertices; }
    const void* indices() const { return m_indices; }

    btVector3 vertex(std::int64_t i) const
    {
        const unsigned char* at = m_vertices + static_cast<std::ptrdiff_t>(i) * m_vertexStride;
        return m_vertexType == PHY_DOUBLE ? load<double>(at) : load<float>(at);
    }
    std::int64_t index(int triangle, int corner) const
    {
        const unsigned char* at = m_indices + static_cast<std::ptrdiff_t>(triangle) * m_indexStride;
        if (m_indexType == PHY_SHORT) return integer<std::uint16_t>(at, corner);
        if (m_indexType == PHY_UCHAR) return integer<std::uint8_t>(at, corner);
        return integer<std::int32_t>(at, corner);
    }

private:
    template <typename Real>
    static btVector3 load(const unsigned char* at)
    {
        Real value[3];
        std::memcpy(value, at, sizeof(value));
        return btVector3(btScalar(value[0]), btScalar(value[1]), btScalar(value[2]));
    }
    template <typename Integer>
    static std::int64_t integer(const unsigned char* at, int corner)
    {
        Integer value;
        std::memcpy(&value, at + corner * sizeof(Integer), sizeof(value));
        return value;
    }

    const btStridingMeshInterface& m_mesh;
    const int m_part;
    const unsigned char* m_vertices = nullptr;
    const unsigned char* m_indices = nullptr;
    int m_vertexCount = 0, m_vertexStride = 0, m_triangleCount = 0, m_indexStride = 0;
    PHY_ScalarType m_vertexType = PHY_FLOAT, m_indexType = PHY_INTEGER;
};

// The mesh behind a shape and the scaling that the shape and the mesh apply together.
struct ScaledMesh
{
    const btConcaveShape* m_shape;  // the owner of the triangles
    const btStridingMeshInterface* m_mesh;
    btVector3 m_scaling;

    const btStridingMeshInterface& mesh() const { return *m_mesh; }
};

ScaledMesh resolveGImpact(const btGImpactMeshShape& shape)
{
    // The parts have replaced the mesh's scaling by the shape's if that was set.
    const btVector3 scaling =
        shape.getMeshPartCount() > 0 ? shape.getMeshPart(0)->getLocalScaling() : btVector3(1, 1, 1);
    return ScaledMesh{&shape, shape.getMeshInterface(), scaling};
}

ScaledMesh resolve(const btCollisionShape& shape)
{
    if (shape.getShapeType() == GIMPACT_SHAPE_PROXYTYPE)
        return resolveGImpact(static_cast<const btGImpactMeshShape&>(shape));
    if (shape.getShapeType() == SCALED_TRIANGLE_MESH_SHAPE_PROXYTYPE)
    {
        const btScaledBvhTriangleMeshShape& scaled = static_cast<const btScaledBvhTriangleMeshShape&>(shape);
        const btBvhTriangleMeshShape* child = scaled.getChildShape();
        return ScaledMesh{child, child->getMeshInterface(),
                          child->getMeshInterface()->getScaling() * scaled.getLocalScaling()};
    }
    const btBvhTriangleMeshShape& bvh = static_cast<const btBvhTriangleMeshShape&>(shape);
    return ScaledMesh{&bvh, bvh.getMeshInterface(), bvh.getMeshInterface()->getScaling()};
}

// The vertices of a part that its triangles use, in their order. Parts may share one array of vertices, and Bullet
// never reads the number that a part states. Memory: linear in the triangles.
class UsedVertices
{
public:
    explicit UsedVertices(const LockedPart& part)
    {
        std::int64_t low = std::numeric_limits<std::int64_t>::max(), high = -1;
        forEachCorner(part,
                      [&](std::int64_t i)
                      {
                          low = std::min(low, i);
                          high = std::max(high, i);
                      });
        if (high < 0) return;
        if (high - low < kStretchPerCorner * 3 * part.triangleCount())
            readStretch(part, low, high);
        else
            readScattered(part);
    }

    const std::vector<std::int64_t>& indices() const { return m_indices; }
    // Returns the position of a used index among indices(); negative for a negative index.
    std::int32_t place(std::int64_t index) const
    {
        if (index < 0) return -1;
        if (!m_places.empty()) return m_places[static_cast<std::size_t>(index - m_indices[0])];
        return static_cast<std::int32_t>(std::lower_bound(m_indices.begin(), m_indices.end(), index) -
                                         m_indices.begin());
    }

private:
    template <typename Visit>
    static void forEachCorner(const LockedPart& part, Visit visit)
    {
        for (int t = 0; t < part.triangleCount(); ++t)
            for (int k = 0; k < 3; ++k)
            {
                const std::int64_t index = part.index(t, k);
                if (index >= 0) visit(index);
            }
    }
    void readStretch(const LockedPart& part, std::int64_t low, std::int64_t high)
    {
        m_places.assign(static_cast<std::size_t>(high - low + 1), -1);
        forEachCorner(part, [&](std::int64_t i) { m_places[static_cast<std::size_t>(i - low)] = 0; });
        for (std::size_t i = 0; i < m_places.size(); ++i)
        {
            if (m_places[i] < 0) continue;
            m_places[i] = static_cast<std::int32_t>(m_indices.size());
            m_indices.push_back(low + static_cast<std::int64_t>(i));
        }
    }
    void readScattered(const LockedPart& part)
    {
        forEachCorner(part, [&](std::int64_t i) { m_indices.push_back(i); });
        std::sort(m_indices.begin(), m_indices.end());
        m_indices.erase(std::unique(m_indices.begin(), m_indices.end()), m_indices.end());
    }

    std::vector<std::int32_t> m_places;  // by index, from the first used one on; empty where they are scattered
    std::vector<std::int64_t> m_indices;
};

void appendPosition(const btVector3& world, WorldMesh& mesh)
{
    for (int axis = 0; axis < 3; ++axis)
        mesh.m_positions.push_back(static_cast<float>(world[axis]));
}

void appendVertices(const LockedPart& part, const UsedVertices& used, const btVector3& scaling, const btTransform& pose,
                    WorldMesh& mesh)
{
    for (std::int64_t i : used.indices())
        appendPosition(pose * (part.vertex(i) * scaling), mesh);
}

bool isFinite(const WorldMesh& mesh, std::size_t vertex)
{
    const float* at = &mesh.m_positions[3 * vertex];
    return std::isfinite(at[0]) && std::isfinite(at[1]) && std::isfinite(at[2]);
}

// A part's position among the parts of its mesh, and what is done with its triangles.
struct PartReading
{
    int m_part;
    std::size_t m_first;             // index of its first vertex
    bool m_mirrored;                 // corners are reversed, so that a triangle's front stays its front
    const TriangleFilter* m_filter;  // null for all triangles
};

void appendTriangles(const LockedPart& part, const UsedVertices& used, const PartReading& reading, WorldMesh& mesh)
{
    for (int t = 0; t < part.triangleCount(); ++t)
    {
        if (reading.m_filter && !(*reading.m_filter)(reading.m_part, t)) continue;
        std::int32_t corners[3];
        bool usable = true;
        for (int k = 0; k < 3; ++k)
        {
            const std::int32_t place = used.place(part.index(t, k));
            corners[k] = static_cast<std::int32_t>(reading.m_first) + place;
            usable = usable && place >= 0 && isFinite(mesh, static_cast<std::size_t>(corners[k]));
        }
        if (reading.m_mirrored) std::swap(corners[1], corners[2]);
        if (!usable) continue;
        mesh.m_triangles.insert(mesh.m_triangles.end(), corners, corners + 3);
        mesh.m_names.add(reading.m_part, t);
    }
}

// Appends all parts of a mesh shape.
void appendParts(const btCollisionShape& shape, const btTransform& pose, const TriangleFilter* filter, WorldMesh& mesh)
{
    const ScaledMesh source = resolve(shape);
    const bool mirrored = source.m_scaling.x() * source.m_scaling.y() * source.m_scaling.z() < 0;
    for (int p = 0; p < source.mesh().getNumSubParts(); ++p)
    {
        const LockedPart part(source.mesh(), p);
        const UsedVertices used(part);
        const PartReading reading = {p, mesh.m_positions.size() / 3, mirrored, filter};
        appendVertices(part, used, source.m_scaling, pose, mesh);
        appendTriangles(part, used, reading, mesh);
    }
}

void appendConvex(const btConvexShape& shape, const btTransform& pose, WorldMesh& mesh)
{
    std::vector<btVector3> vertices;
    readConvex(shape, vertices, mesh.m_triangles);
    for (const btVector3& vertex : vertices)
        appendPosition(pose * vertex, mesh);
}

void appendSurface(const btCollisionShape& shape, const btTransform& pose, const ReadPart& part, WorldMesh& mesh)
{
    std::vector<btVector3> vertices;
    readSurface(shape, part.m_boxes, part.m_filter ? *part.m_filter : TriangleFilter(), vertices, mesh.m_triangles,
                &mesh.m_names);
    for (const btVector3& vertex : vertices)
        appendPosition(pose * vertex, mesh);
}

// Returns a number that changes with the points and the type of a shape.
std::uint64_t signatureOf(const btCollisionShape& shape, const std::vector<btVector3>& points)
{
    Hash hash;
    hash.add(std::uint64_t(shape.getShapeType()));
    for (const btVector3& point : points)
        hash.add(point);
    return hash.value();
}

// Adds the length of a triangle's edges, m. Ignores edges that are not finite or have a negative index.
void addEdges(const LockedPart& part, int triangle, const btVector3& scaling, double& sum, int& count)
{
    for (int k = 0; k < 3; ++k)
    {
        const std::int64_t from = part.index(triangle, k), to = part.index(triangle, (k + 1) % 3);
        if (from < 0 || to < 0) continue;
        const double length = double(((part.vertex(from) - part.vertex(to)) * scaling).length());
        if (!std::isfinite(length)) continue;
        sum += length;
        ++count;
    }
}

// A vertex that is not finite belongs to no triangle any more; zero keeps it out of every minimum and maximum.
void clearInvalid(std::vector<float>& positions)
{
    for (float& value : positions)
        if (!std::isfinite(value)) value = 0;
}
}  // namespace

bool isReadableType(int shapeType)
{
    return shapeType == TRIANGLE_MESH_SHAPE_PROXYTYPE || shapeType == SCALED_TRIANGLE_MESH_SHAPE_PROXYTYPE ||
           shapeType == MULTIMATERIAL_TRIANGLE_MESH_PROXYTYPE || shapeType == GIMPACT_SHAPE_PROXYTYPE ||
           isConvexType(shapeType) || isSurfaceType(shapeType);
}

bool isMeshShape(const btCollisionShape& shape)
{
    if (isConvexShape(shape) || isSurfaceShape(shape)) return false;
    if (shape.getShapeType() != GIMPACT_SHAPE_PROXYTYPE) return isReadableType(shape.getShapeType());
    const auto kind = static_cast<const btGImpactShapeInterface&>(shape).getGImpactShapeType();
    return kind == CONST_GIMPACT_TRIMESH_SHAPE;
}

bool isReadable(const btCollisionShape& shape)
{
    return isMeshShape(shape) || isConvexShape(shape) || isSurfaceShape(shape);
}

btScalar meshMargin(const btCollisionShape& shape)
{
    return isConvexShape(shape) ? convexMargin(shape) : marginOf(shape);
}

const btCollisionShape* meshShapeOf(const btCollisionShape& shape)
{
    return isMeshShape(shape) ? resolve(shape).m_shape : &shape;
}

btScalar marginBeyondBounds(const btCollisionShape& shape)
{
    if (shape.getShapeType() == GIMPACT_SHAPE_PROXYTYPE || !isMeshShape(shape)) return 0;
    return std::max(btScalar(0), marginOf(shape) - resolve(shape).m_shape->getMargin());
}

double sampledEdge(const btCollisionShape& shape)
{
    if (!isMeshShape(shape)) return 0;
    const ScaledMesh source = resolve(shape);
    double sum = 0;
    int count = 0;
    for (int p = 0; p < source.mesh().getNumSubParts(); ++p)
    {
        const LockedPart part(source.mesh(), p);
        const int stride = std::max(1, part.triangleCount() / kEdgeSamples);
        for (int triangle = 0; triangle < part.triangleCount(); triangle += stride)
            addEdges(part, triangle, source.m_scaling, sum, count);
    }
    return count > 0 ? sum / count : 0;
}

void readMesh(const btCollisionShape& shape, const btTransform& pose, const ReadPart& part, WorldMesh& mesh)
{
    mesh.m_triangles.clear();
    mesh.m_names.clear();
    mesh.m_positions.clear();
    if (isConvexShape(shape))
        appendConvex(static_cast<const btConvexShape&>(shape), pose, mesh);
    else if (isSurfaceShape(shape))
        appendSurface(shape, pose, part, mesh);
    else
        appendParts(shape, pose, part.m_filter, mesh);
    clearInvalid(mesh.m_positions);

    Hash topology, positions;
    topology.add(std::uint64_t(mesh.m_positions.size()));
    for (std::int32_t index : mesh.m_triangles)
        topology.add(std::uint64_t(index));
    for (float value : mesh.m_positions)
        positions.add(double(value));
    mesh.m_topologyHash = topology.value();
    mesh.m_positionHash = positions.value();
}

std::uint64_t meshSignature(const btCollisionShape& shape, const ReadPart& read)
{
    std::vector<btVector3> points;
    if (isConvexShape(shape)) listSurface(static_cast<const btConvexShape&>(shape), points);
    if (isSurfaceShape(shape)) sampleSurface(shape, read.m_boxes, points);
    if (!isMeshShape(shape)) return signatureOf(shape, points);
    const ScaledMesh source = resolve(shape);
    Hash hash;
    hash.add(std::uint64_t(reinterpret_cast<std::uintptr_t>(&source.mesh())));
    hash.add(source.m_scaling);
    btVector3 low, high;
    source.m_shape->getAabb(btTransform::getIdentity(), low, high);
    hash.add(low);
    hash.add(high);
    for (int p = 0; p < source.mesh().getNumSubParts(); ++p)
    {
        const LockedPart part(source.mesh(), p);
        hash.add(std::uint64_t(reinterpret_cast<std::uintptr_t>(part.vertices())));
        hash.add(std::uint64_t(reinterpret_cast<std::uintptr_t>(part.indices())));
        hash.add(std::uint64_t(part.triangleCount()));
        const std::int64_t corners = 3 * std::int64_t(part.triangleCount());
        std::int64_t stride = corners <= kSmallPart ? 1 : corners / kSamplesPerPart;
        if (stride % 3 == 0) ++stride;  // the first corners alone, else
        for (std::int64_t i = 0; i < corners; i += stride)
        {
            const std::int64_t corner = part.index(int(i / 3), int(i % 3));
            if (corner >= 0) hash.add(part.vertex(corner));
        }
    }
    return hash.value();
}
}  // namespace drape
