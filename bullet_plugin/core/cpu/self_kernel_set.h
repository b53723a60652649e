// The host's kernels of cloths with themselves for one instruction set, apart from kernel_set.h: both narrow phases
// have functions of the same names. The including file defines DRAPE_SELF_KERNEL_SET, the table's name.
#include "build_options.h"

#include "cpu_kernels.h"
#include "kernels/lib/broad_phase/cull_packet.h"
#include "kernels/lib/cloth_cloth/lane_self_contacts.h"
#include "kernels/lib/cloth_cloth/self_cull.h"
#include "opencl_words.h"

namespace drape
{
namespace
{
#include "kernels/cloth_cloth/self_contact.cl"
#include "kernels/cloth_cloth/self_contact_simd.cl"
#include "kernels/cloth_cloth/self_cull_simd.cl"
#include "kernels/cloth_cloth/self_pack_simd.cl"

void pack(uint item, const ClothView& cloth, const SelfRadii& radii, const SelfPatches& patches, StepCounters* counters)
{
    packSelf(&cloth, &radii, &patches, item, counters);
}

void cull(uint item, const ClothView& cloth, const SelfRadii& radii, const SelfPatches& patches, const TestList& tests)
{
    cullSelf(&cloth, &radii, &patches, item, &tests);
}

void findContacts(uint item, uint items, const SelfInput& input, const ContactSink& sink, uint* swept,
                  StepCounters* counters)
{
    runItem(item, items, [&] { runSelfTests(&input, &sink, swept, counters); });
}

void findSwept(uint item, uint items, const SelfInput& input, const ContactSink& sink, uint* swept,
               StepCounters* counters)
{
    uint searches = 0;
    SelfInput counting = input;
    counting.m_view.m_cloth.m_searches = &searches;
    runItem(item, items, [&] { runSweptSelfTests(&counting, &sink, swept, counters); });
}
}  // namespace

extern const CpuSelfKernels DRAPE_SELF_KERNEL_SET;
const CpuSelfKernels DRAPE_SELF_KERNEL_SET = {pack, cull, findContacts, findSwept};
}  // namespace drape
