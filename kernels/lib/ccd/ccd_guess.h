// Guesses where and when two features meet: a small box of (t,u,v) about the time at which they lie in one plane,
// found by false position. ccd.h has to prove that the box is a hit and that nothing precedes it.
#ifndef DRAPE_LIB_CCD_GUESS_H
#define DRAPE_LIB_CCD_GUESS_H

#include "ccd_motion.h"

DRAPE_NAMESPACE_BEGIN

// The widest box in u and v, as parts of the features, and in t, as a part of the step.
#define DRAPE_CCD_GUESS_PLACE 0.125f
#define DRAPE_CCD_GUESS_TIME 0.03125f
// The narrowest, 2^-20: nearer to a feature's end the search decides.
#define DRAPE_CCD_GUESS_FINEST 9.5367432e-7f

// Returns six times the signed volume of the features at time t.
DRAPE_FUNCTION float volumeAt(const CcdVectors* v, float t)
{
    return vec3Dot(vec3Mix(v->m_d0, v->m_d1, t), vec3Cross(vec3Mix(v->m_e0, v->m_e1, t), vec3Mix(v->m_g0, v->m_g1, t)));
}

// Returns the time between two at which the features are in one plane, using a few steps of false position; `otherwise`
// if the volume does not change sign.
DRAPE_FUNCTION float coplanarTime(const CcdVectors* v, float low, float high, float otherwise)
{
    float before = volumeAt(v, low), after = volumeAt(v, high);
    const float side = after < 0.0f ? -1.0f : 1.0f;  // products of volumes would underflow for small features
    if (!(side * before < 0.0f)) return otherwise;
    float time = low;
    for (int i = 0; i < 4 && before != after; ++i)
    {
        time = low + (high - low) * (before / (before - after));
        const float middle = volumeAt(v, time);
        if (side * middle > 0.0f)
        {
            high = time;
            after = middle;
        }
        else
        {
            low = time;
            before = middle;
        }
    }
    return time;
}

// Returns the largest power of two up to x, which is finite and not negative; 0 for denormals.
DRAPE_FUNCTION float powerOfTwoBelow(float x)
{
    return drapeFromBits(drapeBits(x) & 0x7f800000u);
}

// Returns the lower end of an interval of the given width, a power of two. A quarter or more of it lies on each side of
// x, or it begins at 0. x: not negative. Exact.
DRAPE_FUNCTION float intervalAbout(float x, float width)
{
    const float grain = 0.5f * width;
    return grain * (float)(int)drapeMax(x / grain - 0.5f, 0.0f);
}

// Finds when and where the features are in one plane: aim's low ends, inside the features; its widths are 0. Returns
// whether they cross there, and if so a box about it.
DRAPE_FUNCTION int ccdGuessBox(const CcdMotion* m, float timeTolerance, CcdBox* aim, CcdBox* box)
{
    const CcdVectors* v = &m->m_vectors;
    const float nearer = drapeAbs(volumeAt(v, 0.0f)) < drapeAbs(volumeAt(v, 1.0f)) ? 0.0f : 1.0f;
    const float crossing = coplanarTime(v, 0.0f, 1.0f, -1.0f);
    const float time = crossing < 0.0f ? nearer : crossing;
    const Vec3 d = vec3Mix(v->m_d0, v->m_d1, time);
    const Vec3 e = vec3Mix(v->m_e0, v->m_e1, time);
    const Vec3 g = vec3Mix(v->m_g0, v->m_g1, time);
    const Vec3 normal = vec3Cross(e, g);
    const float scale = 1.0f / drapeMax(vec3Dot(normal, normal), DRAPE_FLUSH);
    const float along[2] = {vec3Dot(normal, vec3Cross(d, g)) * scale, vec3Dot(normal, vec3Cross(e, d)) * scale};
    const float least = drapeMin(along[0], along[1]), most = drapeMax(along[0], along[1]);
    const float beyond = m->m_triangular ? 0.5f * (1.0f - along[0] - along[1]) : 1.0f - most;
    const float margin = drapeMin(least, beyond);
    const int inside = crossing >= 0.0f && margin >= DRAPE_CCD_GUESS_FINEST;
    // The box is as wide in v as in u: F's variation along u with v and t must be less than along u itself.
    const float width = inside ? powerOfTwoBelow(drapeMin(margin, DRAPE_CCD_GUESS_PLACE)) : 1.0f;
    aim->m_low[0] = time;
    aim->m_width[0] = 0.0f;
    box->m_width[0] = powerOfTwoBelow(drapeMax(drapeMin(timeTolerance, DRAPE_CCD_GUESS_TIME), DRAPE_CCD_GUESS_FINEST));
    box->m_low[0] = drapeMin(intervalAbout(time, box->m_width[0]), 1.0f - box->m_width[0]);
    for (int i = 0; i < 2; ++i)
    {
        aim->m_low[i + 1] = drapeMin(drapeMax(along[i], 0.0f), 1.0f);
        aim->m_width[i + 1] = 0.0f;
        box->m_low[i + 1] = inside ? intervalAbout(along[i], width) : 0.0f;
        box->m_width[i + 1] = width;
    }
    return inside;
}

DRAPE_NAMESPACE_END

#endif
