// Narrow phase: determines which candidates touch. A device lists unsorted contacts, which ordering sorts; the host
// lists contacts in canonical order at once. Both give the same contacts, bit for bit.
#pragma once

#include <cstdint>

#include "bullet_plugin/core/device/bound_kernel.h"
#include "bullet_plugin/core/lists/feature_test_list.h"
#include "bullet_plugin/core/lists/unsorted_contacts.h"
#include "bullet_plugin/core/scene/device_views.h"
#include "kernels/narrow_phase/narrow_phase_bindings.h"

namespace drape
{
class NarrowPhaseStage
{
public:
    // The data that the feature tests refer to.
    struct Input
    {
        ClothBuffers m_cloths;
        ObstacleBuffers m_obstacles;
        PatchBuffers m_patches;
        BufferView<ObstacleMotion> m_motions;
        std::uint32_t m_mode;  // DRAPE_DISCRETE …
    };
    struct Expected
    {
        std::size_t m_tests;      // about this many; affects speed alone
        std::size_t m_mostSwept;  // if more tests need the continuous test, their contacts are not listed
    };

    void create(Device& device, const ProgramLoader& load);

    // Lists the contacts of the tests. Returns after enqueueing. A discrete step is one launch less, and so is one with
    // few tests.
    void enqueue(Device& device, const Input& input, FeatureTestList& tests, Expected expected,
                 UnsortedContacts& contacts, Buffer<StepCounters>& counters);
    // Returns whether the launch did nothing because there were `tests` tests and far fewer were expected.
    bool skipped(std::size_t tests) const { return tests > m_mostTests; }

private:
    std::size_t m_mostTests = SIZE_MAX;  // tests of the last launches
    BoundKernel<kernels::narrowPhaseFeature> m_feature;
    BoundKernel<kernels::narrowPhaseSwept> m_swept;
    BoundKernel<kernels::narrowPhaseSmall> m_small;
};
}  // namespace drape
