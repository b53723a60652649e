// Faces that are not thin, for any width; see one.h and ../face_area.h.

typedef struct RealTriangle
{
    RealVec3 m_p[3];
} RealTriangle;

DRAPE_FUNCTION RealVec3 triangleNormal(RealTriangle f)
{
    return vec3Cross(vec3Sub(f.m_p[1], f.m_p[0]), vec3Sub(f.m_p[2], f.m_p[0]));
}

DRAPE_FUNCTION Real triangleExtent(RealTriangle f)
{
    return drapeMax(drapeMax(vec3NormMax(f.m_p[0]), vec3NormMax(f.m_p[1])), vec3NormMax(f.m_p[2]));
}

DRAPE_FUNCTION RealVec3 featurePoint(RealTriangle f, RealVec3 weights)
{
    return trianglePoint(f.m_p[0], f.m_p[1], f.m_p[2], weights);
}

// Return the least and the greatest product of a vector and a corner.
DRAPE_FUNCTION Real leastAlong(RealVec3 n, RealTriangle f)
{
    return drapeMin(drapeMin(vec3Dot(n, f.m_p[0]), vec3Dot(n, f.m_p[1])), vec3Dot(n, f.m_p[2]));
}
DRAPE_FUNCTION Real greatestAlong(RealVec3 n, RealTriangle f)
{
    return drapeMax(drapeMax(vec3Dot(n, f.m_p[0]), vec3Dot(n, f.m_p[1])), vec3Dot(n, f.m_p[2]));
}

// Returns the length of an area vector, m²; 0 if its square is too small for a float's full precision.
DRAPE_FUNCTION Real areaLengthOf(RealVec3 area)
{
    const Real length = vec3Length(area);
    return choose(length > 1e-18f, length, splat(0.0f));
}

// length: of the cross product of the two edges.
DRAPE_FUNCTION Truth isThin(RealTriangle f, Real length)
{
    const RealVec3 ab = vec3Sub(f.m_p[1], f.m_p[0]), ac = vec3Sub(f.m_p[2], f.m_p[0]);
    return isNot(length > DRAPE_THIN * (vec3Dot(ab, ab) + vec3Dot(ac, ac)));
}

// Area vector: the unit normal times m_length, m², which is twice the area. m_length is 0 if the face has no side.
typedef struct RealArea
{
    RealVec3 m_vector;
    Real m_length;
    Truth m_thin;
} RealArea;

// Returns the area of a face as if it were not thin.
DRAPE_FUNCTION RealArea plainArea(RealTriangle f)
{
    RealArea area;
    area.m_vector = triangleNormal(f);
    area.m_length = areaLengthOf(area.m_vector);
    area.m_thin = isThin(f, area.m_length);
    return area;
}

// Returns the unit normal of the face's plane times the sign.
DRAPE_FUNCTION RealVec3 planeNormal(RealArea area, Real sign)
{
    return vec3Scale(area.m_vector, sign * drapeRatio(splat(1.0f), area.m_length));
}

DRAPE_FUNCTION Real signOf(Real a)
{
    return choose(a < 0.0f, splat(-1.0f), splat(1.0f));
}
