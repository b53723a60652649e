// Computes where a face is nearest to its contact's vertex once the cloth's nodes have moved.
#pragma once

#include "kernels/shared/contact.h"

namespace drape
{
// The plane of a face-vertex contact after the cloth's nodes moved, at the points where the two are nearest then.
struct ContactPlane
{
    float m_normal[3];   // unit, on the side of the contact's normal
    float m_point[3];    // m, on the obstacle
    float m_weights[3];  // by node of the face, sum 1
};

// Turns a DRAPE_FACE_VERTEX contact to other positions of the face's nodes (m, x y z each, in the view's order; an edge
// repeats its second node). Returns false if the direction is undefined: the face touches the vertex, or came past it.
// O(1).
bool planeAt(const Contact& contact, const float nodes[][3], ContactPlane& plane);
}  // namespace drape
