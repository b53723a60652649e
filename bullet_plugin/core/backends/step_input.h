// Collects the work of the coming step: pairs of a cloth and an obstacle, cloths that collide with themselves, and the
// motions of obstacles.
//
// Input: names of meshes, by id. Output: StepPairs, by slot. Cost: in proportion to the numbers of pairs and of meshes,
// and to the product of both sides' meshes.
#pragma once

#include <vector>

#include "bullet_plugin/core/lists/step_pairs.h"
#include "bullet_plugin/core/scene/scene.h"
#include "drape/report.h"

namespace drape
{
// A pair named for the coming step; thickness in m.
struct NamedPair
{
    MeshId m_cloth;
    MeshId m_obstacle;
    float m_thickness;

    bool operator==(const NamedPair& other) const
    {
        return m_cloth == other.m_cloth && m_obstacle == other.m_obstacle && m_thickness == other.m_thickness;
    }
};

class StepInput
{
public:
    // Name meshes for the coming step.
    void addPair(const NamedPair& pair) { m_pairs.push_back(pair); }
    void addSelf(MeshId cloth) { m_selfCloths.push_back(cloth); }
    void addKept(const KeptInput& kept) { m_kept.push_back(kept); }

    bool empty() const { return m_pairs.empty() && m_selfCloths.empty(); }
    const std::vector<NamedPair>& pairs() const { return m_pairs; }
    const std::vector<MeshId>& selfCloths() const { return m_selfCloths; }

    // Replaces the pairs by those named since the last call, marks the obstacles as used, and writes the counts of
    // meshes. The scene must be joined. activation: Settings::m_activation.
    void collect(Scene& scene, float activation, StepPairs& step, StepStatistics& statistics);

private:
    void collectPair(const Scene& scene, const NamedPair& pair, float activation, StepPairs& step,
                     StepStatistics& statistics);
    void collectMotions(const MeshPool& obstacles, StepPairs& step) const;
    void collectSelf(const MeshPool& cloths, float activation, StepPairs& step) const;
    // Returns how many obstacles of the pairs are unchanged since the last step, and marks all as used.
    std::size_t countKept(Scene& scene) const;

    std::vector<NamedPair> m_pairs;
    std::vector<MeshId> m_selfCloths;
    std::vector<KeptInput> m_kept;
    std::vector<bool> m_paired;  // per obstacle slot, with any cloth in the step
};
}  // namespace drape
