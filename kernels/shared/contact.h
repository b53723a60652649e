// One contact between a cloth feature and an obstacle feature: the output of the narrow phase, read by the adapter. The
// same declaration serves C++ and OpenCL C: 32-bit scalars only, 64 bytes, no padding.
#ifndef DRAPE_SHARED_CONTACT_H
#define DRAPE_SHARED_CONTACT_H

#include "types.h"

DRAPE_NAMESPACE_BEGIN

// Kinds of contacts, in canonical order. The cloth's feature is named first.
#define DRAPE_NODE_FACE 0u
#define DRAPE_FACE_VERTEX 1u
#define DRAPE_EDGE_EDGE 2u
// Contacts of a cloth with itself (lib/cloth_cloth/self_contact.h): another feature of the cloth takes the obstacle's
// part.
#define DRAPE_SELF_NODE_FACE 3u
#define DRAPE_SELF_EDGE_EDGE 4u

// Maximum contacts of a cloth feature that a CPU's work-item sorts alone in quadratic time. A feature at rest
// has a few dozen.
#define DRAPE_RANKED 64u

// Canonical order of contacts: feature index, then obstacle feature. Feature indices count all nodes, then all faces,
// then all edges of the cloths. Contacts of cloths with themselves have a second range behind these, in the same order.
typedef struct Contact
{
    DRAPE_UINT m_featureIndex;  // cloth feature of any kind, over all cloths
    DRAPE_UINT m_kind;          // DRAPE_NODE_FACE, ...
    DRAPE_UINT m_clothFeature;  // node, triangle or edge, index over all cloths
    // Triangle, vertex or edge, an index over all obstacles; for self contacts over all cloths.
    DRAPE_UINT m_obstacleFeature;
    float m_normal[3];  // unit, from the obstacle to the side from which the cloth came
    float m_gap1;       // m, signed distance along the normal at the step's end, thickness not subtracted
    float m_point[3];   // m, contact point on the obstacle, world frame
    float m_gap0;       // m, signed distance along the normal at the step's start
    // Weights of the cloth feature's nodes, sum 1; unused ones 0. Self contacts: weights of the face's nodes, or the
    // parameters along the first and the second edge, each from its first node (0) to its second (1).
    float m_weights[3];
    float m_time;  // time of impact in [0, 1]; 1 when the surfaces are near at the step's end
} Contact;

// Elements before the first contact in a device's list. They hold the step's StepCounters, so that one transfer reads
// both.
#define DRAPE_CONTACT_HEAD 1u

DRAPE_NAMESPACE_END

#endif
