// Collision for the bodies of one solver, step by step: mirrors, submission, the wait, and the contacts sorted by body.
//
// Memory is kept from step to step. begin() needs final predicted positions, submit() returns after enqueueing, and
// finish() waits. Between them nothing may touch the mirrors. Output: for each body its contacts in canonical order, or
// bodies that a device has solved. Errors: exceptions of the pipeline pass through.
#pragma once

#include <functional>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "bullet_plugin/adapter/collision/body_contacts.h"
#include "bullet_plugin/adapter/collision/deformed_pairs.h"
#include "bullet_plugin/adapter/collision/held_group.h"
#include "bullet_plugin/core/solver/host/impact_cut.h"
#include "bullet_plugin/adapter/collision/pair_starts.h"
#include "bullet_plugin/adapter/wiring/plugin_state.h"
#include "bullet_plugin/adapter/wiring/told_problems.h"
#include "bullet_plugin/core/pipeline/add_detection.h"

namespace drape
{
using BodySet = std::unordered_set<const btSoftBody*>;  // compared, not followed

class CollisionStep
{
public:
    explicit CollisionStep(PluginState& state) : m_state(state), m_deformed(state), m_starts(state) {}

    // bringToHost: called for a body on the device (kept_bodies.h) if the step needs its nodes; it predicts them.
    using BringToHost = std::function<void(btSoftBody&)>;
    void begin(const std::vector<PairNote>& notes, BringToHost bringToHost);
    // Returns whether there is anything to submit.
    bool hasPairs() const { return !m_pairs.empty(); }
    // Returns whether most of the bodies had to be solved on the host in the step before, so that they are likely to be
    // in this step: a path met a surface.
    bool neededHost() const { return m_neededHost; }
    const std::vector<BodyContacts>& bodies() const { return m_bodies; }
    // Records the bodies' paths and enqueues the detection. place: where its contacts go, if possible.
    void submit(ContactPlace place);
    // Brings the body to the host if it is on the device.
    void bringToHost(BodyContacts& body);
    // takeSolved: called after the wait if the contacts are on the device; marks bodies that commands enqueued behind
    // the detection have solved (ClothContacts::m_isSolved). Their contacts are not sorted. Null if there are none.
    using TakeSolved = std::function<void()>;
    void finish(const TakeSolved& takeSolved = nullptr);
    // Takes over, once the bodies are solved, how far dynamic obstacles have come, and has checkOffPath() check the
    // bodies beside them.
    void followDynamic();
    // Detects again, once the bodies are solved, along the real paths of bodies whose links pulled nodes far off
    // their predicted paths. Ends those paths before anything that they would have passed. Returns these bodies, with
    // their contacts along the paths.
    std::vector<BodyContacts*> checkOffPath();
    // Adds the bodies that the last checkOffPath() stopped before obstacles that do not yield.
    void addStopped(BodySet& bodies) const;
    // Has checkOffPath() check the body.
    void watch(const btSoftBody& body);
    // Detects along the bodies' real paths, which end at their current positions.
    void detectRealPaths();
    // Lists the bodies with contacts within reach of obstacles that do not yield. Before checkOffPath(), which forgets
    // contacts.
    BodySet listFixed() const;
    // Adds the bodies that share dynamic obstacles with bodies of the set.
    void addSharers(BodySet& bodies) const;
    // Adds the set's bodies, and the dynamic obstacles beside them, to a group that is to be held.
    void addTo(HeldGroup& group, const BodySet& bodies);
    // Detects along the paths of bodies that were held, and reports what passes a surface even so.
    void checkHeld(const BodySet& bodies);
    // Returns whether a path of the last detection passes a surface.
    bool passesSurface(const BodyContacts& body) const { return anyCuts(impactsOf(body)) || endsBehind(body); }
    // Reports, after finish(), a body without a pair in this step whose nodes are still not finite, as they were when
    // it had one.
    void reportInvalid(const btSoftBody& body);
    // Reports cloth that ends the step through an obstacle whose vertices moved in it. Along such a motion faces start
    // where their nodes are carried, so that contacts may miss what reaches the middle of a large face.
    void reportMeetingDeformed();
    // Reports cloth that starts or ends the step on a surface and ends it through that: no contact could tell on which
    // side it belongs.
    void reportLeftSurfaces();
    // Ends a step, after the solver: removes from velocities what pushes gave, and records the nodes' positions.
    void end();

