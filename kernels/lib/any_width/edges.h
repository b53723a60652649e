// Two edges that move, for any width; see one.h, ../feature_meeting.h and ../edge_edge_contact.h.

// Two edges at one instant: the ends of the first, and the far end of the second, whose near end is the origin.
typedef struct RealEdges
{
    RealVec3 m_a, m_b, m_far;
} RealEdges;

// positions: the ends of the first edge, then of the second.
DRAPE_FUNCTION RealEdges edgesFrom(const RealVec3* positions)
{
    RealEdges edges;
    edges.m_a = vec3Sub(positions[0], positions[2]);
    edges.m_b = vec3Sub(positions[1], positions[2]);
    edges.m_far = vec3Sub(positions[3], positions[2]);
    return edges;
}

DRAPE_FUNCTION Real edgesExtent(RealEdges edges)
{
    return drapeMax(drapeMax(vec3NormMax(edges.m_a), vec3NormMax(edges.m_b)), vec3NormMax(edges.m_far));
}

// Returns a vector across both edges.
DRAPE_FUNCTION RealVec3 edgesDirection(RealEdges edges)
{
    return vec3Cross(vec3Sub(edges.m_b, edges.m_a), edges.m_far);
}

// Computes the parameters of the edges' closest points; see closestOnSegments().
DRAPE_FUNCTION void edgesClosest(RealEdges edges, Real* s, Real* t)
{
    closestOnSegments(edges.m_a, edges.m_b, zeroVec3(), edges.m_far, s, t);
}

// Returns the point of the second edge at parameter t.
DRAPE_FUNCTION RealVec3 secondPoint(RealEdges edges, Real t)
{
    return vec3AddScaled(zeroVec3(), edges.m_far, t);
}

// Returns the offset from the second edge to the first, at parameters s and t.
DRAPE_FUNCTION RealVec3 edgesOffset(RealEdges edges, Real s, Real t)
{
    return vec3Sub(vec3Mix(edges.m_a, edges.m_b, s), secondPoint(edges, t));
}

// Two edges over the step. The members from m_direction on are those at the step's end.
typedef struct RealEdgePair
{
    RealEdges m_start, m_end;
    Real m_before, m_after;  // six times the signed volumes at the step's start and end; both at the end if discrete
    RealBounds m_bounds;
    RealVec3 m_direction;  // across both edges
    Real m_squared;        // the direction's length, squared
    Truth m_parallel;
    Real m_s, m_t;       // parameters of the closest points
    RealVec3 m_offset;   // m, between these, from the second edge to the first
    Real m_low, m_high;  // the offset's least product with the first edge and greatest with the second
} RealEdgePair;

// start, end: positions of the ends of the first edge, then of the second.
DRAPE_FUNCTION RealEdgePair edgePair(const RealVec3* start, const RealVec3* end, Real reach, DRAPE_UINT mode,
                                     DRAPE_UINT* searches)
{
    RealEdgePair pair;
    pair.m_start = edgesFrom(start);
    pair.m_end = edgesFrom(end);
    pair.m_bounds = pairBounds(edgesExtent(pair.m_start), edgesExtent(pair.m_end), reach, mode, searches);
    const RealEdges last = pair.m_end;
    const RealVec3 across = vec3Sub(last.m_b, last.m_a), along = last.m_far;
    pair.m_direction = edgesDirection(last);
    pair.m_squared = vec3Dot(pair.m_direction, pair.m_direction);
    pair.m_after = -vec3Dot(pair.m_direction, last.m_a);
    pair.m_before = mode == DRAPE_DISCRETE ? pair.m_after : -vec3Dot(edgesDirection(pair.m_start), pair.m_start.m_a);
    pair.m_parallel = pair.m_squared <= DRAPE_SEAM * DRAPE_SEAM * vec3Dot(across, across) * vec3Dot(along, along);
    edgesClosest(last, &pair.m_s, &pair.m_t);
    pair.m_offset = edgesOffset(last, pair.m_s, pair.m_t);
    pair.m_low = drapeMin(vec3Dot(pair.m_offset, last.m_a), vec3Dot(pair.m_offset, last.m_b));
    pair.m_high = drapeMax(splat(0.0f), vec3Dot(pair.m_offset, along));
    return pair;
}

// Returns the distance that the ends of both edges move at most, added up, m.
DRAPE_FUNCTION Real edgesMotion(const RealEdgePair* pair)
{
    const RealEdges from = pair->m_start, to = pair->m_end;
    return drapeMax(distanceMoved(from.m_a, to.m_a), distanceMoved(from.m_b, to.m_b)) +
           distanceMoved(from.m_far, to.m_far);
}

