// The collision pipeline: mirrors cloths and obstacles, and once a step finds their contacts on the chosen back end.
//
// Job: hold every cloth and obstacle; each step refit (of what the traversal walks), broad phase, narrow phase,
// reduction, compaction. Input: node positions at the step's start and end, obstacle positions when they change, and
// the pairs to test. Output: contacts in canonical order in host memory. Guarantee: same input, same contacts, bit for
// bit, on every back end; a buffer that is too small grows and the stage runs again. Cost: one submission, one wait a
// step. Knows no Bullet. Lengths in metres, world frame. Not thread-safe: one pipeline belongs to one thread. Errors:
// where memory runs out, calls throw, and nothing but restart() may follow.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "bullet_plugin/core/mesh/mesh_id.h"
#include "bullet_plugin/core/threads/thread_team.h"
#include "drape/error.h"
#include "drape/mesh_description.h"
#include "drape/report.h"
#include "drape/settings.h"
#include "kernels/shared/contact.h"

namespace drape
{
class MeshProbe;

// A contact with its pool-wide indices resolved to meshes: what a solver needs.
struct ContactView
{
    MeshId m_cloth;
    MeshId m_obstacle;
    std::uint32_t m_kind;     // DRAPE_NODE_FACE …; of an edge that is not a triangle's at a vertex DRAPE_FACE_VERTEX
    std::int32_t m_nodes[3];  // nodes of the cloth feature, indices in that cloth; -1 where unused
    std::int32_t m_triangle;  // a cloth triangle that holds the feature, index as given to addCloth; -1: none does
    float m_weights[3];       // of m_nodes, sum 1
    float m_normal[3];        // unit, from the obstacle to the side the cloth came from
    float m_point[3];         // m, on the obstacle
    float m_gap0, m_gap1;  // m, along the normal at the step's start and end as the obstacle sees them, thickness not
                           // subtracted
    float m_thickness;     // m, of the pair
    float m_time;          // time of impact in [0, 1]
};

// A contact of a cloth with itself: a node against a face, or two edges. The first feature's nodes come first, then the
// second's.
struct SelfContactView
{
    MeshId m_cloth;
    std::uint32_t m_kind;     // DRAPE_SELF_NODE_FACE or DRAPE_SELF_EDGE_EDGE
    std::int32_t m_nodes[4];  // node, face's three; or two of each edge; indices in the cloth
    float m_weights[4];       // of m_nodes; those of either feature add up to 1
    float m_normal[3];        // unit, from the second feature to the side the first came from
    float m_point[3];         // m, on the second feature at the step's end
    float m_gap0, m_gap1;     // m, along the normal at the step's start and end, thickness not subtracted
    float m_thickness;        // m, of the pair
    float m_time;             // time of impact in [0, 1]
};

// The cloth feature of a contact, which all contacts of one slot share.
struct ClothFeature
{
    MeshId m_cloth;
    std::int32_t m_nodes[3];  // indices in that cloth; -1 where unused
};

// A contact of a face and a vertex with the cloth's nodes somewhere else: where the two are nearest there.
struct ContactPlane
{
    float m_normal[3];   // unit, on the side of the contact's
    float m_point[3];    // m, on the obstacle
    float m_weights[3];  // of the face's nodes, sum 1
};

// Some adjacent nodes of a cloth, and where they are to be written: x y z per node.
struct NodeStretch
{
    std::size_t m_cloth;  // index in the caller's list
    std::size_t m_first, m_count;
    float *m_start, *m_end;  // of the first of them at the step's start and end
};

// Contacts where the back end left them.
struct ContactList
{
    const Contact* m_first = nullptr;
    std::size_t m_count = 0;

    const Contact* begin() const { return m_first; }
    const Contact* end() const { return m_first + m_count; }
    std::size_t size() const { return m_count; }
    const Contact& operator[](std::size_t i) const { return m_first[i]; }
};

class Pipeline
{
public:
    // Chooses the device and makes its kernels ready. Returns null and fills error when settings ask for what is not
    // there or does not work, or for methods out of their ranges. A device that nobody asked for and that does not work
    // leaves the host: see deviceReport() and lastError().
    static std::unique_ptr<Pipeline> create(const Settings& settings, Error& error);
    ~Pipeline();
    Pipeline(const Pipeline&) = delete;
    Pipeline& operator=(const Pipeline&) = delete;

    // For a pipeline of which a call ended by an exception: lets go of all meshes, whose ids are not given again, and
    // opens the device anew, which takes as long as at a second start. Throws, with nothing changed, where memory runs
    // out.
    void restart();

    const DeviceReport& deviceReport() const;

    // Both copy what they are given. Topology is fixed until remove(). Return kNoMesh, with nothing added, for a mesh
    // with an index out of range; lastError() names it. The next step costs more by what the mesh holds, now and then,
    // where memory grows or gaps close, by what all do; with a traversal that is not the default, and for a cloth
    // beside one that collides with itself, by what all of its side do. remove() costs next to nothing; gaps close once
    // more is vacant than not.
    MeshId addCloth(const MeshDescription& mesh);
    MeshId addObstacle(const MeshDescription& mesh);
    void remove(MeshId mesh);

    // Brings meshes that came to the device now, and builds what the host walks where there is none or where cost may
    // leave these meshes' steps to the host: the next step does not pay for it. Waits. Not between submit() and
    // finish(); contacts of the last step are not to be looked at any more.
    void prepare();

