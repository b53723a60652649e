// Contacts of the soft bodies of a step with themselves and with each other, and the guard that keeps them apart.
//
// Input: the solver's bodies that SelfCollision names. begin() lists them, find() makes rows of their contacts along
// the predicted paths, and guard() shortens the paths that the solver made where features of cloth would meet. A GPU
// makes the searches, the host the rest. Errors: exceptions pass through.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_plugin/adapter/cloth_cloth/meeting_answers.h"
#include "bullet_plugin/adapter/collision/collision_step.h"
#include "bullet_plugin/adapter/wiring/plugin_state.h"
#include "bullet_plugin/core/cloth_cloth/cloth_guard.h"
#include "bullet_plugin/core/cloth_cloth/contour_push.h"
#include "bullet_plugin/core/cloth_cloth/stopped_nodes.h"
#include "bullet_plugin/core/solver/host/cloth_rows.h"
#include "bullet_plugin/core/solver/supported_nodes.h"
#include "bullet_plugin/core/solver/topology/node_groups.h"

namespace drape
{
class ClothMeetings
{
public:
    using Bodies = btAlignedObjectArray<btSoftBody*>;
    // Returns the solver's nodes of a body that moves in the step, null for one that rests.
    using NodesOf = std::function<SolverNodes*(const btSoftBody&)>;

    explicit ClothMeetings(PluginState& state) : m_state(state), m_rows(state.threads()) {}

    // Lists the bodies of the step. isStepped: whether a body moves in it.
    void begin(const Bodies& bodies, const std::function<bool(const btSoftBody&)>& isStepped);
    void clear() { m_members.clear(); }
    bool any() const { return !m_members.empty(); }
    // Finds the contacts along the recorded paths, and returns their rows. Nodes must stay in place until the step's
    // end.
    ClothRows& find(const NodesOf& nodesOf);
    // Adds the layers of cloth that lie on each other, by the contacts of find().
    void addLayers(SupportedNodes& supported) const;
    // Returns whether a body with these nodes has a row.
    bool hasRows(const SolverNodes& nodes) const;
    // Brings triangles that started the step intersecting apart a little, in the step's first call. Then shortens the
    // way of Bullet's nodes from their starts (m_q) to where they are (m_x). Lists the bodies with nodes that were
    // moved. Adds to the statistics. carries: held nodes carry other cloth along. fixed: bodies that touch something
    // that takes the momentum of nodes that stop.
    const std::vector<btSoftBody*>& guard(bool carries, const BodySet& fixed);
    // Returns the share of the body's nodes that went on together with others that they stopped, in the last guard().
    float impactShare(const btSoftBody& body) const;
    // Adds the contacts of find() with what the solver's rows gave.
    void record(ContactRecords& records) const;
    // Adds the members with features near those of bodies of the set, by the last guard().
    void addNear(BodySet& bodies) const;
    // Adds the set's members to a group that is to be held.
    void addTo(HeldGroup& group, const BodySet& bodies) const;
    // Takes over where members were put, and reports triangles that intersect there.
    void endHold();

private:
    struct Member
    {
        btSoftBody* m_body;
        SelfColliding* m_self;
        btScalar m_thickness;  // m
        bool m_isStepped;
        SolverNodes* m_nodes;
        bool m_hasRows;
    };

    std::uint64_t layoutHash() const;
    void assignSet();
    void noteFilters();
    bool canMeet(std::size_t a, std::size_t b) const;
    bool mayMeet(std::size_t a, std::size_t b) const;
    btVector3 startOf(std::size_t node) const;
    template <class Write>
    void forNodes(const Write& write);
    void askContacts();
    bool takeRow(std::size_t index, ClothContact& contact);
    ClothPoint pointOf(const SelfContactView& view, int first, int count) const;
    StepContact recordOf(const SelfContactView& view) const;
    void listFlagged();
    bool startsAtLastEnd(std::size_t member) const;
    void startHeldNodes(std::size_t member);
    void checkStarts();
    void nameTangles();
    void readEnds();
    void keepEnds();
    void reportUnguarded();
    void listMeeting();
    ClothPairInfo pairAt(std::size_t first) const;
    bool isTangled(const std::uint32_t nodes[4]) const;
    GuardResult applyGuard(bool carries, const BodySet& fixed);
    bool slowDown(const std::vector<float>& whole, const BodySet& held, bool sticks, bool mayGoOn);
    bool isGuarded(const std::uint32_t nodes[4]) const;
    void pushApart();
    bool isPushed(std::size_t node) const;
    btScalar timeOf(std::size_t node) const;

    PluginState& m_state;
    std::vector<Member> m_members;
    ClothSet m_set;
    std::uint64_t m_layout = 0;
    mutable MeetingAnswers m_answers;  // in this step
    std::vector<Contact> m_contacts;
    ClothRows m_rows;
    ClothGuard m_guard;
    ContourPush m_push;
    bool m_wasPushed = false;             // in this step
    std::vector<unsigned char> m_isHeld;  // by node of the set: it goes where Bullet or the app puts it
    std::uint64_t m_step = 0;
    std::uint64_t m_answersHash = 0;        // hash of what the world's own filter answers
    bool m_isClean = false;                 // no triangles met where the last step left the members
    std::vector<std::uint32_t> m_meeting;   // see ClothSet::findMeeting()
    NodeGroups m_tangles;                   // triangles that intersect, directly or through others
    NodeGroups m_impacts;                   // nodes that stopped each other in the last guard()
    std::vector<unsigned char> m_isShared;  // by node: it goes on with others that it stopped
    std::vector<btSoftBody*> m_moved;       // by the last guard()
};
}  // namespace drape
