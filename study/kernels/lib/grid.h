// A uniform grid over an obstacle: which cells a volume's box covers.
//
// Method: S. Green, CUDA Particles, 2008 (entries sorted by cell); M. Teschner et al., Optimized Spatial Hashing for
// Collision Detection of Deformable Objects, 2003 (objects in every cell that their box covers). The grid is bounded,
// so a cell's index is its key and nothing collides. What lies outside belongs to the cells at the border.
#ifndef DRAPE_STUDY_GRID_H
#define DRAPE_STUDY_GRID_H

#include "../../../kernels/lib/geometry/dop.h"

DRAPE_NAMESPACE_BEGIN

#define DRAPE_GRID_BITS 6
#define DRAPE_GRID_SIDE (1u << DRAPE_GRID_BITS)
// Key of an entry that is not used: behind all cells.
#define DRAPE_GRID_CELLS (1u << (3 * DRAPE_GRID_BITS))

typedef struct GridFrame
{
    Vec3 m_origin;
    float m_perMetre;  // cells
} GridFrame;

// Never falls where x rises, so boxes that overlap share a cell, however x is rounded.
DRAPE_FUNCTION DRAPE_UINT gridCell(float x, float origin, float perMetre)
{
    const float cell = (x - origin) * perMetre;
    if (!(cell > 0.0f)) return 0u;
    return cell < (float)(DRAPE_GRID_SIDE - 1u) ? (DRAPE_UINT)cell : DRAPE_GRID_SIDE - 1u;
}

DRAPE_FUNCTION DRAPE_UINT gridKey(DRAPE_UINT x, DRAPE_UINT y, DRAPE_UINT z)
{
    return x | y << DRAPE_GRID_BITS | z << (2 * DRAPE_GRID_BITS);
}

typedef struct GridRange
{
    DRAPE_UINT m_first[3], m_last[3];
} GridRange;

DRAPE_FUNCTION float gridOrigin(GridFrame frame, int axis)
{
    return axis == 0 ? frame.m_origin.x : axis == 1 ? frame.m_origin.y : frame.m_origin.z;
}

// The cells that a volume's box covers. Returns whether it covers any.
DRAPE_FUNCTION int gridRange(GridRange* range, const DRAPE_GLOBAL BvhNode* node, GridFrame frame)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        if (!(node->m_low[axis] <= node->m_high[axis])) return 0;
        range->m_first[axis] = gridCell(node->m_low[axis], gridOrigin(frame, axis), frame.m_perMetre);
        range->m_last[axis] = gridCell(node->m_high[axis], gridOrigin(frame, axis), frame.m_perMetre);
    }
    return 1;
}

// The one cell in which a pair of volumes counts: that of the lower corner of what their boxes have in common.
DRAPE_FUNCTION DRAPE_UINT gridPairKey(const DRAPE_GLOBAL BvhNode* a, const DRAPE_GLOBAL BvhNode* b, GridFrame frame)
{
    DRAPE_UINT cell[3];
    for (int axis = 0; axis < 3; ++axis)
        cell[axis] = gridCell(drapeMax(a->m_low[axis], b->m_low[axis]), gridOrigin(frame, axis), frame.m_perMetre);
    return gridKey(cell[0], cell[1], cell[2]);
}

DRAPE_NAMESPACE_END

#endif
