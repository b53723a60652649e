// A cloth of a step as the solver takes it: its nodes, and its contacts by cloth feature, as detection gave them.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "bullet_plugin/core/solver/host/motion_limit.h"
#include "bullet_plugin/core/solver/topology/feature_order.h"
#include "contact_source.h"
#include "solver_nodes.h"

namespace drape
{
// The contacts of one node, face or edge of a cloth.
struct FeatureContacts
{
    const Contact* m_contacts;  // the pipeline's, until its next submit
    std::uint32_t m_count;
    const OrderedFeature* m_feature;  // in the cloth's order
    float m_leastTime;                // earliest time of impact; 1 when nothing was passed

    // Returns the indices of the cloth's nodes; -1 where unused.
    const int* nodes() const { return m_feature->m_nodes; }
};

// An obstacle beside which a cloth has a pair.
struct ClothObstacle
{
    MeshId m_mesh;
    float m_thickness;  // m
};

struct ClothContacts
{
    MeshId m_mesh = kNoMesh;                // the pipeline's; none for a cloth without pairs
    const ClothParts* m_parts = nullptr;    // the caller owns them
    const FeatureOrder* m_order = nullptr;  // the caller's; null for a cloth without contacts
    SolverNodes m_nodes;
    std::vector<Vec3> m_slides;               // m/s, by node, see cutAtImpacts(); empty if no path was cut
    std::vector<FeatureContacts> m_features;  // in canonical order
    bool m_isFiltered = false;                // m_features are not all of the detection's contacts and no others
    std::vector<ClothObstacle> m_obstacles;   // in the order of the limit's regions
    MotionLimit m_limit;
    float m_leastThickness = std::numeric_limits<float>::infinity(), m_mostThickness = 0;  // m, over the cloth's pairs
    float m_friction = 0;          // the cloth's factor of a contact's coefficient
    float m_hardness = 0;          // see targetGap()
    float m_perSecond = 0;         // 1/s, steps per second
    float m_undamped = 1;          // share of a velocity that damping leaves in a step
    bool m_movesOnly = false;      // closing sweeps leave velocities as they are
    bool m_mayHavePassed = false;  // a contact is left so near that a surface may have been passed
    bool m_isSolved = false;       // the step is solved

    // Begins another step; memory is kept.
    void start(MeshId mesh, const ClothParts& parts, const FeatureOrder* order)
    {
        m_mesh = mesh;
        m_parts = &parts;
        m_order = order;
        m_leastThickness = std::numeric_limits<float>::infinity();
        m_mostThickness = 0;
        m_slides.clear();
        m_features.clear();
        m_isFiltered = false;
        m_obstacles.clear();
        m_limit.clear();
        m_movesOnly = m_mayHavePassed = m_isSolved = false;
    }
    // Gives the nodes the velocities that cuts of their paths left along surfaces.
    void addSlides()
    {
        for (std::size_t i = 0; i < m_slides.size(); ++i)
            m_nodes.addVelocity(i, m_slides[i]);
        m_slides.clear();
    }
    SolverContact resolve(const ContactSource& source, const Contact& contact) const
    {
        return source.resolve(m_nodes, m_friction, m_hardness, contact);
    }
};
}  // namespace drape
