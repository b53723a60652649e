// Bullet's own collision with other settings than its defaults.
#pragma once

#include <BulletSoftBody/btSoftBody.h>

namespace drape
{
// Gives the distance field enough cells, so that none is thrown away, and voxels smaller than the width of the bunny's
// ears.
inline void tuneField(btSoftBodyWorldInfo& info)
{
    constexpr int kHashSize = 1048573, kCells = 16000000;
    constexpr btScalar kVoxel = 0.05f;  // m
    info.m_sparsesdf.Initialize(kHashSize, kCells);
    info.m_sparsesdf.setDefaultVoxelsz(kVoxel);
    info.m_sparsesdf.Reset();  // only now the voxel size counts
}
}  // namespace drape
