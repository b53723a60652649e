// Closest points for any width; see one.h and ../closest.h.

// 0 where the denominator vanishes: the numerator does too, and any point of the degenerate feature is as near.
DRAPE_FUNCTION Real drapeRatio(Real numerator, Real denominator)
{
    return choose(denominator > 0.0f, numerator / denominator, splat(0.0f));
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
    // The regions in order: an earlier one counts where several seem to contain the point.
    const Truth atA = (d1 <= 0.0f) & (d2 <= 0.0f), atB = (d3 >= 0.0f) & (d4 <= d3), atC = (d6 >= 0.0f) & (d5 <= d6);
    const Truth onAB = (vc <= 0.0f) & (d1 >= 0.0f) & (d3 <= 0.0f);
    const Truth onAC = isNot(onAB) & (vb <= 0.0f) & (d2 >= 0.0f) & (d6 <= 0.0f);
    const Truth onBC = isNot(onAB | onAC) & (va <= 0.0f) & (d4 - d3 >= 0.0f) & (d5 - d6 >= 0.0f);
    const Truth inside = isNot(onAB | onAC | onBC);

    // On an edge the share is that of its second corner, else that of b. All regions share one quotient: quotients
    // are the dearest part.
    const Real above = choose(onAB, d1, choose(onAC, d2, choose(onBC, d4 - d3, vb)));
    const Real below = choose(onAB, d1 - d3, choose(onAC, d2 - d6, choose(onBC, (d4 - d3) + (d5 - d6), va + vb + vc)));
    const Real share = drapeRatio(above, below), shareC = choose(inside, drapeRatio(vc, below), zero);
    const Real rest = drapeMax(1.0f - share - shareC, zero);
    RealVec3 weights = vec3(choose(onBC, zero, rest), choose(onAC, zero, choose(onBC, rest, share)),
                            choose(onAC | onBC, share, shareC));
    weights = chooseVec3(atC, vec3(zero, zero, one), weights);
    weights = chooseVec3(atB, vec3(zero, one, zero), weights);
    return chooseVec3(atA, vec3(one, zero, zero), weights);
}

// Parameters (s along ab, t along cd, both in [0, 1]) of a closest pair of points of two segments.
DRAPE_FUNCTION void closestOnSegments(RealVec3 a, RealVec3 b, RealVec3 c, RealVec3 d, Real* s, Real* t)
{
    const RealVec3 u = vec3Sub(b, a), v = vec3Sub(d, c), w = vec3Sub(a, c);
    const Real uu = vec3Dot(u, u), vv = vec3Dot(v, v), uv = vec3Dot(u, v), uw = vec3Dot(u, w), vw = vec3Dot(v, w);
    // If the second segment is a point, the first must still be projected on it; for parallel segments any start is
    // valid.
    const Truth long2 = vv > 0.0f;
    Real first = drapeClamp01(drapeRatio(choose(long2, uv * vw - uw * vv, -uw), choose(long2, uu * vv - uv * uv, uu)));
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
