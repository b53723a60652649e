// Bodies whose nodes stay on the device between steps (Plugin::keepOnDevice()).
//
// A kept body is on the device while the device's nodes are newer than Bullet's, else on the host. On the device its
// step begins without nodes: the device predicts it, and bounds come from boxes that the last step left. A step that
// needs the nodes brings the body to the host: it gets the nodes of the last step's end, and the step goes on as for
// any body, with the same bits. At the step's end its nodes are stored on the device again. Cost of a step on the
// device: some comparisons, and one for each pinned node.
//
// Input: bodies that are alive; others are only compared. Errors: a device that fails leaves bodies with the nodes that
// Bullet has.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_plugin/core/lists/kept_step.h"
#include "drape/node_arrays.h"

namespace drape
{
class PluginState;
class SubstepBody;
class SolveStage;

class KeptBodies
{
public:
    explicit KeptBodies(PluginState& state) : m_state(state) {}

    // Keeps the body from the end of its next step on. Returns null, or why it cannot be kept.
    const char* keep(btSoftBody& body);
    // Takes the nodes as Bullet has them.
    void takeNodes(const btSoftBody& body);
    // Gives the body its nodes and keeps it no more.
    void release(btSoftBody& body);
    // Starts the transfer of a body's nodes to the host.
    void beginFetch(const btSoftBody& body);
    // Gives Bullet's nodes, or the arrays, the nodes of beginFetch(), or those of the last step. Returns whether the
    // body was on the device.
    bool fetch(btSoftBody& body);
    bool fetch(const btSoftBody& body, const NodeArrays& arrays);
    // Brings bodies to the host in their next step, and keeps them no more: nobody is left to fetch them.
    void retire() { m_isRetired = true; }
    // Gives all bodies their nodes as far as possible, and keeps none. Throws nothing.
    void abandon() noexcept;

    // Forgets bodies that the solver stepped and that are not among its bodies any more. Does not follow them.
    void forgetRemoved(const btSoftBodySolver* solver, const btAlignedObjectArray<btSoftBody*>& bodies);
    bool any() const { return !m_bodies.empty(); }
    bool isOnDevice(const btSoftBody& body) const;
    // Returns whether any body's step has begun on the device.
    bool anyBegun() const;
    // Returns whether a node of the stored body is pinned.
    bool hasPins(const btSoftBody& body) const;
    // Begins a step of dt seconds of a body on the device. Returns false if it must be brought to the host first.
    bool begin(btSoftBody& body, int substeps, btScalar dt);
    // Returns whether Bullet's own algorithm may find contacts of the body with the object.
    bool isRead(const btSoftBody& body, const btCollisionObject& object) const;
    // Returns the step that was begun; null for a body on the host.
    const KeptStep* stepOf(const btSoftBody& body) const;
    // Returns the boxes of that step.
    const KeptBoxes& boxesOf(const btSoftBody& body) const;
    // Starts the transfer for bringToHost(), so that several bodies share a wait.
    void beginBringing(const btSoftBody& body);
    // Gives the body the nodes of the last step's end.
    void bringToHost(btSoftBody& body);
    // Returns whether a solver's step had contacts for the body when it was last on the device.
    bool hadPair(const btSoftBody& body) const;
    // Gives the supports (nodeSupport()) that came with a body's nodes, once. substeps: null if Bullet solves the
    // links.
    void giveSupports(const btSoftBody& body, SubstepBody* substeps);
    // Ends a step: bodies on the host are stored on the device. hasPair: the step looked for contacts of the body.
    // substeps: the body's; null if the core does not solve it.
    void endStep(btSoftBody& body, const btSoftBodySolver* solver, bool hasPair, const SubstepBody* substeps);

private:
    struct Kept
    {
        KeptId m_id = 0;
        const btSoftBodySolver* m_solver = nullptr;  // the last step's; compared, not followed
        std::size_t m_count = 0;                     // nodes
        int m_faces = 0, m_links = 0;                // numbers when the nodes were stored
        std::uint64_t m_revision = 0;                // the stage's
        bool m_isOnDevice = false;
        bool m_isBegun = false;  // m_step is the running step
        bool m_hadPair = false;
        KeptStep m_step;
        std::vector<int> m_pins;
        std::vector<btVector3> m_pinnedAt;
        bool m_isReading = false;   // a transfer was begun
        bool m_isBringing = false;  // by beginBringing()
        std::size_t m_waitsBefore = 0;
    };

    // The supports of a body's nodes as the host last got them; empty if they were given. Room for them is made when
    // the nodes are stored, so that bodies get their nodes without more memory.
    struct Supports
    {
        std::vector<Vec3> m_values;                  // m/s², by node
        const btSoftBodySolver* m_solver = nullptr;  // the last step's; compared, not followed
    };

    Kept* find(const btSoftBody& body);
    const Kept* find(const btSoftBody& body) const;
    SolveStage* stage() const;
    void makeRoom(const btSoftBody& body, Kept& kept);
    void freeRoom(const Kept& kept);
    void store(btSoftBody& body, Kept& kept, const SubstepBody* substeps);
    const KeptNode* read(Kept& kept);
    void takeSupports(const btSoftBody& body, const Kept& kept, const KeptNode* nodes);
    bool anyPinMoved(const btSoftBody& body, const Kept& kept) const;

    PluginState& m_state;
    bool m_isRetired = false;
    std::unordered_map<const btSoftBody*, Kept> m_bodies;
    std::unordered_map<const btSoftBody*, Supports> m_supports;  // kept bodies', and released ones' until given
};
}  // namespace drape