    // Gives back host memory that only earlier steps with more meshes and contacts needed. Contacts of the last step
    // are not to be looked at any more. Not between submit() and finish().
    void giveBackRoom();

    // New positions (x y z per vertex) of an obstacle that moved or was deformed; what hangs on them is made anew, the
    // other obstacles stay as they are. Counts as a teleport: the motion between old and new is not swept.
    void moveObstacle(MeshId obstacle, const float* positions);

    // Where the obstacle's own frame is at the start and at the end of the coming steps, until the next call: three
    // rows of three factors and a shift (m), world = pose × position. Poses that differ are a rigid motion over the
    // step, which counts as the cloth's does: contacts are those at the end pose, their gaps and times those that the
    // obstacle sees, m_gap0 taken at its start pose. Equal poses: it rests there, and a change since the call before is
    // a teleport. From the first call on, its positions are those of its own frame. Costs no pass over the vertices on
    // the host when a device has the pipeline.
    void placeObstacle(MeshId obstacle, const float startPose[12], const float endPose[12]);

    // Where the caller writes a cloth's nodes for the coming step: x y z per vertex at the step's start and end. The
    // memory is the pipeline's (pinned where the device has it), valid until addCloth, remove or submit.
    float* clothStart(MeshId cloth);
    float* clothEnd(MeshId cloth);
    // Tells that the first `count` nodes of a cloth are written, start and end, and stay so until submit(): they may go
    // to the device while the caller writes others. Optional. It helps where cloths are told of in the order in which
    // they were added, and large ones a part at a time.
    void nodesWritten(MeshId cloth, std::size_t count);
    // All of that for several cloths: calls write() for stretches of their nodes, and tells of them as they are
    // written. A GPU's pipeline shares many stretches with threads(): calls must not depend on their order, and several
    // may be under way at once.
    void writeNodes(const std::vector<MeshId>& cloths, const std::function<void(const NodeStretch&)>& write);
    // The same for a caller with arrays of its own, of all the cloths one after the other: x y z per vertex.
    void copyNodes(const std::vector<MeshId>& cloths, const float* start, const float* end);

    // Returns whether a triangle of the obstacle reaches into the box (m, in the frame of its positions as given).
    // O(n).
    bool anyTriangleIn(MeshId obstacle, const float low[3], const float high[3]);
    // The obstacle for questions about what lies where beside it, in the same frame.
    std::unique_ptr<MeshProbe> makeProbe(MeshId obstacle);

    // Names a pair for the coming step; thickness in m > 0. A cloth without a pair costs nothing.
    // tube: m, for a caller that lets no node of the cloth go farther than this from its straight way while it solves:
    // contacts that the others then keep, up to 2 % of the thickness, are left out (kernels/lib/contact_reduction.h).
    // Negative: none of that cloth are, nor of one that has a pair with a one-sided obstacle or one that moves in the
    // step.
    void addPair(MeshId cloth, MeshId obstacle, float thickness, float tube = -1.0f);

    // Names a cloth that collides with itself (MeshDescription::m_selfThickness > 0) in the coming step. Its features
    // are swept over the step as obstacles' contacts are (Settings::m_mode); see kernels/lib/self_contact.h. None of
    // these contacts is left out because others imply it.
    void addSelf(MeshId cloth);

    // Enqueues the step for the pairs named since the last finish(); returns without waiting.
    void submit();
    // Waits, grows buffers and repeats where needed. Contacts are valid until the next submit().
    // allowance: asked of the cloths of a step that needs more tests than ordinary motion does (ordinary_work.h): how
    // many times as many the cloth may make. Infinity for cloth that keeps its size; little for one that came apart or
    // whose pins were put elsewhere. Cloths that need more than that are left out. Null: infinity.
    using Allowance = std::function<float(MeshId)>;
    ContactList finish(const Allowance& allowance = nullptr);
    // Those of cloths with themselves of the last finish(), in canonical order; valid as long as its other contacts.
    ContactList selfContacts() const;
    // The cloths that the last finish() left out (kStepClothsLeftOut).
    const std::vector<MeshId>& clothsLeftOut() const;
    // With statistics of that step (upload and wait times, counts, status; the adapter adds its own).
    const StepStatistics& statistics() const;
    // The kernel launches since the last call, with Settings::m_profileKernels; empty on the host. Waits for the
    // device.
    std::vector<KernelTime> takeKernelTimes();
    // What the device's buffers hold, by name; empty on the host.
    std::vector<MemoryUse> deviceMemory() const;
    // Those that Settings::m_threads asks for; never null. For the pipeline's caller, between its calls, too.
    const std::shared_ptr<ThreadTeam>& threads() const;
    // Whether a device failed, so that the host runs every step from then on.
    bool deviceFailed() const;
    // Message of the device's failure when the status says so, or of the mesh that was refused since.
    const Error& lastError() const;

    // Resolves a contact of the last finish().
    ContactView view(const Contact& contact) const;
    // A DRAPE_FACE_VERTEX contact with the face's nodes (m, x y z each, in the view's order; of an edge's two the
    // second one twice) at other places. False where their direction means nothing: the face touches the vertex, or
    // came past it. O(1).
    static bool planeAt(const Contact& contact, const float nodes[][3], ContactPlane& plane);
    // Resolves one of selfContacts().
    SelfContactView viewSelf(const Contact& contact) const;
    // The cloth's part of a contact of finish(), for less.
    ClothFeature clothFeature(const Contact& contact) const;

private:
    Pipeline();
    struct Implementation;
    std::unique_ptr<Implementation> m_implementation;
};
}  // namespace drape
