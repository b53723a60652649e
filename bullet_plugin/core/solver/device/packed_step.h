// Packs cloths for the device's solver, and unpacks its results.
//
// Input: cloths as StepSolver takes them. The contacts of the detection are sorted on the device. Cost: linear in the
// nodes, and PackedTopology's where that changed.
#pragma once

#include <vector>

#include "bullet_plugin/core/solver/host/contact_sweep.h"
#include "packed_rigid.h"
#include "packed_topology.h"
#include "solve_stage.h"

namespace drape
{
class PackedStep
{
public:
    // Returns whether a device can solve the cloth: the core has its links, and its contacts are the detection's own
    // with obstacles that rest or move as rigid bodies. Its rigid rows are left out of account.
    static bool fits(const SolverCloth& cloth);

    // Packs cloths that fit. They must stay in place until unpack().
    void pack(const std::vector<SolverCloth>& cloths, const ContactSource& source, SolveStage& stage);
    const SolveStep& step() const { return m_step; }
    // Accepts the device's result and marks the cloths as solved, with their nodes. behind: the step was solved behind
    // a detection. Cloths that the device could not solve stay as they were. So do, behind a detection, cloths with a
    // path that meets a surface, and those that may have passed one if their nodes stay on the device. Cloths beside
    // rigid bodies that move stay together.
    void unpack(const SolveWorkWord* words, SolveStage& stage, bool behind) const;

private:
    void packCloth(std::size_t index, const ContactSource& source, const SolveStage& stage);
    void packReach(const SolverCloth& cloth, const ContactSource& source, const SolveStage& stage,
                   SolveCloth& packed) const;
    void packKept(const SolveStage& stage);
    void packRegions(const ClothContacts& contacts, const ContactSource& source, SolveCloth& cloth);
    void copyNodesTo(SolveInputWord* words) const;
    void layOut(const ContactSource& source, SolveStage& stage);
    void describeLaunches();
    bool isSolved(std::size_t cloth, const SolveResult& result, bool behind) const;
    void unpackNodes(std::size_t cloth, const SolveWorkWord* words) const;

    std::vector<SolverCloth> m_cloths;
    PackedTopology m_topology;
    SolveStep m_step;
    std::vector<SolveCloth> m_clothRecords;
    std::vector<SolveSurface> m_surfaces;
    std::vector<SolveRegion> m_regions;
    std::vector<MeshOffsets> m_obstacles;
    PackedRigid m_rigid;
};
}  // namespace drape
