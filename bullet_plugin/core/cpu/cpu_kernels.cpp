#include "cpu_kernels.h"

#include <array>

#include "bullet_plugin/core/platform/compiler.h"

namespace drape
{
extern const CpuKernels kernelsOfAnyCpu;
#ifdef DRAPE_X86_KERNELS
extern const CpuKernels kernelsOfAvx2, kernelsOfAvx512;
#endif

namespace
{
struct Sets
{
    std::array<const CpuKernels*, 3> m_sets = {};
    std::size_t m_count = 0;

    Sets()
    {
#ifdef DRAPE_X86_KERNELS
        if (hasAvx512()) m_sets[m_count++] = &kernelsOfAvx512;
        if (hasAvx2()) m_sets[m_count++] = &kernelsOfAvx2;
#endif
        m_sets[m_count++] = &kernelsOfAnyCpu;
    }
};

const Sets& sets()
{
    static const Sets all;
    return all;
}
}  // namespace

const CpuKernels& cpuKernels()
{
    return *sets().m_sets[0];
}

const CpuKernels* const* allCpuKernels(std::size_t& count)
{
    count = sets().m_count;
    return sets().m_sets.data();
}
}  // namespace drape