    // Restores the state before the first begin().
    void clear();
    // Releases the memory of earlier steps' bodies. Call before begin().
    void giveBackRoom();
    // Returns the time since begin() for copying nodes and enqueueing, ms.
    double uploadMs() const { return m_uploadMs; }
    // Returns the cloths with a pair in this step that no contact could move: all of their nodes are pinned.
    std::size_t pinnedCloths() const { return m_pinned.size(); }
    // Returns null if the body has no pair in this step.
    BodyContacts* contactsOf(const btSoftBody& body);

private:
    struct Pair
    {
        MeshId m_cloth, m_obstacle;   // m_cloth: the pair's own mesh of the cloth if its obstacle deforms
        const Vec3* m_carriedStarts;  // carried starts in that case, see Carry; else null
        StartingPair m_start;
        PairNote m_note;
    };

    // Nodes of a pipeline mesh that must be written.
    struct Upload
    {
        MeshId m_mesh;
        std::size_t m_body;         // index in m_bodies
        const btVector3* m_starts;  // start positions by node; null: Bullet's own, and their paths are recorded
    };

    void addPair(const PairNote& note);
    void leaveOutField(const PairNote& note);
    Pair makePair(const PairNote& note, const ClothMirror& cloth, MeshId obstacle);
    void addDynamic(BodyContacts& body, MeshId obstacle, const PairNote& note);
    void checkStarts();
    void preparePushes(BodyContacts& body);
    void addContacts(BodyContacts& body, const Contact* first, std::uint32_t count, const OrderedFeature& ordered);
    void addChosen(BodyContacts& body, const Contact* first, std::uint32_t count, const OrderedFeature& ordered,
                   Detection detection);
    const DynamicBody* dynamicOf(MeshId obstacle) const;
    void addPushes(BodyContacts& body);
    void markUnguarded();
    void leaveOut(std::size_t index);
    void uploadNodes(Detection detection);
    void recordPaths(BodyContacts& body);
    void namePairs(Detection detection);
    void listJumped();
    void submit(Detection detection, ContactPlace place = ContactPlace::Host);
    ContactList waitForContacts(const TakeSolved& takeSolved);
    bool isDetected(const BodyContacts& body, Detection detection) const;
    void receiveAll(Detection detection, const TakeSolved& takeSolved = nullptr);
    void receiveHeld(Detection detection, const TakeSolved& takeSolved = nullptr);
    float allowanceOf(MeshId cloth);
    void receive(const ContactList& contacts, Detection detection);
    std::vector<SolverContact> impactsOf(const BodyContacts& body, std::vector<const Contact*>* found = nullptr) const;
    bool isJammed(const BodyContacts& body) const;
    bool touchesFixed(const BodyContacts& body) const;
    void endHold(const BodySet& bodies);
    static bool endsBehind(const BodyContacts& body);
    bool holdJammed();
    void reportPassed();
    bool meetsSurface(const BodyContacts& body) const;
    void tellPassed(std::size_t body);
    std::vector<SolverContact> dynamicImpactsOf(const BodyContacts& body) const;
    bool cutAtImpactsOf(BodyContacts& body, Cut cut, std::vector<Vec3>* slides);
    bool cutBeforeDynamic(BodyContacts& body);
    void restorePaths();
    bool cutPaths();
    bool cutOffPath(Cut cut);
    BodyContacts* bodyOf(MeshId cloth);
    void addBody(ClothMirror& cloth, btSoftBody* body);

    PluginState& m_state;
    std::vector<BodyContacts> m_bodies, m_spare;
    std::unordered_map<MeshId, std::size_t> m_byCloth;  // indices in m_bodies
    std::unordered_map<const btSoftBody*, std::size_t> m_byBody;
    std::vector<Pair> m_pairs;
    std::unordered_map<MeshId, DynamicBody> m_dynamic;  // by mesh of an obstacle
    std::unordered_set<std::uint64_t> m_paired;         // a pair's cloth above its obstacle
    std::vector<const btSoftBody*> m_pinned;
    std::vector<ClothMirror*> m_mirrors;  // one for each of m_bodies
    std::vector<Upload> m_uploads;
    bool m_heldTogether = false;   // any body, since the last detection
    double m_uploadMs = 0;         // see uploadMs()
    bool m_neededHost = false;     // see neededHost()
    bool m_fieldsLeftOut = false;  // a cloth covers too many cells of a height field
    BringToHost m_bringToHost;
    DeformedPairs m_deformed;
    PairStarts m_starts;
    std::vector<std::vector<int>> m_jumped;                  // result of checkStarts(), by body
    std::unordered_set<const btSoftBody*> m_invalid;         // with nodes that were not finite; compared, not followed
    ToldProblems<BodyKey> m_toldLeftOut;                     // bodies left out of steps
    ToldProblems<std::pair<BodyKey, BodyKey>> m_toldFields;  // cloths and height fields that they cover too far
};
}  // namespace drape
