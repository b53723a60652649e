// Pairs of features of one cloth, for any width; see one.h and ../self_contact.h.

// Returns the pair's thickness, m; 0 for features that touch at rest.
DRAPE_FUNCTION Real selfThickness(Real thickness, Real restDistance)
{
    return drapeMin(thickness, DRAPE_REST_SHARE * restDistance);
}

// Returns the distance, m, of a node and a face. face: the corners relative to the node. thin: whether the face is
// thin.
DRAPE_FUNCTION Real distanceToFace(RealTriangle face, Truth* thin)
{
    *thin = isThin(face, vec3Length(triangleNormal(face)));
    return vec3Length(featurePoint(face, closestOnFace(zeroVec3(), face, *thin)));
}

// Returns the distance of two edges, m.
DRAPE_FUNCTION Real distanceOfEdges(RealEdges edges)
{
    Real s, t;
    edgesClosest(edges, &s, &t);
    return vec3Length(edgesOffset(edges, s, t));
}

// Returns whether a node in the origin is in contact with a face of its cloth at the step's end. The normal points from
// the face to the node.
DRAPE_FUNCTION Truth selfNodeNear(const RealMovingFace* face, const RealNearest* nearest, RealNear* near)
{
    const RealVec3 weights = nearest->m_weights;
    const Truth inside = (weights.x > 0.0f) & (weights.y > 0.0f) & (weights.z > 0.0f);
    Truth found = isNot(planeIsFar(face));
    if (!anyOf(found)) return found;
    found &= faceNearOrigin(face, nearest, inside, signOf(face->m_before), near);
    if (!anyOf(found)) return found;
    near->m_normal = vec3Scale(near->m_normal, splat(-1.0f));
    return found;
}

// Returns whether two edges of a cloth are in contact at the step's end. For parallel edges an end is as near as any
// other point, and belongs to the node's contact.
DRAPE_FUNCTION Truth selfEdgesNear(const RealEdgePair* pair, RealNear* near)
{
    const Truth found = edgesNear(pair, isNot(pair->m_parallel | linesAreFar(pair)), near);
    near->m_weights = vec3(pair->m_s, pair->m_t, splat(0.0f));
    return found;
}
