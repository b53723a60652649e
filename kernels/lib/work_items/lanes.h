// One value per lane. Lanes is a vector of DRAPE_LANES floats where a work-item computes a whole block (CPUs, in
// OpenCL C and in the host's kernels). It is one float where each work-item of a group is a lane (GPUs), and
// elsewhere in C++, where a block is one lane.
//
// Products (lanesFma(), lanesDot…, lanesCross…) and lanesSqrt() are only for values that are compared with a slack:
// fma and the built-in functions round differently between platforms. The other functions round as written;
// the texts of any_width rely on it.
#ifndef DRAPE_LIB_LANES_H
#define DRAPE_LIB_LANES_H

#include "../../shared/patch.h"
#include "../geometry/vec3.h"

DRAPE_NAMESPACE_BEGIN

// Maximum error of lanesSqrt(), as a share of the root. A cull's slack is more than 4e-4 of its reach and of the
// motion, 2e-4 of a feature; a root of any of these errs by a twentieth of the slack.
#define DRAPE_ROOT_ERROR 1e-5f

// A group's shared data (see simd_group.h) lies in local memory if its lanes are a group's work-items: private memory
// would store it once per lane.
#if defined(__OPENCL_VERSION__) && DRAPE_LANES == 1
#define DRAPE_GROUP_MEMORY __local
#else
#define DRAPE_GROUP_MEMORY
#endif

#ifdef DRAPE_CPU_KERNELS
#include "host_lanes.h"
#elif defined(__OPENCL_VERSION__) && DRAPE_LANES > 1
#define DRAPE_PASTE(a, b) a##b
#define DRAPE_VECTOR(type, lanes) DRAPE_PASTE(type, lanes)
typedef DRAPE_VECTOR(float, DRAPE_LANES) Lanes;
typedef DRAPE_VECTOR(int, DRAPE_LANES) LaneMask;
#define lanesLoad(block, component) DRAPE_VECTOR(vload, DRAPE_LANES)(component, block)
#define lanesStore(lanes, block, component) DRAPE_VECTOR(vstore, DRAPE_LANES)(lanes, component, block)
#define lanesLoadIds(rows, row) DRAPE_VECTOR(as_int, DRAPE_LANES)(DRAPE_VECTOR(vload, DRAPE_LANES)(row, rows))
#define lanesSelect(mask, yes, no) select((Lanes)(no), (Lanes)(yes), mask)
#define lanesNot(mask) (~(mask))
#define lanesSplat(a) ((Lanes)(a))
#define lanesMaskSplat(a) ((LaneMask)(-(a)))
#else
typedef float Lanes;
typedef int LaneMask;
#ifdef __OPENCL_VERSION__
#define lanesLoad(block, component) ((block)[DRAPE_PATCH_WIDTH * (component) + get_local_id(0) % DRAPE_PATCH_WIDTH])
#else
#define lanesLoad(block, component) ((block)[component])
#endif
#define lanesSelect(mask, yes, no) ((mask) ? (yes) : (no))
#define lanesNot(mask) (!(mask))
#define lanesSplat(a) (a)
#define lanesMaskSplat(a) (a)
#endif

#if defined(DRAPE_LANES) && DRAPE_LANES > 1
// One lane's number.
DRAPE_FUNCTION float laneOf(const Lanes* lanes, DRAPE_UINT lane)
{
    return ((const float*)lanes)[lane];
}
// Returns a, not the number, for a number and NaN: on a CPU fmax and fmin take three more instructions to return the
// number.
#ifndef DRAPE_CPU_KERNELS
DRAPE_FUNCTION Lanes lanesMax(Lanes a, Lanes b)
{
    return a < b ? b : a;
}
DRAPE_FUNCTION Lanes lanesMin(Lanes a, Lanes b)
{
    return b < a ? b : a;
}
#endif
#elif defined(__OPENCL_VERSION__)
#define lanesMax(a, b) fmax(a, b)
#define lanesMin(a, b) fmin(a, b)
#else
#define lanesMax(a, b) drapeMax(a, b)
#define lanesMin(a, b) drapeMin(a, b)
#endif

#ifdef __OPENCL_VERSION__
#define lanesAbs(a) fabs(a)
// Uses the device's own root if its error is known (PatchCullStage::defines()): with a correctly rounded root a GPU's
// cull takes a tenth longer.
#ifdef DRAPE_NATIVE_ROOTS
#define lanesSqrt(a) native_sqrt(a)
#else
#define lanesSqrt(a) sqrt(a)
#endif
#define lanesFma(a, b, c) fma(a, b, c)
#else
#ifndef DRAPE_CPU_KERNELS
#define lanesAbs(a) drapeAbs(a)
#define lanesSqrt(a) drapeSqrt(a)
#endif
#define lanesFma(a, b, c) ((a) * (b) + (c))
#endif

typedef struct LanesVec3
{
    Lanes x, y, z;
} LanesVec3;

DRAPE_FUNCTION LanesVec3 lanesVec3(Lanes x, Lanes y, Lanes z)
{
    LanesVec3 v;
    v.x = x;
    v.y = y;
    v.z = z;
    return v;
}
// Loads three components of a block, from component `first` on.
DRAPE_FUNCTION LanesVec3 lanesLoadVec3(const DRAPE_GLOBAL float* block, int first)
{
    return lanesVec3(lanesLoad(block, first), lanesLoad(block, first + 1), lanesLoad(block, first + 2));
}
DRAPE_FUNCTION LanesVec3 lanesSubUniform(LanesVec3 a, Vec3 b)
{
    return lanesVec3(a.x - b.x, a.y - b.y, a.z - b.z);
}
DRAPE_FUNCTION LanesVec3 lanesFromUniform(Vec3 a, LanesVec3 b)
{
    return lanesVec3(a.x - b.x, a.y - b.y, a.z - b.z);
}
DRAPE_FUNCTION LanesVec3 lanesSub(LanesVec3 a, LanesVec3 b)
{
    return lanesVec3(a.x - b.x, a.y - b.y, a.z - b.z);
}
DRAPE_FUNCTION Lanes lanesDot(LanesVec3 a, LanesVec3 b)
{
    return lanesFma(a.x, b.x, lanesFma(a.y, b.y, a.z * b.z));
}
DRAPE_FUNCTION Lanes lanesDotUniform(LanesVec3 a, Vec3 b)
{
    return lanesFma(a.x, lanesSplat(b.x), lanesFma(a.y, lanesSplat(b.y), a.z * b.z));
}
DRAPE_FUNCTION LanesVec3 lanesCross(LanesVec3 a, LanesVec3 b)
{
    return lanesVec3(lanesFma(a.y, b.z, -a.z * b.y), lanesFma(a.z, b.x, -a.x * b.z), lanesFma(a.x, b.y, -a.y * b.x));
}
DRAPE_FUNCTION LanesVec3 lanesCrossUniform(Vec3 a, LanesVec3 b)
{
    return lanesVec3(lanesFma(lanesSplat(a.y), b.z, -a.z * b.y), lanesFma(lanesSplat(a.z), b.x, -a.x * b.z),
                     lanesFma(lanesSplat(a.x), b.y, -a.y * b.x));
}
DRAPE_FUNCTION Lanes lanesNorm1(LanesVec3 a)
{
    return lanesAbs(a.x) + lanesAbs(a.y) + lanesAbs(a.z);
}

DRAPE_NAMESPACE_END

#endif
