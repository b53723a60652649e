// A node that moves and a face that rests, for any width; see one.h and ../node_face_contact.h.

// The frame's origin is the face's first corner.
typedef struct RealNodeFace
{
    RealVec3 m_x0, m_x1;  // m, the node at the step's start and end
    RealTriangle m_face;
    RealArea m_area;
    // The node's distance from the face's plane, times the length of the area vector; both at the end if discrete.
    Real m_before, m_after;
    Real m_side;     // the node's side at the start: +1 in front of the face
    Truth m_passed;  // true if the node went through the plane
    RealBounds m_bounds;
} RealNodeFace;

// x0, x1, a, b, c: positions in one frame.
DRAPE_FUNCTION RealNodeFace nodeFace(RealVec3 x0, RealVec3 x1, RealVec3 a, RealVec3 b, RealVec3 c, Real reach,
                                     DRAPE_UINT mode, DRAPE_UINT* searches)
{
    RealNodeFace pair;
    pair.m_x0 = vec3Sub(x0, a);
    pair.m_x1 = vec3Sub(x1, a);
    pair.m_face.m_p[0] = zeroVec3();
    pair.m_face.m_p[1] = vec3Sub(b, a);
    pair.m_face.m_p[2] = vec3Sub(c, a);
    pair.m_area = faceArea(pair.m_face);
    const Real resting = triangleExtent(pair.m_face);
    pair.m_bounds = pairBounds(drapeMax(vec3NormMax(pair.m_x0), resting), drapeMax(vec3NormMax(pair.m_x1), resting),
                               reach, mode, searches);
    pair.m_after = vec3Dot(pair.m_area.m_vector, pair.m_x1);
    pair.m_before = mode == DRAPE_DISCRETE ? pair.m_after : vec3Dot(pair.m_area.m_vector, pair.m_x0);
    pair.m_side = signOf(pair.m_before);
    // A face whose area is too small for a length has no side; the tests at the end find what is near.
    pair.m_passed = (pair.m_area.m_length > 0.0f) & (pair.m_side * pair.m_after < 0.0f);
    return pair;
}

// Returns whether the node is out of reach of the face's plane: a lower bound of the distance.
DRAPE_FUNCTION Truth nodeIsFarFromPlane(const RealNodeFace* pair)
{
    return drapeAbs(pair->m_after) > pair->m_area.m_length * pair->m_bounds.m_reachSlack;
}

// Returns whether the node is in contact with the face at the step's end. side: on which the plane's normal points.
DRAPE_FUNCTION Truth nodeNearFace(const RealNodeFace* pair, Real side, RealNear* near)
{
    const RealBounds bounds = pair->m_bounds;
    const RealVec3 x1 = pair->m_x1;
    const RealVec3 weights = closestOnFace(x1, pair->m_face, pair->m_area.m_thin);
    const RealVec3 point = featurePoint(pair->m_face, weights), offset = vec3Sub(x1, point);
    Truth found = isNot(provenApart(offset, vec3Dot(offset, x1), greatestAlong(offset, pair->m_face), bounds));
    if (!anyOf(found)) return found;
    const Real distance = vec3Length(offset);
    found &= isNot(pointIsOutOfReach(distance, x1, pair->m_face, bounds));
    const Truth onFace = (weights.x > 0.0f) & (weights.y > 0.0f) & (weights.z > 0.0f);
    const Truth direct = (distance > DRAPE_SEAM * bounds.m_extent) & isNot(onFace & isNot(pair->m_area.m_thin));
    // A node that touches a face without a direction is left to the face's neighbours.
    found &= direct | isNot(pair->m_area.m_length == 0.0f);
    if (!anyOf(found)) return found;
    near->m_normal = chooseVec3(direct, vec3Direction(offset, distance), planeNormal(pair->m_area, side));
    near->m_weights = weights;
    near->m_point = point;
    near->m_distance = distance;
    near->m_seam = splat(0.0f);
    near->m_gap0 = vec3Dot(near->m_normal, vec3Sub(pair->m_x0, point));
    near->m_gap1 = vec3Dot(near->m_normal, offset);
    near->m_asks = direct & isNot(onFace);
    return found;
}
