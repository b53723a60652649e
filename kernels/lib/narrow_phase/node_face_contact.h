// Tests a cloth node against a face of the obstacle, including its edges and vertices. feature_contact.h defines
// contacts and the frame.
#ifndef DRAPE_LIB_NODE_FACE_CONTACT_H
#define DRAPE_LIB_NODE_FACE_CONTACT_H

#include "feature_contact.h"
#include "../step_data/cloth_reads.h"
#include "paths.h"

DRAPE_NAMESPACE_BEGIN

// Returns the cone of the obstacle feature on which the closest point with these weights lies; a face admits its own
// normal only and needs none.
DRAPE_FUNCTION NormalCone closestFeatureCone(Vec3 weights, const DRAPE_GLOBAL Triangle* triangle,
                                             const DRAPE_GLOBAL NormalCone* vertexCones,
                                             const DRAPE_GLOBAL NormalCone* edgeCones)
{
    if (weights.x == 1.0f) return vertexCones[triangle->m_vertices[0]];
    if (weights.y == 1.0f) return vertexCones[triangle->m_vertices[1]];
    if (weights.z == 1.0f) return vertexCones[triangle->m_vertices[2]];
    if (weights.z == 0.0f) return edgeCones[triangle->m_edges[0]];
    if (weights.x == 0.0f) return edgeCones[triangle->m_edges[1]];
    return edgeCones[triangle->m_edges[2]];
}

// Maximum slide along the face, as a share of a pair's extent, of the face's closest point to a point in its plane.
// The point's weights err by u L⁴ over the square of the doubled area. The doubled area exceeds DRAPE_THIN L² for
// faces that are not thin.
#define DRAPE_SLIDE 1e-3f

// Returns whether a point of the face's plane lies in the face, or less than the slack (m) outside of its edges. The
// area vector may have any length.
DRAPE_FUNCTION int isWithinEdges(Vec3 point, const FeatureTriangle* face, Vec3 area, float slack)
{
    int within = 1;
    DRAPE_UNROLL
    for (int i = 0; i < 3; ++i)
    {
        const FeatureEdge edge = triangleEdge(face, i);
        const Vec3 outwards = vec3Cross(vec3Sub(edge.m_b, edge.m_a), area);
        within &= vec3Dot(outwards, vec3Sub(point, edge.m_a)) <= slack * vec3Length(outwards);
    }
    return within;
}

#include "../any_width/one.h"
#include "../any_width/node_face.h"
#include "../any_width/end.h"

// Returns whether a path through the face's plane went through the face. hit: the point of the path in the plane,
// which was found `distance` (m) from the face.
DRAPE_FUNCTION int wentThrough(const NodeFace* pair, Vec3 hit, float distance)
{
    const FeatureTriangle face = pair->m_face;
    const PairBounds bounds = pair->m_bounds;
    const float seam = DRAPE_SEAM * bounds.m_extent;
    if (distance > seam &&
        !(distance <= DRAPE_SLIDE * bounds.m_extent && isWithinEdges(hit, &face, pair->m_area.m_vector, seam)))
        return 0;
    if (distance <= DRAPE_PATH_REACH * bounds.m_reach) return 1;
    const Vec3 start[4] = {pair->m_x0, face.m_p[0], face.m_p[1], face.m_p[2]};
    const Vec3 end[4] = {pair->m_x1, face.m_p[0], face.m_p[1], face.m_p[2]};
    return pathsOverlap(start, end, 1, DRAPE_PATH_REACH * bounds.m_reach);
}

// Stores the contact of a node near to a face, unless the node leans away from the face's edge or corner nearest to it.
// Returns whether there is a contact.
DRAPE_FUNCTION int acceptNodeFace(const NearContact* near, const ObstacleView* obstacle, DRAPE_UINT face,
                                  Contact* contact)
{
    if (near->m_asks && !coneAdmits(closestFeatureCone(near->m_weights, obstacle->m_triangles + face,
                                                       obstacle->m_vertexCones, obstacle->m_edgeCones),
                                    near->m_normal))
        return DRAPE_NO_CONTACT;
    storeNear(near, near->m_point, vec3(1.0f, 0.0f, 0.0f), contact);
    return DRAPE_IS_CONTACT;
}

// Tests a moving node against a resting face. face: its index. Returns whether there is a contact.
DRAPE_FUNCTION int nodeFaceContact(const NodeFace* pair, const ObstacleView* obstacle, DRAPE_UINT face,
                                   Contact* contact)
{
    const int far = nodeIsFarFromPlane(pair), thin = pair->m_area.m_thin;
    float side = pair->m_side;
    if (!pair->m_passed && far) return DRAPE_NO_CONTACT;
    if (pair->m_passed)  // the path went through the face's plane
    {
        const float time = pair->m_before / (pair->m_before - pair->m_after);
        const Vec3 hit = vec3Mix(pair->m_x0, pair->m_x1, time);
        const Vec3 weights = closestOnFace(hit, pair->m_face, thin), point = featurePoint(pair->m_face, weights);
        if (wentThrough(pair, hit, vec3Length(vec3Sub(hit, point))))
        {
            const Vec3 normal = planeNormal(pair->m_area, side);
            storeContact(contact, normal, point, vec3(1.0f, 0.0f, 0.0f), vec3Dot(normal, vec3Sub(pair->m_x0, point)),
                         vec3Dot(normal, vec3Sub(pair->m_x1, point)), time);
            return DRAPE_IS_CONTACT;
        }
        // The path went around the face, so the node belongs on the side where it ends. The plane of a thin face turns
        // freely about the face's length: its sides mean nothing.
        if (!thin && far) return DRAPE_NO_CONTACT;
        if (!thin) side = -side;
    }
    NearContact near;
    if (!nodeNearFace(pair, side, &near)) return DRAPE_NO_CONTACT;
    return acceptNodeFace(&near, obstacle, face, contact);
}

DRAPE_NAMESPACE_END

#endif
