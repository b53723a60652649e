#include "contact_plane.h"

#include "kernels/lib/feature_contact.h"

namespace drape
{
namespace
{
// The point of a face nearest to the vertex, which is the origin.
struct Nearest
{
    Vec3 m_weights;  // by node of the cloth
    Vec3 m_offset;   // from the vertex
    Vec3 m_across;   // the face's area vector if the offset is parallel to it; else 0
};

bool insideFace(Vec3 weights)
{
    return weights.x > 0 && weights.y > 0 && weights.z > 0;
}

Nearest nearestOfFace(const FeatureTriangle& face)
{
    const FaceArea area = faceArea(face);
    const Vec3 weights = closestOnFace(vec3(0, 0, 0), face, area.m_thin);
    const bool inside = insideFace(weights) && !area.m_thin;
    return Nearest{weights, featurePoint(face, weights), inside ? area.m_vector : vec3(0, 0, 0)};
}

void store(Vec3 v, float target[3])
{
    target[0] = v.x;
    target[1] = v.y;
    target[2] = v.z;
}

// Computes the unit normal on the side of `before`; returns false if there is none.
bool directionOf(const Nearest& nearest, Vec3 before, Vec3& direction)
{
    const float across = areaLengthOf(nearest.m_across);
    if (across > 0)
    {
        direction = vec3Scale(nearest.m_across, (vec3Dot(nearest.m_across, before) < 0 ? -1.0f : 1.0f) / across);
        return true;
    }
    const float distance = vec3Length(nearest.m_offset);
    if (!(distance > 0) || !(vec3Dot(nearest.m_offset, before) > 0)) return false;
    direction = vec3Direction(nearest.m_offset, distance);
    return true;
}
}  // namespace

bool planeAt(const Contact& contact, const float nodes[][3], ContactPlane& plane)
{
    const Vec3 origin = vec3Load(contact.m_point, 0);  // the vertex, at the step's end
    const auto node = [&](int k) { return vec3Sub(vec3(nodes[k][0], nodes[k][1], nodes[k][2]), origin); };
    const Nearest nearest = nearestOfFace(FeatureTriangle{{node(0), node(1), node(2)}});
    Vec3 direction;
    if (!directionOf(nearest, vec3Load(contact.m_normal, 0), direction)) return false;
    store(direction, plane.m_normal);
    store(origin, plane.m_point);
    store(nearest.m_weights, plane.m_weights);
    return true;
}
}  // namespace drape
