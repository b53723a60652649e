#include <cstdio>

#include "bullet_plugin/core/public_call.h"
#include "drape/report.h"
#include "drape/settings.h"

namespace drape
{
void logToStandardError(const char* line)
{
    std::fprintf(stderr, "drape: %s\n", line);
}

std::string statusText(std::uint32_t status)
{
    const struct
    {
        std::uint32_t m_bit;
        const char* m_text;
    } clauses[] = {
        {kStepInvalidNodes, "nodes that are not finite, or lie beyond 2^30 m, were left out"},
        {kStepDeviceFailed, "the device failed and the host took over"},
        {kStepDeviceFull, "the step needed more than the device can hold, so the host ran it"},
        {kStepClothsLeftOut, "cloths that need too many tests were left out"},
        {kStepCoarsePositions, "an obstacle lies so far out that its positions are coarser than the thickness"},
        {kStepStartsIntersecting, "triangles of a cloth and an obstacle intersected when the step began"},
        {kStepFacesLeftOut, "faces or links that name another body's nodes were left out"},
        {kStepSurfacePassed, "a surface may have been passed where links pulled"},
        {kStepMotionHeldBack,
         "nodes were held back on their way: cloth that came apart, or no room between cloth and obstacles"},
        {kStepOutOfMemory, "memory ran out and cloth beside meshes stood still"},
        {kStepClothsMeet, "cloth meets itself or other cloth"},
    };
    return guardedOr(std::string(kOutOfMemory),
                     [&]
                     {
                         std::string text;
                         for (const auto& clause : clauses)
                             if (status & clause.m_bit) text += (text.empty() ? "" : "; ") + std::string(clause.m_text);
                         return text;
                     });
}
}  // namespace drape
