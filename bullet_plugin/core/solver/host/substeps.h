// Moves the nodes of a cloth through a step in substeps of equal length, with its links.
//
// A node's path through the step is the parabola from its start to its end under constant acceleration, which includes
// what contacts are expected to give. If the acceleration acted at the step's start, it is a line. A substep moves
// every node along its velocity; then constraints correct the positions, and the velocities follow (Macklin et al.
// 2019, Small Steps in Physics Simulation). Links keep the stiffness that Bullet's iterations give them
// (link_strength.h). The same bits with any number of threads. Cost: linear in nodes and links.
#pragma once

#include <cstddef>
#include <vector>

#include "bullet_plugin/core/solver/solver_nodes.h"
#include "bullet_plugin/core/threads/thread_team.h"
#include "link_sweep.h"

namespace drape
{
class Substeps
{
public:
    // Sweeps over the links in each substep.
    static constexpr int kLinkSweeps = 3;

    LinkSweep& links() { return m_links; }
    const LinkSweep& links() const { return m_links; }
    int count() const { return m_count; }
    // Returns the step's time, s.
    float time() const { return m_time; }
    // Returns the time of a substep, s.
    float substepTime() const { return m_time / float(m_count); }
    // Returns the time by which a correction of a position is divided to give a velocity, s. It is that of a substep,
    // or longer for some steps after a longer one or after changeOver(): errors that those left would otherwise be
    // corrected at great speed.
    float correctionTime() const { return m_correctionTime; }
    // Returns the inverse of the step's time, 1/s.
    float perStep() const { return 1 / m_time; }
    // Returns the share of a velocity that damping leaves in a substep.
    float undamped() const { return m_undamped; }
    // Returns whether nodes that hardly move may come to rest. Where damping takes most of a speed in every step, free
    // nodes hardly move, either.
    bool settles() const { return m_settles; }
    // Returns the share of the acceleration in a node's mean velocity, s.
    float pathTime() const { return pathShare(m_count) * m_time; }
    const Vec3* accelerations() const { return m_accelerations->data(); }
    // Returns the share of the accelerations that acts in the substeps: 1, or 0 if all acted at the step's start.
    float spread() const { return m_spread; }
    const Vec3* supports() const { return m_supports->data(); }

    // Prepares a step of `time` seconds (> 0) in `count` parts. damping: the share of a velocity that is lost in the
    // step, 0 to 1. accelerations: of the nodes, m/s²; supports: what their paths have beside these, m/s²
    // (nodeSupport()). Both must stay in place until the last substep. spread: see spread().
    void prepare(float time, int count, float damping, const std::vector<Vec3>& accelerations,
                 const std::vector<Vec3>& supports, float spread = 1);
    // Records that another solver made the step before, or that a good part of the nodes was put elsewhere after it:
    // links may have other errors than substeps leave. Call before prepare().
    void changeOver() { m_changesOver = true; }
    // Returns the share s in the motion of a free node in a step: time · velocity + s · time² · acceleration.
    static float pathShare(int count) { return 0.5f * (1.0f + 1.0f / float(count)); }

    // Puts the nodes at the starts of their paths, with the velocities that lead to their ends. threads: null for the
    // caller alone, as in the functions below.
    void begin(SolverNodes& nodes, ThreadTeam* threads);
    // Begins a substep: moves the nodes.
    void advance(SolverNodes& nodes, ThreadTeam* threads);
    void sweepLinks(SolverNodes& nodes, ThreadTeam* threads) { m_links.sweep(nodes.nodes(), threads); }
    // Ends a substep: adds the constraints' corrections to the velocities. A node without any keeps its velocity
    // exactly.
    void end(SolverNodes& nodes, ThreadTeam* threads) const;
    // Runs a whole step without contacts.
    void run(SolverNodes& nodes, ThreadTeam* threads);

private:
    LinkSweep m_links;
    const std::vector<Vec3>* m_accelerations = nullptr;
    const std::vector<Vec3>* m_supports = nullptr;
    float m_time = 1;
    float m_correctionTime = 0;
    float m_undamped = 1;
    float m_spread = 1;
    int m_count = 1;
    float m_leastRatio = 1;  // minimum of m_correctionTime, as a share of that of the step before
    bool m_changesOver = false;
    bool m_settles = true;
};
}  // namespace drape
