// One soft body whose motion and links the core solves, in substeps of the step (core/solver/host/substeps.h). Bullet
// predicts; the core replaces btSoftBody::solveConstraints().
//
// Forces and velocities are Bullet's. What predictMotion() adds to a velocity is the acceleration of the step. With
// forces of the app, volume or pressure that is gravity's; those forces change the velocity at the step's start. Links
// keep the stiffness that Bullet's iterations give them (core/solver/link_strength.h). The body's own numbers are read
// in every step, so changes between steps count in the next one. Cost: linear in nodes and links.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_plugin/adapter/solver/rigid_bodies.h"
#include "bullet_plugin/core/solver/cloth_contacts.h"
#include "bullet_plugin/core/solver/host/substeps.h"
#include "bullet_plugin/core/threads/thread_team.h"

namespace drape
{
class ClothMirror;

class SubstepBody
{
public:
    // Returns why Bullet's own solver must solve the body; null if this class can.
    static const char* reasonForBullet(const btSoftBody& body);
    // Returns the same without a look at the links.
    static const char* reasonFromSettings(const btSoftBody& body);
    // Returns whether this class can solve the step that has been predicted. Contacts of Bullet's own algorithms count,
    // too. Reads the links. threads: null for the caller alone.
    bool canSolveNow(const btSoftBody& body, ThreadTeam* threads);

    // Records that Bullet solved the step before, or that a good part of the nodes was put elsewhere after it.
    void changeOver() { m_substeps.changeOver(); }
    // Makes room for a step of the body. A body that sleeps needs none.
    void reserve(const btSoftBody& body);
    // Sets the number of substeps of the coming step, after reserve(). Without a call it is leastSubstepsOf(body).
    void setSubsteps(int count) { m_count = count; }
    // Returns the number of substeps of the step that was reserved.
    int count() const { return m_count; }
    // Records the velocities before the body's prediction, after reserve(). Allocates no memory. threads: null for the
    // caller alone.
    void beforePrediction(const btSoftBody& body, ThreadTeam* threads);
    // Brings the predicted positions to where substeps take free nodes, and nodes that contacts hold. Call after the
    // prediction, with the same nodes. Allocates no memory.
    void afterPrediction(btSoftBody& body, ThreadTeam* threads);
    // Begins a step whose nodes the device predicts (kept_bodies.h).
    void predictOnDevice()
    {
        m_isPredicted = m_isOnDevice = true;
        m_isSupported = false;
        m_hasForces = false;
    }
    // Returns whether the step has begun so, and the nodes have not come since.
    bool isOnDevice() const { return m_isOnDevice; }
    // Returns how far the end of a path in substeps lies from Bullet's prediction, s²: per unit of acceleration, and of
    // support (nodeSupport()). substeps: their number.
    static btScalar pathShift(const btSoftBody& body, int substeps);
    static btScalar supportShift(const btSoftBody& body, int substeps);
    // Returns whether this object solved the last step, and by node how contacts held it then, m/s² (nodeSupport()).
    bool isSupported() const { return m_isSupported; }
    const std::vector<Vec3>& supports() const { return m_supports; }
    // Takes these from a step of the device; call before the prediction.
    void setSupports(const std::vector<Vec3>& supports);
    // Returns the velocities before the prediction, m/s; with forces of the app, volume or pressure those after them.
    const std::vector<btVector3>& velocities() const { return m_velocities; }
    // Returns whether the body has the nodes of the prediction.
    bool fits(const btSoftBody& body) const;
    // Leaves the step to Bullet, with Bullet's prediction.
    void leave(btSoftBody& body);
    // Returns whether this object solves the coming step.
    bool isPredicted() const { return m_isPredicted; }

    // Returns the number of substeps that the body asks for: piterations, but at least kLeastSubsteps.
    static int leastSubstepsOf(const btSoftBody& body);

    // Prepares the solver's step, once, after canSolveNow(). recorded: the cloth with the paths that were recorded;
    // null: alone(). mirror: the body's, null if there is none. It names the mesh of a cloth without pairs, so that a
    // device's data stays the same.
    void begin(const btSoftBody& body, ClothContacts* recorded, const ClothMirror* mirror, ThreadTeam* threads);
    // Gives the recorded paths the ends that the prediction knows more precisely, unless they were moved since. Records
    // the paths of alone().
    void readPaths(const btSoftBody& body, ClothContacts* recorded, ThreadTeam* threads);
    // Adds rows for the rigid bodies that the body touches or hangs on, after readPaths(). nodes: those of it.
    void addRows(const btSoftBody& body, const SolverNodes& nodes, RigidBodies& bodies);
    // Adds a row for a contact with the mesh of a dynamic body, after addRows().
    void addRow(const DynamicBody& body, btScalar dt, const SolverContact& contact, const SolverNodes& nodes,
                const SupportedNodes& supported, RigidBodies& bodies)
    {
        bodies.addRow(body, dt, contact, nodes, supported, m_rigidRows);
    }
    // The cloth of a body without pairs.
    ClothContacts& alone() { return m_alone; }
    Substeps& substeps() { return m_substeps; }
    // Returns the rows of the last addRows(); null if there are none.
    RigidRows* rigidRows() { return m_rigidRows.empty() ? nullptr : &m_rigidRows; }
    // Gives the body the solver's result. Returns the number of its nodes whose positions are not valid. threads: null
    // for the caller alone.
    std::size_t end(ClothContacts& cloth, btSoftBody& body, ThreadTeam* threads);

private:
    static constexpr int kLeastSubsteps = 2;

    // The predicted end of a node, m, and the vector to it without the rounding of positions.
    struct Prediction
    {
        btVector3 m_end, m_vector;
    };

    // A link as Bullet has it: its nodes' indices, Bullet's m_c0 and m_c1, and the stiffness of its material.
    struct LinkInput
    {
        std::uint32_t m_nodes[2];
        float m_c0, m_c1, m_stiffness;
    };

    bool readLinks(const btSoftBody& body, ThreadTeam* threads);
    void cutLinks(const btSoftBody& body);
    void sortLinks();
    void setLinks(const btSoftBody& body, ThreadTeam* threads);
    // Returns Substeps::spread().
    btScalar spread() const { return m_hasForces ? btScalar(0) : btScalar(1); }

    bool m_isPredicted = false;
    bool m_isOnDevice = false;            // the device predicts the nodes
    bool m_hasForces = false;             // the app's, of volume or of pressure
    std::vector<btVector3> m_velocities;  // before the prediction, m/s; with m_hasForces with what they add
    std::vector<Vec3> m_accelerations;    // m/s², constant in the step; with m_hasForces gravity
    std::vector<Vec3> m_supports;         // m/s², of the step before, then of this one
    bool m_isSupported = false;           // m_supports is of the step before
    std::vector<Prediction> m_predictions;
    std::vector<LinkInput> m_links;  // by link, as last read
    int m_iterations = 0;            // piterations when they were set
    int m_setCount = 0;              // m_count when they were set
    int m_count = kLeastSubsteps;    // substeps of the step
    bool m_isSorted = false;         // the links' nodes are those of the sweeps
    bool m_isSet = false;            // the links' lengths and strengths are, too
    ClothParts m_parts;              // by which they are sorted
    ClothContacts m_alone;           // for steps without pairs
    ClothFaces m_noFaces;
    Substeps m_substeps;
    RigidRows m_rigidRows;
};
}  // namespace drape