// Returns whether the edges come as near as features that meet: they are not DRAPE_STAY_APART.
DRAPE_FUNCTION Truth edgesComeNear(const RealEdgePair* pair)
{
    const RealBounds bounds = pair->m_bounds;
    const RealEdges e0 = pair->m_start, e1 = pair->m_end;
    const Real distance = meetingDistance(edgesMotion(pair), bounds);
    const Truth near = volumeAdmitsMeeting(pair->m_before, vec3Length(edgesDirection(e0)), distance, bounds) &
                       volumeAdmitsMeeting(pair->m_after, drapeSqrt(pair->m_squared), distance, bounds);
    if (!anyOf(near)) return near;
    const RealVec3 least = vec3Least(vec3Least(e0.m_a, e0.m_b), vec3Least(e1.m_a, e1.m_b));
    const RealVec3 most = vec3Most(vec3Most(e0.m_a, e0.m_b), vec3Most(e1.m_a, e1.m_b));
    const RealVec3 leastOther = vec3Least(vec3Least(zeroVec3(), e0.m_far), vec3Least(zeroVec3(), e1.m_far));
    const RealVec3 mostOther = vec3Most(vec3Most(zeroVec3(), e0.m_far), vec3Most(zeroVec3(), e1.m_far));
    return near & isNot(boxesApart(least, most, leastOther, mostOther, DRAPE_SEAM * bounds.m_extent) |
                        furtherApart(pair->m_offset, pair->m_low, pair->m_high, distance, bounds));
}

// Returns whether the edges' lines are out of reach at the step's end: a lower bound of the distance of edges that are
// not parallel.
DRAPE_FUNCTION Truth linesAreFar(const RealEdgePair* pair)
{
    const Real slack = pair->m_bounds.m_reachSlack;
    return pair->m_after * pair->m_after > pair->m_squared * (slack * slack);
}

// Returns whether the edges are in contact at the step's end, with both closest points inside them. admitted: whether
// they may be. The caller stores the weights.
DRAPE_FUNCTION Truth edgesNear(const RealEdgePair* pair, Truth admitted, RealNear* near)
{
    const RealBounds bounds = pair->m_bounds;
    const Real s = pair->m_s, t = pair->m_t;
    Truth found = admitted & (s > 0.0f) & (s < 1.0f) & (t > 0.0f) & (t < 1.0f);
    if (!anyOf(found)) return found;
    const Real distance = vec3Length(pair->m_offset);
    found &= isNot(provenApart(pair->m_offset, pair->m_low, pair->m_high, bounds));
    found &= isNot(edgesAreOutOfReach(distance, pair->m_end.m_a, pair->m_end.m_b, pair->m_end.m_far, bounds));
    const Truth touching = isNot(distance > DRAPE_SEAM * bounds.m_extent);
    // Edges that touch along a line are left to their ends.
    found &= isNot(touching & pair->m_parallel);
    if (!anyOf(found)) return found;
    const Real sign = -signOf(pair->m_before);
    near->m_normal = isRare(touching) ? vec3Scale(vec3Direction(pair->m_direction, drapeSqrt(pair->m_squared)), sign)
                                      : vec3Direction(pair->m_offset, distance);
    near->m_point = secondPoint(pair->m_end, t);
    near->m_distance = distance;
    near->m_seam = splat(0.0f);
    near->m_gap0 = vec3Dot(near->m_normal, edgesOffset(pair->m_start, s, t));
    near->m_gap1 = vec3Dot(near->m_normal, pair->m_offset);
    near->m_asks = pair->m_parallel;
    return found;
}

// Returns whether an edge is in contact with an obstacle's edge that has the given normal cone. Inside both edges the
// offset is parallel to the direction, or the edges are parallel, and the offset may be any. A cloth face that is
// nearer beside the edge is no reason to drop the contact: if cloth bends over a sharp edge of the obstacle, every
// crossing counts.
DRAPE_FUNCTION Truth edgesNearWithin(const RealEdgePair* pair, RealCone cone, RealNear* near)
{
    const Real facing = vec3Dot(cone.m_axis, pair->m_direction);
    const Truth turned = (cone.m_cosine > 0.0f) & (facing * facing < cone.m_cosine * cone.m_cosine * pair->m_squared);
    const Truth found = edgesNear(pair, pair->m_parallel | isNot(turned | linesAreFar(pair)), near);
    near->m_weights = vec3(1.0f - pair->m_s, pair->m_s, splat(0.0f));
    return found;
}
