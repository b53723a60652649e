// A face that moves and a point that rests in the frame's origin, for any width; see one.h and ../feature_meeting.h.

typedef struct RealMovingFace
{
    RealTriangle m_start, m_end;  // m, at the step's start and end
    RealVec3 m_areaStart;         // computed by triangleNormal()
    RealArea m_areaEnd;
    // The origin's distance from the face's plane, times the length of the area vector; both at the end if discrete.
    Real m_before, m_after;
    RealBounds m_bounds;
} RealMovingFace;

// start, end: the corners at the step's start and end. start0, end0: the point there, which becomes the origin.
DRAPE_FUNCTION RealMovingFace movingFace(const RealVec3* start, const RealVec3* end, RealVec3 start0, RealVec3 end0,
                                         Real reach, DRAPE_UINT mode, DRAPE_UINT* searches)
{
    RealMovingFace face;
    const RealTriangle f0 = {{vec3Sub(start[0], start0), vec3Sub(start[1], start0), vec3Sub(start[2], start0)}};
    const RealTriangle f1 = {{vec3Sub(end[0], end0), vec3Sub(end[1], end0), vec3Sub(end[2], end0)}};
    face.m_start = f0;
    face.m_end = f1;
    face.m_areaStart = triangleNormal(f0);
    face.m_areaEnd = faceArea(f1);
    face.m_after = -vec3Dot(face.m_areaEnd.m_vector, f1.m_p[0]);
    face.m_before = mode == DRAPE_DISCRETE ? face.m_after : -vec3Dot(face.m_areaStart, f0.m_p[0]);
    face.m_bounds = pairBounds(triangleExtent(f0), triangleExtent(f1), reach, mode, searches);
    return face;
}

// The point of a face closest to the origin, at the step's end. m_low: the least product of the point and a corner.
typedef struct RealNearest
{
    RealVec3 m_weights, m_point;
    Real m_low;
} RealNearest;

DRAPE_FUNCTION RealNearest nearestOfFace(const RealMovingFace* face)
{
    RealNearest nearest;
    nearest.m_weights = closestOnFace(zeroVec3(), face->m_end, face->m_areaEnd.m_thin);
    nearest.m_point = featurePoint(face->m_end, nearest.m_weights);
    nearest.m_low = leastAlong(nearest.m_point, face->m_end);
    return nearest;
}

DRAPE_FUNCTION Real distanceMoved(RealVec3 from, RealVec3 to)
{
    return vec3Length(vec3Sub(to, from));
}

DRAPE_FUNCTION Real faceMotion(const RealMovingFace* face)
{
    const RealTriangle f0 = face->m_start, f1 = face->m_end;
    return drapeMax(drapeMax(distanceMoved(f0.m_p[0], f1.m_p[0]), distanceMoved(f0.m_p[1], f1.m_p[1])),
                    distanceMoved(f0.m_p[2], f1.m_p[2]));
}

// motion: m, of the fastest corner. The result is grown by a share of the pair's extent, far more than the search's
// tolerance and all rounding.
DRAPE_FUNCTION Real meetingDistance(Real motion, RealBounds bounds)
{
    return motion * (1.0f + DRAPE_SEAM) + DRAPE_SEAM * bounds.m_extent;
}

// volume: of the two features; area: that of the cloth's feature, or of both edges. The volume is made of three offsets
// of at most 2 √3 extents each and errs by less than 1.5e-5 cubed extents.
DRAPE_FUNCTION Truth volumeAdmitsMeeting(Real volume, Real area, Real distance, RealBounds bounds)
{
    const Real extent = bounds.m_extent;
    return drapeAbs(volume) <= area * distance + 10.0f * DRAPE_SEAM * (extent * extent * extent);
}

