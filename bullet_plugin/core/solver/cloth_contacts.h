// A cloth of a step as the solver takes it: its nodes, and its contacts by cloth feature, as detection gave them.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "cloth_parts.h"
#include "contact_source.h"
#include "motion_limit.h"
#include "solver_nodes.h"

namespace drape
{
// The contacts of one node, face or edge of a cloth.
struct FeatureContacts
{
    const Contact* m_contacts;  // the pipeline's, until its next submit
    std::uint32_t m_count;
    int m_nodes[3];     // indices of the cloth's nodes; -1 where unused
    float m_leastTime;  // earliest time of impact; 1 when nothing was passed

    std::size_t nodeCount() const { return m_nodes[1] < 0 ? 1 : m_nodes[2] < 0 ? 2 : 3; }
    // Returns 0 for a node, 1 for a face, 2 for an edge.
    std::uint32_t kind() const { return m_nodes[1] < 0 ? 0 : m_nodes[2] < 0 ? 2 : 1; }
};

struct ClothContacts
{
    const ClothParts* m_parts = nullptr;  // the caller owns them
    SolverNodes m_nodes;
    std::vector<FeatureContacts> m_features;  // in canonical order
    MotionLimit m_limit;
    float m_leastThickness = std::numeric_limits<float>::infinity(), m_mostThickness = 0;  // m, over the cloth's pairs
    float m_friction = 0;          // the cloth's factor of a contact's coefficient
    float m_hardness = 0;          // see targetGap()
    float m_perSecond = 0;         // 1/s, steps per second
    float m_kept = 1;              // share of a velocity that damping leaves in a step
    bool m_mayHavePassed = false;  // a contact is left so near that a surface may have been passed

    // Begins another step; memory is kept.
    void start(const ClothParts& parts)
    {
        m_parts = &parts;
        m_leastThickness = std::numeric_limits<float>::infinity();
        m_mostThickness = 0;
        m_features.clear();
        m_limit.clear();
        m_mayHavePassed = false;
    }
    SolverContact resolve(const ContactSource& source, const Contact& contact) const
    {
        return source.resolve(m_nodes, m_friction, m_hardness, contact);
    }
};
}  // namespace drape
