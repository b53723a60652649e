// One body's contacts of a step, by cloth feature, as detection gave them.
//
// Most of a body's contacts never act in a step: one is resolved when it is needed (found_contacts.h), not before.
// Metres, world frame.
#pragma once

#include <cstdint>
#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_plugin/adapter/cloth_parts.h"
#include "bullet_plugin/adapter/motion_limit.h"
#include "bullet_plugin/core/pipeline.h"

namespace drape
{
// The contacts of one node, face or edge of a cloth.
struct FeatureContacts
{
    const Contact* m_contacts;  // the pipeline's, until its next submit
    std::uint32_t m_count;
    int m_nodes[3];     // of the body; -1 where unused
    float m_leastTime;  // of impact, of all; 1 when nothing was passed
};

struct BodyContacts
{
    MeshId m_cloth = kNoMesh;
    btSoftBody* m_body = nullptr;
    const ClothParts* m_parts = nullptr;                             // the mirror's, of the body's nodes
    btScalar m_leastThickness = SIMD_INFINITY, m_mostThickness = 0;  // of the body's pairs
    std::vector<FeatureContacts> m_features;                         // in canonical order
    MotionLimit m_limit;
    bool m_mayHavePassed = false;  // a contact is left so near that a surface may have been passed

    // For a body of another step; what memory it has stays.
    void start(MeshId cloth, btSoftBody* body, const ClothParts& parts)
    {
        m_cloth = cloth;
        m_body = body;
        m_parts = &parts;
        m_leastThickness = SIMD_INFINITY;
        m_mostThickness = 0;
        m_features.clear();
        m_limit.clear();
        m_mayHavePassed = false;
    }
};
}  // namespace drape