// Returns whether the face and the origin come as near as features that meet: they are not DRAPE_STAY_APART.
DRAPE_FUNCTION Truth faceComesNear(const RealMovingFace* face, const RealNearest* nearest)
{
    const RealBounds bounds = face->m_bounds;
    const RealTriangle f0 = face->m_start, f1 = face->m_end;
    const Real distance = meetingDistance(faceMotion(face), bounds);
    const Truth near = volumeAdmitsMeeting(face->m_before, vec3Length(face->m_areaStart), distance, bounds) &
                       volumeAdmitsMeeting(face->m_after, face->m_areaEnd.m_length, distance, bounds);
    if (!anyOf(near)) return near;
    const RealVec3 least = vec3Least(vec3Least(vec3Least(f0.m_p[0], f0.m_p[1]), vec3Least(f0.m_p[2], f1.m_p[0])),
                                     vec3Least(f1.m_p[1], f1.m_p[2]));
    const RealVec3 most = vec3Most(vec3Most(vec3Most(f0.m_p[0], f0.m_p[1]), vec3Most(f0.m_p[2], f1.m_p[0])),
                                   vec3Most(f1.m_p[1], f1.m_p[2]));
    return near & isNot(boxesApart(least, most, zeroVec3(), zeroVec3(), DRAPE_SEAM * bounds.m_extent) |
                        furtherApart(nearest->m_point, nearest->m_low, splat(0.0f), distance, bounds));
}

// Returns whether the origin is out of reach of the face's plane at the step's end: a lower bound of the distance.
DRAPE_FUNCTION Truth planeIsFar(const RealMovingFace* face)
{
    return drapeAbs(face->m_after) > face->m_areaEnd.m_length * face->m_bounds.m_reachSlack;
}

// Returns whether the face is in contact with the origin at the step's end. inside: whether its nearest point is not on
// an edge. side: of the origin where the two touch, else the origin's side at the end counts. The normal points from
// the origin to the face.
DRAPE_FUNCTION Truth faceNearOrigin(const RealMovingFace* face, const RealNearest* nearest, Truth inside, Real side,
                                    RealNear* near)
{
    const RealBounds bounds = face->m_bounds;
    const RealArea area = face->m_areaEnd;
    const RealVec3 point = nearest->m_point;
    Truth found = isNot(provenApart(point, nearest->m_low, splat(0.0f), bounds));
    if (!anyOf(found)) return found;
    const Real distance = vec3Length(point);
    found &= isNot(pointIsOutOfReach(distance, zeroVec3(), face->m_end, bounds));
    const Truth touching = isNot(distance > DRAPE_SEAM * bounds.m_extent);
    const Truth direct = isNot(touching | (inside & isNot(area.m_thin)));
    // A face without a direction that touches the point is left to its neighbours.
    found &= direct | isNot(area.m_length == 0.0f);
    if (!anyOf(found)) return found;
    const Real sign = isRare(touching) ? side : signOf(face->m_after);
    near->m_normal = chooseVec3(direct, vec3Direction(point, distance), planeNormal(area, -sign));
    near->m_weights = nearest->m_weights;
    near->m_point = point;
    near->m_distance = distance;
    // Either long edge of a thin face may seem the nearer one. Squared distances err by 4 u of the square, so that the
    // offset leans by the root of that.
    near->m_seam = choose(area.m_thin, DRAPE_SEAM * bounds.m_extent + 5e-4f * distance, DRAPE_SEAM * distance);
    near->m_gap0 = vec3Dot(near->m_normal, featurePoint(face->m_start, nearest->m_weights));
    near->m_gap1 = vec3Dot(near->m_normal, point);
    near->m_asks = direct & isNot(inside);
    return found;
}

// Returns whether the face is in contact with a vertex in the origin that has the given normal cone. A vertex nearest
// to an edge of the face counts here too (weights with one zero); one nearest to a node is the node's contact.
DRAPE_FUNCTION Truth faceNearVertex(const RealMovingFace* face, const RealNearest* nearest, RealCone cone,
                                    RealNear* near)
{
    const RealVec3 weights = nearest->m_weights;
    const Truth zeroX = weights.x == 0.0f, zeroY = weights.y == 0.0f, zeroZ = weights.z == 0.0f;
    const Truth inside = isNot(zeroX | zeroY | zeroZ);
    Truth found = isNot(planeIsFar(face) | (zeroX & zeroY) | (zeroY & zeroZ) | (zeroZ & zeroX));
    if (!anyOf(found)) return found;
    found &= faceNearOrigin(face, nearest, inside, signOf(face->m_after), near);
    if (!anyOf(found)) return found;
    return found & (coneAdmits(cone, near->m_normal) | isNot(inside | near->m_asks));
}
