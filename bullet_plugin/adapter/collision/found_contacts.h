// The contacts of the last detection, and Bullet's objects for the meshes that they name.
//
// Job: name bodies and obstacles for the solver's source of contacts, and list all contacts for Plugin::contacts().
// Input: the pipeline's list, which the pipeline owns; it is valid until the pipeline's next submit. A list that is on
// the device comes to the host when list() asks for it.
#pragma once

#include <unordered_map>
#include <vector>

#include "bullet_plugin/adapter/motion/kinematic_motion.h"
#include "bullet_plugin/core/pipeline/pipeline.h"
#include "bullet_plugin/core/solver/contact_source.h"
#include "drape/contacts.h"
#include "drape/plugin.h"

namespace drape
{
class ObstacleMirror;

// A pair of the step. Pointers are the caller's to keep valid.
struct FoundPair
{
    const btSoftBody* m_body;
    MeshId m_obstacle;
    float m_thickness;  // m
};

class FoundContacts
{
public:
    // Forgets all contacts and names.
    void clear() { *this = FoundContacts(); }
    void nameCloth(MeshId cloth, const btSoftBody* body) { m_bodies[cloth] = body; }
    void nameObstacle(const ObstacleMirror& mirror, const BodyMotion& motion);
    void namePair(const FoundPair& pair) { m_pairs.push_back(pair); }
    const std::vector<FoundPair>& pairs() const { return m_pairs; }
    void set(Pipeline& pipeline, const ContactList& contacts);
    void setOnDevice(Pipeline& pipeline, const DeviceContacts& contacts);
    // Keeps list() as it is now until clear(), whatever is found later.
    void keepList();
    std::vector<ContactInfo> list() const;
    // Returns a contact of the current detection, without its impulse and its final gap.
    StepContact recordOf(const Contact& contact) const;

    ContactSource& source() { return m_source; }
    const ContactSource& source() const { return m_source; }

private:
    ContactInfo infoOf(const Contact& contact) const;

    std::unordered_map<MeshId, const btSoftBody*> m_bodies;
    std::unordered_map<MeshId, const ObstacleMirror*> m_obstacles;  // valid until the step ends
    std::unordered_map<MeshId, const btCollisionObject*> m_objects;
    std::vector<FoundPair> m_pairs;
    ContactSource m_source;
    Pipeline* m_pipeline = nullptr;
    std::vector<ContactInfo> m_kept;
    bool m_keeps = false;
};
}  // namespace drape
