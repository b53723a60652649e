// The collision pipeline mirrors cloths and obstacles, and finds their contacts once a step on the chosen back end.
//
// Job: keep every cloth and obstacle (core/scene); each step collect the pairs, upload the nodes, run the stages on one
// of the back ends (core/backends), and resolve contacts. Input: node positions at the step's start and end, obstacle
// positions when they change, and the pairs to test. Output: contacts in canonical order in host memory. Guarantee:
// same input, same contacts, bit for bit, on every back end. A buffer that is too small grows and the stage runs again.
// Cost: one submission and one wait per step.
//
// Knows no Bullet. Lengths in metres, world frame. Not thread-safe: one pipeline belongs to one thread. Errors: if
// memory runs out, calls throw, and only restart() may follow.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "bullet_plugin/core/lists/contact_view.h"
#include "bullet_plugin/core/lists/kept_step.h"
#include "bullet_plugin/core/ordering/contact_list.h"
#include "bullet_plugin/core/threads/thread_team.h"
#include "drape/error.h"
#include "drape/mesh_description.h"
#include "drape/report.h"
#include "drape/settings.h"

namespace drape
{
class MeshProbe;
class SolveStage;
struct Scene;
struct SearchDevice;
struct StepPairs;

// A range of adjacent nodes of a cloth, and the memory to write them to: x y z per node.
struct NodeStretch
{
    std::size_t m_cloth;  // index in the caller's list
    std::size_t m_first, m_count;
    float *m_start, *m_end;  // first node's positions at the step's start and end
};

class Pipeline
{
public:
    // Opens the device that the settings request and builds its kernels. Returns null and fills error if it is
    // unavailable or fails, or if settings are out of their ranges. If cost decides, the device is prepared in the
    // background, and the host computes until endStart(). If that device fails, the host remains: see deviceReport()
    // and lastError().
    static std::unique_ptr<Pipeline> create(const Settings& settings, Error& error);
    ~Pipeline();
    Pipeline(const Pipeline&) = delete;
    Pipeline& operator=(const Pipeline&) = delete;

    // Recovers a pipeline after a call ended by an exception: releases all meshes, whose ids are not reused, and
    // opens the device anew, which takes as long as a second start. Throws, with nothing changed, if memory runs out.
    void restart();

    // Returns whether the start in the background has ended, and endStart() would not wait.
    bool isStartDone() const;
    // Waits for the start in the background, if there is one, and takes its device: later steps may run there. Results
    // do not depend on this. Invalidates the last step's contacts and the memory of clothStart() and clothEnd(). Do not
    // call between submit() and finish().
    void endStart();

    const DeviceReport& deviceReport() const;
    // Returns the open device, also while the host runs the steps; without one the record's name is "host".
    DeviceInfo openDevice() const;
    // Returns the time for which kernels of the open device have been compiled so far, ms.
    double compileMs() const;

    // Add a mesh; both copy their input. Topology is fixed until remove(). They return kNoMesh, with nothing added,
    // for a mesh with an index out of range; lastError() names it. The next step costs more in proportion to the
    // mesh, and occasionally, where memory grows or gaps close, in proportion to all meshes. For a cloth beside one
    // that collides with itself it costs in proportion to all cloths. remove() costs next to nothing; gaps close once
    // more is vacant than in use.
    MeshId addCloth(const MeshDescription& mesh);
    MeshId addObstacle(const MeshDescription& mesh);
    void remove(MeshId mesh);

    // Uploads new meshes to the device now, and builds the host's data where it is missing and cost may leave these
    // meshes' steps to the host. The next step then does not pay for this. Waits. Do not call between submit() and
    // finish(). Invalidates the last step's contacts.
    void prepare();

    // Releases host memory that only earlier steps with more meshes and contacts needed. Invalidates the last step's
    // contacts. Do not call between submit() and finish().
    void giveBackRoom();

    // Sets new positions (x y z per vertex) of an obstacle that moved or was deformed. Dependent data is rebuilt;
    // other obstacles are unchanged. Counts as a teleport: the motion between old and new is not swept.
    void moveObstacle(MeshId obstacle, const float* positions);

    // Sets the obstacle's own frame at the start and end of the coming steps, until the next call. A pose is three
    // rows of three factors and a shift (m); world = pose × position.
    //
    // Different poses are a rigid motion over the step, treated like the cloth's. Contacts are those at the end pose;
    // their gaps and times are relative to the obstacle, m_gap0 at its start pose. With equal poses the obstacle
    // rests, and a change since the call before is a teleport. From the first call on, its positions are in its own
    // frame. Costs no pass over the vertices on the host when the pipeline has a device.
    void placeObstacle(MeshId obstacle, const float startPose[12], const float endPose[12]);

    // Memory for a cloth's nodes in the coming step: x y z per vertex at the step's start and end. The pipeline owns
    // it (pinned if the device supports it); valid until addCloth, remove or submit.
    float* clothStart(MeshId cloth);
    float* clothEnd(MeshId cloth);
    // Declares that the first `count` nodes of a cloth are written, start and end, and stay unchanged until submit().
    // Their transfer may start while the caller writes others. Optional. It helps if cloths are declared in the order
    // in which they were added, and large ones a part at a time.
    void nodesWritten(MeshId cloth, std::size_t count);
    // Writes and declares the nodes of several cloths: calls write() for ranges of their nodes. A GPU's pipeline
    // shares many ranges with threads(): calls must not depend on their order, and several may run at once.
    void writeNodes(const std::vector<MeshId>& cloths, const std::function<void(const NodeStretch&)>& write);
    // Copies the nodes from a caller's arrays, which hold all the cloths one after the other: x y z per vertex.
    void copyNodes(const std::vector<MeshId>& cloths, const float* start, const float* end);

