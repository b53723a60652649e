// Reads planes and height fields near cloth: one triangle of a plane, and the cells of a height field under boxes.
//
// Input: a shape that isSurfaceShape() accepts, and boxes in its own frame, m, scaling included. Output: triangles
// whose fronts are those of Bullet's, with shared vertices, in the order of their cells. A plane's triangle covers all
// boxes, a height field's cells each box at any height. Cost: linear in the cells under the boxes, whatever the field's
// size.
#pragma once

#include <cstdint>
#include <vector>

#include "BulletCollision/CollisionShapes/btConcaveShape.h"
#include "bullet_plugin/adapter/mirrors/triangle_names.h"
#include "drape/plugin.h"

namespace drape
{
struct SurfaceBox
{
    btVector3 m_low, m_high;  // m

    void grow(const btVector3& margin)
    {
        m_low -= margin;
        m_high += margin;
    }
    bool contains(const SurfaceBox& other) const
    {
        for (int axis = 0; axis < 3; ++axis)
            if (!(other.m_low[axis] >= m_low[axis] && other.m_high[axis] <= m_high[axis])) return false;
        return true;
    }
    // Returns the box's bounds in another frame.
    SurfaceBox in(const btTransform& frame) const;
    void add(const SurfaceBox& other)
    {
        m_low.setMin(other.m_low);
        m_high.setMax(other.m_high);
    }
    // Returns by how much a box of cloth is grown for nodes that links pull off their paths, m.
    btVector3 slack() const
    {
        const btVector3 size = m_high - m_low;
        const btScalar most = size[size.maxAxis()] / 4;
        return btVector3(most, most, most);
    }
};

bool isSurfaceType(int shapeType);
// btStaticPlaneShape, btHeightfieldTerrainShape.
bool isSurfaceShape(const btCollisionShape& shape);

// Returns whether a surface at that pose, of that reach (m) to both sides, may meet a box of the world. A height field
// may wherever its bounds do. False for a box that is not finite.
bool surfaceMeets(const btCollisionShape& shape, const btTransform& pose, const SurfaceBox& box, btScalar reach);

// Returns bounds, in the world, of the part of the surface that lies over or under a box: infinite along a plane.
SurfaceBox surfaceBounds(const btCollisionShape& shape, const btTransform& pose, const SurfaceBox& box);

// Returns whether the boxes cover at most as many cells as a step reads.
bool isSurfaceReadable(const btCollisionShape& shape, const std::vector<SurfaceBox>& boxes);

// filter: of the triangles of a height field; null for all. names: gets their names, which are 0 for a plane's
// triangle; null for none.
void readSurface(const btCollisionShape& shape, const std::vector<SurfaceBox>& boxes, const TriangleFilter& filter,
                 std::vector<btVector3>& vertices, std::vector<std::int32_t>& triangles,
                 TriangleNames* names = nullptr);

// Lists vertices that change with the surface in the boxes: at 36 places of each box.
void sampleSurface(const btCollisionShape& shape, const std::vector<SurfaceBox>& boxes, std::vector<btVector3>& points);
}  // namespace drape
