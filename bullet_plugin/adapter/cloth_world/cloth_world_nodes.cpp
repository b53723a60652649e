// A ClothWorld's nodes and contacts.
#include <algorithm>

#include "bullet_plugin/adapter/cloth_world/cloth_world_implementation.h"
#include "bullet_plugin/adapter/vectors.h"

namespace drape
{
namespace
{
btVector3 vectorAt(const float* values, std::size_t index)
{
    return btVector3(values[3 * index], values[3 * index + 1], values[3 * index + 2]);
}
}  // namespace

bool ClothWorld::setPinned(int cloth, const std::int32_t* nodes, std::size_t count, bool pinned)
{
    Implementation& self = *m_implementation;
    return self.answer("setPinned", false,
                       [&]
                       {
                           WorldCloth& changed = self.cloth(cloth);
                           requireNodes(nodes, count, changed.m_masses.size(), "nodes");
                           // btSoftBody::setMass() would take links' present lengths for those at rest.
                           for (std::size_t i = 0; i < count; ++i)
                           {
                               btSoftBody::Node& node = changed.m_body->m_nodes[nodes[i]];
                               node.m_im = pinned ? btScalar(0) : 1 / changed.m_masses[std::size_t(nodes[i])];
                               node.m_v.setZero();
                           }
                           changed.m_body->updateLinkConstants();
                           changed.m_body->activate();
                           return true;
                       });
}

bool ClothWorld::setPositions(int cloth, const std::int32_t* nodes, std::size_t count, const float* positions,
                              bool teleport)
{
    Implementation& self = *m_implementation;
    return self.answer("setPositions", false,
                       [&]
                       {
                           WorldCloth& changed = self.cloth(cloth);
                           requireNodes(nodes, count, changed.m_masses.size(), "nodes");
                           requireValues(positions, 3 * count, "positions");
                           for (std::size_t i = 0; i < count; ++i)
                           {
                               btSoftBody::Node& node = changed.m_body->m_nodes[nodes[i]];
                               node.m_x = node.m_q = vectorAt(positions, i);
                           }
                           changed.m_body->activate();
                           if (teleport) self.m_plugin.teleported(changed.m_body.get());
                           return true;
                       });
}

bool ClothWorld::setVelocities(int cloth, const std::int32_t* nodes, std::size_t count, const float* velocities)
{
    Implementation& self = *m_implementation;
    return self.answer("setVelocities", false,
                       [&]
                       {
                           WorldCloth& changed = self.cloth(cloth);
                           requireNodes(nodes, count, changed.m_masses.size(), "nodes");
                           requireValues(velocities, 3 * count, "velocities");
                           for (std::size_t i = 0; i < count; ++i)
                               if (!(changed.m_body->m_nodes[nodes[i]].m_im > 0))
                                   throw InvalidInput("node " + std::to_string(nodes[i]) + " is pinned");
                           for (std::size_t i = 0; i < count; ++i)
                               changed.m_body->m_nodes[nodes[i]].m_v = vectorAt(velocities, i);
                           changed.m_body->activate();
                           return true;
                       });
}

bool ClothWorld::nodes(int cloth, NodeView& view) const
{
    return m_implementation->answer("nodes", false,
                                    [&]
                                    {
                                        const btSoftBody& body = *m_implementation->cloth(cloth).m_body;
                                        const btSoftBody::Node& first = body.m_nodes[0];
                                        view = {first.m_x.m_floats,       first.m_v.m_floats,
                                                first.m_n.m_floats,       std::size_t(body.m_nodes.size()),
                                                sizeof(btSoftBody::Node), sizeof(btScalar)};
                                        return true;
                                    });
}

bool ClothWorld::copyNodes(int cloth, const NodeArrays& arrays) const
{
    return m_implementation->answer("copyNodes", false,
                                    [&]
                                    {
                                        const btSoftBody& body = *m_implementation->cloth(cloth).m_body;
                                        NodeArrays out = arrays;
                                        for (int i = 0; i < body.m_nodes.size(); ++i)
                                        {
                                            const btSoftBody::Node& node = body.m_nodes[i];
                                            if (out.m_positions) writePosition(node.m_x, out.m_positions);
                                            if (out.m_velocities) writePosition(node.m_v, out.m_velocities);
                                            if (out.m_normals) writePosition(node.m_n, out.m_normals);
                                        }
                                        return true;
                                    });
}

bool ClothWorld::contacts(std::vector<ClothContact>& found) const
{
    return m_implementation->answer("contacts", false,
                                    [&]
                                    {
                                        const std::vector<ContactInfo> contacts =
                                            m_implementation->state().m_found.list();
                                        found.clear();
                                        found.reserve(contacts.size());
                                        for (const ContactInfo& contact : contacts)
                                        {
                                            ClothContact own = {};
                                            own.m_cloth = m_implementation->indexOf(contact.m_cloth);
                                            own.m_obstacle = m_implementation->indexOf(contact.m_obstacle);
                                            if (own.m_cloth < 0 || own.m_obstacle < 0) continue;
                                            for (int i = 0; i < 3; ++i)
                                            {
                                                own.m_nodes[i] = contact.m_nodes[i];
                                                own.m_weights[i] = contact.m_weights[i];
                                                own.m_normal[i] = contact.m_normal[i];
                                                own.m_point[i] = contact.m_point[i];
                                            }
                                            own.m_gap = contact.m_gap;
                                            own.m_thickness = contact.m_thickness;
                                            found.push_back(own);
                                        }
                                        return true;
                                    });
}

bool ClothWorld::stepContacts(std::vector<ClothStepContact>& found) const
{
    const auto recordOf = [&self = *m_implementation](const StepContact& contact)
    {
        ClothStepContact own = {};
        own.m_cloth = self.indexOf(contact.m_cloth.m_body);
        own.m_obstacle = contact.m_other.m_body ? -1 : self.indexOf(contact.m_object);
        own.m_triangle = contact.m_triangle;
        own.m_other = contact.m_other.m_body ? self.indexOf(contact.m_other.m_body) : -1;
        for (int i = 0; i < 3; ++i)
        {
            own.m_nodes[i] = contact.m_cloth.m_nodes[i];
            own.m_otherNodes[i] = contact.m_other.m_nodes[i];
            own.m_weights[i] = contact.m_cloth.m_weights[i];
            own.m_otherWeights[i] = contact.m_other.m_weights[i];
            own.m_normal[i] = contact.m_normal[i];
            own.m_point[i] = contact.m_point[i];
            own.m_impulse[i] = contact.m_impulse[i];
        }
        own.m_gap = contact.m_gap;
        own.m_thickness = contact.m_thickness;
        own.m_timeOfImpact = contact.m_timeOfImpact;
        return own;
    };
    return m_implementation->answer("stepContacts", false,
                                    [&]
                                    {
                                        found.clear();
                                        for (const StepContact& contact : m_implementation->state().m_records.list())
                                        {
                                            const ClothStepContact own = recordOf(contact);
                                            if (own.m_cloth >= 0 && std::max(own.m_obstacle, own.m_other) >= 0)
                                                found.push_back(own);
                                        }
                                        return true;
                                    });
}

bool ClothWorld::clothTriangles(std::vector<ClothTriangles>& found) const
{
    return m_implementation->answer("clothTriangles", false,
                                    [&]
                                    {
                                        found.clear();
                                        for (const ClothPairInfo& pair : m_implementation->state().m_clothPairs)
                                        {
                                            ClothTriangles own = {};
                                            for (int side = 0; side < 2; ++side)
                                            {
                                                own.m_cloths[side] = m_implementation->indexOf(pair.m_bodies[side]);
                                                std::copy(pair.m_nodes[side], pair.m_nodes[side] + 3,
                                                          own.m_nodes[side]);
                                            }
                                            if (std::min(own.m_cloths[0], own.m_cloths[1]) >= 0) found.push_back(own);
                                        }
                                        return true;
                                    });
}
}  // namespace drape
