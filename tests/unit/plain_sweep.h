// Sweeps over contacts that project every contact in turn, without any short cut: the oracle of ContactSweep.
//
// The order is group by group of the cloth, children first, each colour by colour. Edges come after all other contacts
// in a sweep. Results equal those of ContactSweep bit for bit.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <vector>

#include "bullet_plugin/core/solver/cloth_contacts.h"

namespace drape::test
{
class PlainSweep
{
public:
    // cloth: for its settings and the paths of its nodes, which must not change. The sweeps move nodes of their own,
    // which begin where the cloth's are.
    PlainSweep(const ClothContacts& cloth, const ContactSource& source, const std::vector<Contact>& contacts);

    // Begins a phase, with no pushes. passed: the share of the step that has passed. inTurns: see ContactSweep.
    void restart(float passed, bool inTurns);
    void move(std::size_t node, Vec3 by) { m_places[node] = vec3Add(m_places[node], by); }
    // Sweep once, and return the worst violation that a push can correct, m.
    float run();
    float runNodes();
    void limitSpeeds();
    bool mayHavePassed() const;

    // Displacements from the step's start, m.
    const std::vector<Vec3>& places() const { return m_places; }
    // m/s, with the displacements that run() … made.
    const std::vector<Vec3>& velocities() const { return m_velocities; }
    std::size_t slowed() const { return m_slowed; }
    std::size_t renewed() const { return m_renewals; }
    std::size_t pushed() const;
    // Contacts that were violated only because the obstacle was not at the step's end yet.
    std::size_t early() const { return m_early; }

private:
    struct Row
    {
        Contact m_detected;
        SolverContact m_contact;
        float m_multiplier = 0;
        Vec3 m_held = {};
        std::size_t m_group = 0;
        int m_colour = 0;
        bool m_renewed = false;    // or tried to, in this phase
        bool m_acted = false;      // violated or pushing when it was last visited in this phase
        bool m_everActed = false;  // in any phase
        float m_speedLimit = 0;
    };
    enum class Kind
    {
        Node,
        Face,
        Edge
    };

    static Kind kindOf(const SolverContact& contact);
    void sortRows(const ClothContacts& cloth);
    float sweep(std::initializer_list<Kind> kinds);
    void limitSpeed(const Row& row);
    float sweepEdges();
    void sweepActing(std::size_t group);
    void addVelocities(const std::vector<Vec3>& before);
    Vec3 pointOf(const SolverContact& contact, const std::vector<Vec3>& places) const;
    Vec3 carriedFrom(const SolverContact& contact) const;
    float speedLimitOf(const SolverContact& contact) const;
    float violationOf(const SolverContact& contact, float passed) const;
    float mobilityOf(const SolverContact& contact) const;
    float heldShareOf(const SolverContact& contact) const;
    float softenedOf(const SolverContact& contact) const;
    float shareOf(const SolverContact& contact, int k) const;
    void renewPlane(Row& row);
    float project(Row& row);

    const SolverNodes& m_paths;
    std::vector<Vec3> m_starts, m_places, m_velocities;
    std::vector<Row> m_rows;
    float m_perSecond, m_leastThickness;
    float m_passed = 1;
    bool m_inTurns = false;
    std::size_t m_renewals = 0, m_slowed = 0, m_early = 0;
};
}  // namespace drape::test
