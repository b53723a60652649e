// Contacts of single features: a cloth node against an obstacle face, a cloth face against an obstacle vertex, a
// cloth edge against an obstacle edge. The cloth moves linearly over the step, the obstacle rests.
//
// A contact is reported in two cases: (a) the features met during the step, or (b) they did not meet, are within
// reach at the step's end and are locally closest. The normal points to the side from which the cloth's point came,
// or to its side at the end if the two did not meet. Pairs are dropped for distance only on proof (provenApart).
//
// Positions are in a local frame: the caller has subtracted a vertex of the obstacle's triangle.
// docs/design_notes/contact_geometry.md gives the exact conditions.
#ifndef DRAPE_LIB_FEATURE_CONTACT_H
#define DRAPE_LIB_FEATURE_CONTACT_H

#include "../../shared/contact.h"
#include "../../shared/mesh.h"
#include "../geometry/face_area.h"

DRAPE_NAMESPACE_BEGIN

// Relative size of a distance at which its direction is rounding noise. Also the width of the seam between
// neighbouring features in which a path that hits both, or by rounding neither, counts as a hit.
#define DRAPE_SEAM 1e-5f

#include "../any_width/one.h"
#include "../any_width/bounds.h"
#include "../any_width/end.h"

typedef struct FeatureEdge
{
    Vec3 m_a, m_b;
} FeatureEdge;

// Edge i joins corners i and (i + 1) % 3.
DRAPE_FUNCTION FeatureEdge triangleEdge(const FeatureTriangle* f, int i)
{
    FeatureEdge e;
    e.m_a = f->m_p[i];
    e.m_b = f->m_p[i == 2 ? 0 : i + 1];
    return e;
}

DRAPE_FUNCTION FeatureTriangle triangleMix(FeatureTriangle f, FeatureTriangle g, float t)
{
    FeatureTriangle r;
    r.m_p[0] = vec3Mix(f.m_p[0], g.m_p[0], t);
    r.m_p[1] = vec3Mix(f.m_p[1], g.m_p[1], t);
    r.m_p[2] = vec3Mix(f.m_p[2], g.m_p[2], t);
    return r;
}

// Results of a feature test: no contact, a contact, or undecided because only the continuous test can decide and must
// not run.
#define DRAPE_NO_CONTACT 0
#define DRAPE_IS_CONTACT 1
#define DRAPE_UNDECIDED 2

DRAPE_FUNCTION void storeContact(Contact* contact, Vec3 normal, Vec3 point, Vec3 weights, float gap0, float gap1,
                                 float time)
{
    contact->m_normal[0] = normal.x;
    contact->m_normal[1] = normal.y;
    contact->m_normal[2] = normal.z;
    contact->m_point[0] = point.x;
    contact->m_point[1] = point.y;
    contact->m_point[2] = point.z;
    contact->m_weights[0] = weights.x;
    contact->m_weights[1] = weights.y;
    contact->m_weights[2] = weights.z;
    contact->m_gap0 = gap0;
    contact->m_gap1 = gap1;
    contact->m_time = time;
}

// Stores a contact of features that are near. point: m, of the contact.
DRAPE_FUNCTION void storeNear(const NearContact* near, Vec3 point, Vec3 weights, Contact* contact)
{
    storeContact(contact, near->m_normal, point, weights, near->m_gap0, near->m_gap1, 1.0f);
}

// Returns whether q, a point of the edge, is nearer to the point than the face beyond the edge. Their offset must not
// lean towards that face's third vertex by more than the seam's width, m.
DRAPE_FUNCTION int leansAway(Vec3 offset, Vec3 opposite, Vec3 q, float seam)
{
    const Vec3 inward = vec3Sub(opposite, q);
    return vec3Dot(offset, inward) <= seam * vec3Length(inward);
}

DRAPE_NAMESPACE_END

#endif
