// Contacts of feature pairs, from their positions in memory; feature_contact.h defines a contact.
//
// Contacts depend on the two features alone: however a pair of features is found, its numbers are equal. The frame's
// origin is the obstacle feature's first position.
#ifndef DRAPE_LIB_PAIR_CONTACT_H
#define DRAPE_LIB_PAIR_CONTACT_H

#include "edge_edge_contact.h"
#include "face_vertex_contact.h"
#include "node_face_contact.h"
#include "../geometry/segment.h"
#include "../ordering/feature_index.h"
#include "../step_data/cloth_reads.h"

DRAPE_NAMESPACE_BEGIN

// A position that is NaN or infinite, at the step's start or end, gives a gap that is not finite: no contact.
DRAPE_FUNCTION int finishContact(int found, Vec3 origin, Contact* contact)
{
    if (found != DRAPE_IS_CONTACT) return found;
    if (!drapeIsFinite(contact->m_gap0) || !drapeIsFinite(contact->m_gap1)) return DRAPE_NO_CONTACT;
    contact->m_point[0] += origin.x;
    contact->m_point[1] += origin.y;
    contact->m_point[2] += origin.z;
    return DRAPE_IS_CONTACT;
}

// Sets the features of a contact of the kind. cloth: node, triangle or edge.
DRAPE_FUNCTION void nameFeatures(Contact* contact, const ClothView* view, DRAPE_UINT kind, DRAPE_UINT cloth,
                                 DRAPE_UINT obstacle)
{
    contact->m_kind = kind;
    contact->m_clothFeature = cloth;
    contact->m_obstacleFeature = obstacle;
    contact->m_featureIndex = featureIndexOf(kind, cloth, view->m_nodeCount, view->m_triangleCount);
}

// Tests node i of the cloth triangle against the obstacle's triangle with corners a, b, c.
DRAPE_FUNCTION int pairNodeFace(int i, const ClothView* cloth, DRAPE_UINT clothTriangle, Vec3 a, Vec3 b, Vec3 c,
                                const ObstacleView* obstacle, DRAPE_UINT obstacleTriangle, float reach,
                                Contact* contact)
{
    const DRAPE_UINT node = cloth->m_triangles[clothTriangle].m_vertices[i];
    const NodeFace pair = nodeFace(nodeStart(cloth, node), vec3Load(cloth->m_end, node), a, b, c, reach, cloth->m_mode,
                                   cloth->m_searches);
    nameFeatures(contact, cloth, DRAPE_NODE_FACE, node, obstacleTriangle);
    return finishContact(nodeFaceContact(&pair, obstacle, obstacleTriangle, contact), a, contact);
}

// Tests the cloth triangle against the obstacle's vertex.
DRAPE_FUNCTION int pairFaceVertex(const ClothView* cloth, DRAPE_UINT clothTriangle, Vec3 vertex, NormalCone cone,
                                  DRAPE_UINT obstacleVertex, float reach, Contact* contact)
{
    const DRAPE_GLOBAL Triangle* triangle = cloth->m_triangles + clothTriangle;
    Vec3 start[3], end[3];
    for (int i = 0; i < 3; ++i)
    {
        start[i] = nodeStart(cloth, triangle->m_vertices[i]);
        end[i] = vec3Load(cloth->m_end, triangle->m_vertices[i]);
    }
    const MovingFace face = movingFace(start, end, vertex, vertex, reach, cloth->m_mode, cloth->m_searches);
    nameFeatures(contact, cloth, DRAPE_FACE_VERTEX, clothTriangle, obstacleVertex);
    const int found = faceVertexContact(&face, cone, cloth, triangle, vertex, contact);
    if (found == DRAPE_IS_CONTACT && isSegment(triangle)) joinCorners(contact->m_weights);
    return finishContact(found, vertex, contact);
}

// Tests edge i of the cloth triangle against the obstacle's edge from a to b. The owner of an edge traverses it in its
// own direction, so the weights are in the order of its nodes.
DRAPE_FUNCTION int pairEdgeEdge(int i, const ClothView* cloth, DRAPE_UINT clothTriangle, Vec3 a, Vec3 b,
                                NormalCone cone, DRAPE_UINT obstacleEdge, float reach, Contact* contact)
{
    const DRAPE_GLOBAL Triangle* triangle = cloth->m_triangles + clothTriangle;
    const DRAPE_UINT first = triangle->m_vertices[i], second = triangle->m_vertices[i == 2 ? 0 : i + 1];
    const Vec3 start[4] = {nodeStart(cloth, first), nodeStart(cloth, second), a, b};
    const Vec3 end[4] = {vec3Load(cloth->m_end, first), vec3Load(cloth->m_end, second), a, b};
    const EdgePair pair = edgePair(start, end, reach, cloth->m_mode, cloth->m_searches);
    nameFeatures(contact, cloth, DRAPE_EDGE_EDGE, triangle->m_edges[i], obstacleEdge);
    return finishContact(edgeEdgeContact(&pair, cone, contact), a, contact);
}

DRAPE_NAMESPACE_END

#endif
