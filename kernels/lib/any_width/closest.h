// Closest points for any width; see one.h and ../closest.h.

// 0 where the denominator vanishes: the numerator does too, and any point of the degenerate feature is as near.
DRAPE_FUNCTION Real drapeRatio(Real numerator, Real denominator)
{
    return choose(denominator > 0.0f, numerator / denominator, splat(0.0f));
}

// Barycentric weights of a point of triangle abc on an edge, given the second corner's, or inside, given b's and c's.
DRAPE_FUNCTION RealVec3 weightsOnAB(Real b)
{
    return vec3(1.0f - b, b, splat(0.0f));
}
DRAPE_FUNCTION RealVec3 weightsOnAC(Real c)
{
    return vec3(1.0f - c, splat(0.0f), c);
}
DRAPE_FUNCTION RealVec3 weightsOnBC(Real c)
{
    return vec3(splat(0.0f), 1.0f - c, c);
}
DRAPE_FUNCTION RealVec3 weightsInside(Real b, Real c)
{
    return vec3(drapeMax(1.0f - b - c, splat(0.0f)), b, c);
}

// Barycentric weights of the point of triangle abc that is closest to p. Each in [0, 1]; an unused corner weighs 0, so
// the number of non-zero weights distinguishes face, edge and vertex.
DRAPE_FUNCTION RealVec3 closestOnTriangle(RealVec3 p, RealVec3 a, RealVec3 b, RealVec3 c)
{
    const RealVec3 ab = vec3Sub(b, a), ac = vec3Sub(c, a);
    const RealVec3 ap = vec3Sub(p, a), bp = vec3Sub(p, b), cp = vec3Sub(p, c);
    const Real d1 = vec3Dot(ab, ap), d2 = vec3Dot(ac, ap), d3 = vec3Dot(ab, bp), d4 = vec3Dot(ac, bp);
    const Real d5 = vec3Dot(ab, cp), d6 = vec3Dot(ac, cp);
    const Real vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    const Real zero = splat(0.0f), one = splat(1.0f);
    const Truth atA = (d1 <= 0.0f) & (d2 <= 0.0f), atB = (d3 >= 0.0f) & (d4 <= d3), atC = (d6 >= 0.0f) & (d5 <= d6);
    const Truth onAB = (vc <= 0.0f) & (d1 >= 0.0f) & (d3 <= 0.0f), onAC = (vb <= 0.0f) & (d2 >= 0.0f) & (d6 <= 0.0f);
    const Truth onBC = (va <= 0.0f) & (d4 - d3 >= 0.0f) & (d5 - d6 >= 0.0f);
    // An earlier region counts where several seem to contain the point. Lanes compute the quotients of all regions side
    // by side: waiting for a common quotient takes longer.
    const Real sum = va + vb + vc;
    const RealVec3 elsewhere =
        chooseVec3(onAB, weightsOnAB(drapeRatio(d1, d1 - d3)),
                   chooseVec3(onAC, weightsOnAC(drapeRatio(d2, d2 - d6)),
                              chooseVec3(onBC, weightsOnBC(drapeRatio(d4 - d3, (d4 - d3) + (d5 - d6))),
                                         weightsInside(drapeRatio(vb, sum), drapeRatio(vc, sum)))));
    const RealVec3 allA = vec3(one, zero, zero), allB = vec3(zero, one, zero), allC = vec3(zero, zero, one);
    return chooseVec3(atA, allA, chooseVec3(atB, allB, chooseVec3(atC, allC, elsewhere)));
}

// Parameters (s along ab, t along cd, both in [0, 1]) of a closest pair of points of two segments.
DRAPE_FUNCTION void closestOnSegments(RealVec3 a, RealVec3 b, RealVec3 c, RealVec3 d, Real* s, Real* t)
{
    const RealVec3 u = vec3Sub(b, a), v = vec3Sub(d, c), w = vec3Sub(a, c);
    const Real uu = vec3Dot(u, u), vv = vec3Dot(v, v), uv = vec3Dot(u, v), uw = vec3Dot(u, w), vw = vec3Dot(v, w);
    // If the second segment is a point, the first must still be projected on it; for parallel segments any start is
    // valid.
    Real first = drapeClamp01(choose(vv > 0.0f, drapeRatio(uv * vw - uw * vv, uu * vv - uv * uv), drapeRatio(-uw, uu)));
    Real second = drapeRatio(uv * first + vw, vv);
    const Truth beyond = (second < 0.0f) | (second > 1.0f);
    if (anyOf(beyond))
    {
        second = drapeClamp01(second);
        first = choose(beyond, drapeClamp01(drapeRatio(uv * second - uw, uu)), first);
    }
    *s = first;
    *t = second;
}

DRAPE_FUNCTION RealVec3 trianglePoint(RealVec3 a, RealVec3 b, RealVec3 c, RealVec3 weights)
{
    return vec3(weights.x * a.x + weights.y * b.x + weights.z * c.x,
                weights.x * a.y + weights.y * b.y + weights.z * c.y,
                weights.x * a.z + weights.y * b.z + weights.z * c.z);
}
