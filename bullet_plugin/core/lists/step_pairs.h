// The pairs of one step, by the slots of their meshes, and the moving obstacles among them.
#pragma once

#include <algorithm>
#include <vector>

#include "bullet_plugin/core/cloth_cloth/self_step.h"
#include "bullet_plugin/core/scene/mesh_id.h"
#include "kept_step.h"
#include "kernels/shared/motion.h"
#include "ordinary_tests.h"

namespace drape
{
// A cloth whose nodes are on the device, and its step.
struct KeptInput
{
    MeshId m_cloth;
    KeptStep m_step;
};

struct StepPairs
{
    std::vector<float> m_thickness;         // m, cloth slots × obstacle slots, -1 without a pair
    std::vector<float> m_clothRadius;       // m, per cloth slot: the largest reach of its pairs, -1 without one
    std::vector<ObstacleMotion> m_motions;  // motions of the moving obstacles with a pair, in the order of slots
    std::vector<TestLimits> m_ordinary;     // per cloth slot: what its pairs need in ordinary motion
    TestLimits m_limits;                    // the step's limits, over patches
    SelfReach m_self;
    std::vector<KeptInput> m_kept;  // cloths whose nodes are on the device
    bool m_anyPair = false;         // cloth and obstacle
    bool m_anySelf = false;         // cloth and itself
    bool m_any = false;             // either

    // Returns the number of obstacle slots when the pairs were collected.
    std::size_t obstacleSlots() const { return m_thickness.size() / m_clothRadius.size(); }
    float thickness(std::size_t cloth, std::size_t obstacle) const
    {
        return m_thickness[cloth * obstacleSlots() + obstacle];
    }
    // Returns whether the cloth has a pair with an obstacle.
    bool hasPair(std::size_t cloth) const { return m_clothRadius[cloth] >= 0.0f; }
    // Removes a cloth from the step.
    void leaveOut(std::size_t cloth)
    {
        const std::size_t obstacles = obstacleSlots();
        std::fill_n(m_thickness.begin() + std::ptrdiff_t(cloth * obstacles), obstacles, -1.0f);
        m_clothRadius[cloth] = -1.0f;
        m_anyPair =
            std::any_of(m_clothRadius.begin(), m_clothRadius.end(), [](float radius) { return radius >= 0.0f; });
        m_self.leaveOut(cloth);
        m_anySelf = m_self.any();
        m_any = m_anyPair || m_anySelf;
    }
};
}  // namespace drape
