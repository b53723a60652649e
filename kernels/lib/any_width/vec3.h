// Vectors of three numbers for any width; see one.h and ../vec3.h.

DRAPE_FUNCTION Real drapeMin(Real a, Real b)
{
    return choose(b < a, b, a);
}
DRAPE_FUNCTION Real drapeMax(Real a, Real b)
{
    return choose(a < b, b, a);
}
DRAPE_FUNCTION Real drapeClamp01(Real a)
{
    return drapeMin(drapeMax(a, splat(0.0f)), splat(1.0f));
}

DRAPE_FUNCTION RealVec3 vec3(Real x, Real y, Real z)
{
    RealVec3 v;
    v.x = x;
    v.y = y;
    v.z = z;
    return v;
}
DRAPE_FUNCTION RealVec3 vec3Add(RealVec3 a, RealVec3 b)
{
    return vec3(a.x + b.x, a.y + b.y, a.z + b.z);
}
DRAPE_FUNCTION RealVec3 vec3Sub(RealVec3 a, RealVec3 b)
{
    return vec3(a.x - b.x, a.y - b.y, a.z - b.z);
}
DRAPE_FUNCTION RealVec3 vec3Scale(RealVec3 a, Real s)
{
    return vec3(a.x * s, a.y * s, a.z * s);
}
// a + s·b
DRAPE_FUNCTION RealVec3 vec3AddScaled(RealVec3 a, RealVec3 b, Real s)
{
    return vec3(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z);
}
DRAPE_FUNCTION RealVec3 vec3Mix(RealVec3 a, RealVec3 b, Real t)
{
    return vec3AddScaled(a, vec3Sub(b, a), t);
}
DRAPE_FUNCTION RealVec3 vec3Least(RealVec3 a, RealVec3 b)
{
    return vec3(drapeMin(a.x, b.x), drapeMin(a.y, b.y), drapeMin(a.z, b.z));
}
DRAPE_FUNCTION RealVec3 vec3Most(RealVec3 a, RealVec3 b)
{
    return vec3(drapeMax(a.x, b.x), drapeMax(a.y, b.y), drapeMax(a.z, b.z));
}
DRAPE_FUNCTION Real vec3Dot(RealVec3 a, RealVec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
DRAPE_FUNCTION RealVec3 vec3Cross(RealVec3 a, RealVec3 b)
{
    return vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
DRAPE_FUNCTION Real vec3Length(RealVec3 a)
{
    return drapeSqrt(vec3Dot(a, a));
}
DRAPE_FUNCTION Real vec3Norm1(RealVec3 a)
{
    return drapeAbs(a.x) + drapeAbs(a.y) + drapeAbs(a.z);
}
DRAPE_FUNCTION Real vec3NormMax(RealVec3 a)
{
    return drapeMax(drapeMax(drapeAbs(a.x), drapeAbs(a.y)), drapeAbs(a.z));
}
