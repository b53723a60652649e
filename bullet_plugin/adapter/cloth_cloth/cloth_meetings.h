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
#include "bullet_plugin/adapter/wiring/plugin_state.h"
#include "bullet_plugin/core/cloth_cloth/cloth_guard.h"
#include "bullet_plugin/core/cloth_cloth/contour_push.h"
#include "bullet_plugin/core/solver/host/cloth_rows.h"

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
    // Returns whether a body with these nodes has a row.
    bool hasRows(const SolverNodes& nodes) const;
    // Brings triangles that started the step intersecting apart a little, in the step's first call. Then shortens the
    // way of Bullet's nodes from their starts (m_q) to where they are (m_x). Lists the bodies with nodes that were
    // moved. Adds to the statistics. carries: held nodes carry other cloth along.
    const std::vector<btSoftBody*>& guard(bool carries);
    // Adds the contacts of find() with what the solver's rows gave.
    void record(ContactRecords& records) const;
    // Puts all free nodes back to their starts, at rest.
    void holdStill();

private:
    struct Member
    {
        btSoftBody* m_body;
        const SelfColliding* m_self;
        btScalar m_thickness;  // m
        bool m_isStepped;
        SolverNodes* m_nodes;
        bool m_hasRows;
    };

    std::uint64_t layoutHash() const;
    void assignSet();
    bool canMeet(std::size_t a, std::size_t b) const;
    float thicknessOf(std::size_t a, std::size_t b) const;
    template <class Write>
    void forNodes(const Write& write);
    void addRow(const Contact& found, std::size_t index);
    ClothPoint pointOf(const SelfContactView& view, int first, int count) const;
    StepContact recordOf(const SelfContactView& view) const;
    void listFlagged();
    bool startsAtLastEnds() const;
    void startHeldNodes();
    void checkStarts();
    void listMeeting();
    ClothPairInfo pairAt(std::size_t first) const;
    bool isMeeting(const std::uint32_t nodes[4]) const;
    bool isGuarded(const std::uint32_t nodes[4]) const;
    void pushApart();
    bool isPushed(std::size_t node) const;

    PluginState& m_state;
    std::vector<Member> m_members;
    ClothSet m_set;
    std::uint64_t m_layout = 0;
    std::vector<Contact> m_contacts;
    ClothRows m_rows;
    ClothGuard m_guard;
    ContourPush m_push;
    bool m_wasPushed = false;             // in this step
    std::vector<unsigned char> m_isHeld;  // by node of the set: it goes where Bullet or the app puts it
    // The set's nodes after the last step and after this one; empty if triangles may meet there.
    std::vector<float> m_lastEnds, m_ends;
    std::vector<std::uint32_t> m_meeting;  // see ClothSet::findMeeting()
    std::vector<unsigned char> m_meets;    // by node of the set: it belongs to such a triangle
    std::vector<btSoftBody*> m_moved;      // by the last guard()
};
}  // namespace drape
