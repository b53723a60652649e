// One step of collision for the bodies of one solver: mirrors, submission, the wait, and the contacts sorted by body.
//
// begin() needs final predicted positions and returns after enqueueing; finish() waits. Between the two nothing may
// touch the mirrors. Output: for each body its contacts in canonical order. Errors: exceptions of the pipeline pass
// through.
#pragma once

#include <vector>

#include "bullet_plugin/adapter/impact_cut.h"
#include "bullet_plugin/adapter/motion_limit.h"
#include "bullet_plugin/adapter/plugin_state.h"
#include "bullet_plugin/adapter/step_contact.h"

namespace drape
{
struct BodyContacts
{
    MeshId m_cloth;
    btSoftBody* m_body;
    std::vector<StepContact> m_contacts;
    MotionLimit m_limit;
};

class CollisionStep
{
public:
    explicit CollisionStep(PluginState& state) : m_state(state) {}

    void begin(const std::vector<PairNote>& notes);
    void finish();
    // After the bodies were solved. Where links pulled nodes far off their predicted paths, looks again along the paths
    // that they really took, and ends them before what they would have passed.
    void checkStrayed();

    std::vector<BodyContacts>& bodies() { return m_bodies; }
    // Null when the body has no pair in this step.
    BodyContacts* contactsOf(const btSoftBody& body);

private:
    struct Obstacle
    {
        MeshId m_mesh;
        const btCollisionObject* m_object;
        bool m_moves;
        btTransform m_carry;  // see StepContact
    };
    struct Pair
    {
        MeshId m_cloth, m_obstacle;
        btScalar m_thickness;
    };

    void addPair(const PairNote& note);
    void uploadNodes();
    void submit();
    void receiveAll();
    void receive(const ContactView& view);
    bool cutPaths();
    bool cutStrayed(const std::vector<bool>& strayed, Cut cut);
    BodyContacts* bodyOf(MeshId cloth);
    const Obstacle* obstacleOf(MeshId obstacle) const;

    PluginState& m_state;
    std::vector<BodyContacts> m_bodies;
    std::vector<Obstacle> m_obstacles;
    std::vector<Pair> m_pairs;
    std::vector<const ClothMirror*> m_mirrors;  // one for each of m_bodies
};
}  // namespace drape
