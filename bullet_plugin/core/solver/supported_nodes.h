// Finds nodes of a step's cloths that lie on obstacles that do not yield, directly or on other layers of cloth that do.
//
// Light cloth between such an obstacle and a heavy body would take hundreds of sweeps to hold the body: its nodes count
// as fixed against that body instead. That is shock propagation (Guendelman, Bridson and Fedkiw 2003). Input: the
// contacts that the step's detections found. Cost: linear in the contacts, and for each layer of cloth in those between
// layers.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "cloth_contacts.h"

namespace drape
{
// A contact of two features of cloth. The first m_split nodes are the first feature's.
struct LayerContact
{
    const SolverNodes* m_cloths[4];
    std::uint32_t m_nodes[4];
    float m_weights[4];  // each feature's add up to 1
    int m_split;
    Vec3 m_normal;    // unit, from the second feature to the first
    float m_recover;  // m, by how much the step moves the features apart
};

// The things that hold a node.
struct NodeSupport
{
    Vec3 m_normals = {};  // sum of the contacts' normals, from what holds it to the node
    float m_advance = 0;  // m, how far what holds it moves the node in the step at most
    int m_level = -1;     // layers of cloth below it; -1: nothing holds it
};

class SupportedNodes
{
public:
    // Distance beyond the resting one, as a share of the thickness, within which cloth may meet an obstacle in a
    // substep.
    static constexpr float kNearBy = 0.25f;

    void clear();
    // Adds the contacts of a cloth with obstacles. Call before add() of layers. source: resolves them.
    void add(const ClothContacts& cloth, const ContactSource& source);
    // Adds a contact of features of cloth that are near each other.
    void add(const LayerContact& contact) { m_layers.push_back(contact); }
    // Passes on what holds the nodes, from layer to layer, after the last add().
    void spread();
    // Returns what holds the node against a push along the normal; null if it can give way.
    const NodeSupport* against(const SolverNodes& cloth, int node, Vec3 normal) const;

private:
    NodeSupport* find(const SolverNodes* cloth, std::uint32_t node);
    bool spread(const LayerContact& contact, bool fromSecond, int level);

    std::unordered_map<const SolverNodes*, std::vector<NodeSupport>> m_byCloth;
    std::vector<LayerContact> m_layers;
};
}  // namespace drape
