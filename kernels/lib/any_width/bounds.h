// Distances that are proved, and contacts of features that are near, for any width; see one.h and ../feature_contact.h.

// Bounds common to a pair of features.
typedef struct RealBounds
{
    Real m_extent;      // largest coordinate of all positions, m
    Real m_reach;       // m
    Real m_reachSlack;  // reach grown by more than the rounding of a distance and its normal
    DRAPE_UINT m_mode;  // DRAPE_DISCRETE …
    // Counts the pairs for which the continuous test was needed and run; null: it must not run.
    DRAPE_UINT* m_searches;
} RealBounds;

// Returns the bounds of a pair. start, end: its extents at the step's start and end.
DRAPE_FUNCTION RealBounds pairBounds(Real start, Real end, Real reach, DRAPE_UINT mode, DRAPE_UINT* searches)
{
    RealBounds bounds;
    bounds.m_extent = mode == DRAPE_DISCRETE ? end : drapeMax(start, end);
    bounds.m_reach = reach;
    bounds.m_reachSlack = reach * 1.001f + DRAPE_SEAM * bounds.m_extent;
    bounds.m_mode = mode;
    bounds.m_searches = searches;
    return bounds;
}

// Returns whether boxes do not meet, for points that can only meet at one instant. low/high: the boxes' corners.
DRAPE_FUNCTION Truth boxesApart(RealVec3 lowA, RealVec3 highA, RealVec3 lowB, RealVec3 highB, Real slack)
{
    return (lowA.x - highB.x > slack) | (lowB.x - highA.x > slack) | (lowA.y - highB.y > slack) |
           (lowB.y - highA.y > slack) | (lowA.z - highB.z > slack) | (lowB.z - highA.z > slack);
}

// Returns whether the support gap along n proves a distance above the reach. lowA: least n·a over one set; highB:
// greatest n·b over the other. With u = 2^-24, three products, two sums and the frame's shift err by at most 12 u |n|₁
// extent.
DRAPE_FUNCTION Truth provenApart(RealVec3 n, Real lowA, Real highB, RealBounds bounds)
{
    const float twelveUnits = 7.1525574e-7f;
    const Real gap = lowA - highB - twelveUnits * vec3Norm1(n) * bounds.m_extent - 1e-36f;
    return gap > bounds.m_reach * vec3Length(n) * (1.0f + twelveUnits);
}

// Returns whether the plane with the given normal (any length) proves two features further apart; see provenApart().
DRAPE_FUNCTION Truth furtherApart(RealVec3 n, Real low, Real high, Real distance, RealBounds bounds)
{
    bounds.m_reach = distance;
    return provenApart(n, low, high, bounds);
}

DRAPE_FUNCTION Truth coneAdmits(RealCone cone, RealVec3 direction)
{
    return drapeAbs(vec3Dot(cone.m_axis, direction)) >= cone.m_cosine;
}

// A contact of two features that are near at the step's end, in the pair's frame. m_asks: it is one only if the
// neighbours of the obstacle's or the cloth's feature leave the direction to it, see acceptNodeFace() and others.
typedef struct RealNear
{
    RealVec3 m_normal, m_weights;
    RealVec3 m_point;  // m, the closest point of the feature of two or three corners
    Real m_distance;   // m
    Real m_seam;       // m, by how much a neighbour must be nearer
    Real m_gap0, m_gap1;
    Truth m_asks;
} RealNear;
