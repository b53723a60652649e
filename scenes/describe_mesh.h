// Describes a mesh for the collision pipeline. The mesh must outlive the description.
#pragma once

#include "bullet_plugin/core/pipeline/pipeline.h"
#include "scenes/mesh.h"

namespace drape
{
inline MeshDescription describeMesh(const TriangleMesh& mesh)
{
    MeshDescription description;
    description.m_triangles = mesh.m_triangles.data();
    description.m_triangleCount = mesh.triangleCount();
    description.m_positions = mesh.m_positions.data();
    description.m_vertexCount = mesh.vertexCount();
    return description;
}
}  // namespace drape
