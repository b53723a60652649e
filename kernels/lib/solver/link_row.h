// Visit of a link: a distance constraint between two nodes, as in btSoftBody::PSolve_Links.
#ifndef DRAPE_LIB_LINK_ROW_H
#define DRAPE_LIB_LINK_ROW_H

#include "../../shared/solver.h"
#include "../geometry/vec3.h"

DRAPE_NAMESPACE_BEGIN

// 2^-23: Bullet leaves out links whose squared lengths add up to no more.
#define DRAPE_LINK_LENGTH2 1.1920929e-7f

// 2^60: a link with larger squared lengths has an invalid node (positionIsValid()), or an invalid rest length.
#define DRAPE_LINK_MOST_LENGTH2 1.15292150e18f

// Moves both nodes by their shares of the correction, which is Bullet's approximation without a root. Leaves them alone
// if the link has no length, or one that is too long or not a number, so that an invalid node does not spread. apart:
// m, from the first node to the second at the step's start. restSquared, strength: see LinkSweep::set().
DRAPE_FUNCTION void visitLink(SolverNode* a, SolverNode* b, Vec3 apart, float restSquared, float strength)
{
    const Vec3 span = vec3Add(apart, vec3Sub(b->m_displacement, a->m_displacement));
    const float length2 = vec3Dot(span, span), sum = restSquared + length2;
    if (!(sum > DRAPE_LINK_LENGTH2) || !(sum < DRAPE_LINK_MOST_LENGTH2)) return;
    const float push = strength * (restSquared - length2) / sum;
    const float pushA = push * a->m_inverseMass, pushB = push * b->m_inverseMass;
    a->m_displacement = vec3Sub(a->m_displacement, vec3Scale(span, pushA));
    b->m_displacement = vec3Add(b->m_displacement, vec3Scale(span, pushB));
}

DRAPE_NAMESPACE_END

#endif