    // Returns whether a triangle of the obstacle reaches into the box (m, in the frame of its positions as given).
    // O(n).
    bool anyTriangleIn(MeshId obstacle, const float low[3], const float high[3]);
    // Returns the obstacle for queries about nearby points and triangles, in the same frame.
    std::unique_ptr<MeshProbe> makeProbe(MeshId obstacle);

    // Names a pair for the coming step; thickness in m > 0. A cloth without a pair costs nothing.
    void addPair(MeshId cloth, MeshId obstacle, float thickness);

    // Names a cloth that collides with itself (MeshDescription::m_selfThickness > 0) in the coming step. Its features
    // are swept over the step like contacts with obstacles (Settings::m_mode); see
    // kernels/lib/cloth_cloth/self_contact.h.
    void addSelf(MeshId cloth);

    // Declares that a cloth's nodes are on the device (SolveStage::kept()), where the coming step predicts them. Its
    // contacts must stay there: see mayStay().
    void addKept(MeshId cloth, const KeptStep& step);
    // Returns whether contacts of the step that is named so far may stay on the device.
    bool mayStay();

    // Enqueues the step for the pairs named since the last finish(); returns without waiting. place: Device asks that
    // the contacts stay on the device that finds them, for commands enqueued behind the step. The host's own contacts,
    // and those of a step with one-sided obstacles or cloths that collide with themselves, go to the host.
    void submit(ContactPlace place = ContactPlace::Host);
    // Returns the submitted step's list on the device; an empty one if contacts go to the host.
    DeviceContacts contactsOnDevice();
    // Waits, grows buffers and repeats where needed. Contacts are valid until the next submit().
    // allowance: returns a factor on the tests that a cloth's ordinary motion needs (ordinary_tests.h), if a step needs
    // more. Infinity for cloth that keeps its size; little for cloth that came apart or whose pins were displaced.
    // Cloths that need more are left out. Null: infinity.
    using Allowance = std::function<float(MeshId)>;
    ContactList finish(const Allowance& allowance = nullptr);
    // Returns whether the contacts of the last finish() are on the device alone; its list is empty then.
    bool areContactsOnDevice() const;
    // Returns whether the last step ran once: commands enqueued behind it found its contacts.
    bool ranOnce() const;
    // Returns the list that finish() would have returned. Waits if the contacts are on the device.
    ContactList bringContacts();
    // Returns contacts of cloths with themselves of the last finish(), in canonical order; valid as long as its other
    // contacts.
    ContactList selfContacts() const;
    // Returns the cloths that the last finish() left out (kStepClothsLeftOut).
    const std::vector<MeshId>& clothsLeftOut() const;
    // Returns statistics of that step (upload and wait times, counts, status; the adapter adds its own).
    const StepStatistics& statistics() const;
    // Returns the kernel launches since the last call, with Settings::m_profileKernels; empty on the host. Waits for
    // the device.
    std::vector<KernelTime> takeKernelTimes();
    // Returns the sizes of the device's buffers by name; empty on the host.
    std::vector<MemoryUse> deviceMemory() const;
    // Returns the threads set by Settings::m_threads; never null. The pipeline's caller may use them, too, between
    // its calls.
    const std::shared_ptr<ThreadTeam>& threads() const;
    // Returns the stage that solves cloths on a device; null if the host should (Settings::m_solverPlace). nodes: the
    // number in all cloths.
    SolveStage* solveStage(std::size_t nodes);
    // Returns the device for searches among cloths (DeviceClothSearch); null if the host should make them.
    SearchDevice searchDevice();
    // Builds the kernels of these searches now, if there is such a device. Waits. Do not call between submit() and
    // finish().
    void prepareSearch();
    // Waits for all work enqueued so far. Returns false without a device, or if it failed.
    bool waitForDevice();
    // Returns how often the host has waited for the device; 0 without one.
    std::size_t deviceWaits() const;
    // Returns whether a device failed, so that the host runs every step from then on.
    bool deviceFailed() const;
    // Returns the message of the device's failure if the status reports one, or of the mesh that was refused since.
    const Error& lastError() const;

    // Returns the index, as given to addObstacle(), of a triangle of its makeProbe(); -1 for none.
    std::int32_t sourceTriangle(MeshId obstacle, std::uint32_t triangle) const;
    // Resolves a contact of the last finish().
    ContactView view(const Contact& contact) const;
    // Resolves one of selfContacts().
    SelfContactView viewSelf(const Contact& contact) const;
    // Resolves only the cloth's part of a contact of finish(), at a lower cost.
    ClothFeature clothFeature(const Contact& contact) const;
    // Return the meshes and the pairs of the last step, as viewContact() takes them.
    const Scene& scene() const;
    const StepPairs& pairs() const;

private:
    struct Implementation;
    explicit Pipeline(std::unique_ptr<Implementation> implementation);
    std::unique_ptr<Implementation> m_implementation;
};
}  // namespace drape
