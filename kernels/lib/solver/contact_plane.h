// Computes where a face is nearest to its contact's vertex once the cloth's nodes have moved.
#ifndef DRAPE_LIB_CONTACT_PLANE_H
#define DRAPE_LIB_CONTACT_PLANE_H

#include "../narrow_phase/feature_contact.h"

DRAPE_NAMESPACE_BEGIN

// The plane of a contact, at the points where its features are nearest.
typedef struct ContactPlane
{
    Vec3 m_normal;       // unit, from the obstacle to the cloth
    Vec3 m_point;        // m, on the obstacle
    float m_weights[3];  // by node of the cloth's feature, sum 1
} ContactPlane;

// Turns a DRAPE_FACE_VERTEX contact to other positions of the face's nodes (m; an edge repeats its second node). The
// normal stays on the side of `before`. Returns false if the direction is undefined: the face touches the vertex, or
// came past it. vertex: m, at the step's end. O(1).
DRAPE_FUNCTION int planeOfFace(const Vec3* nodes, Vec3 vertex, Vec3 before, ContactPlane* plane)
{
    FeatureTriangle face;
    for (int k = 0; k < 3; ++k)
        face.m_p[k] = vec3Sub(nodes[k], vertex);
    const FaceArea area = faceArea(face);
    const Vec3 weights = closestOnFace(vec3(0.0f, 0.0f, 0.0f), face, area.m_thin);
    const Vec3 offset = featurePoint(face, weights);
    const int inside = weights.x > 0.0f && weights.y > 0.0f && weights.z > 0.0f && !area.m_thin;
    // The offset is parallel to the area vector, which is the more precise of the two.
    const float across = inside ? areaLengthOf(area.m_vector) : 0.0f;
    if (across > 0.0f)
        plane->m_normal = vec3Scale(area.m_vector, (vec3Dot(area.m_vector, before) < 0.0f ? -1.0f : 1.0f) / across);
    else
    {
        const float distance = vec3Length(offset);
        if (!(distance > 0.0f) || !(vec3Dot(offset, before) > 0.0f)) return 0;
        plane->m_normal = vec3Direction(offset, distance);
    }
    plane->m_point = vertex;
    plane->m_weights[0] = weights.x;
    plane->m_weights[1] = weights.y;
    plane->m_weights[2] = weights.z;
    return 1;
}

DRAPE_NAMESPACE_END

#endif
