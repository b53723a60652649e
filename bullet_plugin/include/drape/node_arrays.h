// Arrays of a caller's own for the nodes of a soft body.
#pragma once

namespace drape
{
// x y z per node in the order of btSoftBody::m_nodes, adjacent. Null leaves an array out.
struct NodeArrays
{
    float* m_positions = nullptr;   // m, world frame
    float* m_velocities = nullptr;  // m/s
    float* m_normals = nullptr;     // unit, as btSoftBody::updateNormals() computes them from the faces
};
}  // namespace drape
