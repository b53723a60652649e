#include "drape/report.h"

namespace drape
{
std::string statusText(std::uint32_t status)
{
    const struct
    {
        std::uint32_t m_bit;
        const char* m_text;
    } clauses[] = {
        {kStepInvalidNodes, "nodes that are not finite or beyond 2^30 m left out"},
        {kStepDeviceFailed, "the device failed and the host took over"},
        {kStepDeviceFull, "more than the device can hold, so the host ran the step"},
        {kStepClothsLeftOut, "cloths with too many candidates or contacts left out"},
        {kStepCoarsePositions, "an obstacle so far out that its positions are coarser than the thickness"},
        {kStepFacesLeftOut, "faces that name another body's nodes left out"},
    };
    std::string text;
    for (const auto& clause : clauses)
        if (status & clause.m_bit) text += (text.empty() ? "" : "; ") + std::string(clause.m_text);
    return text;
}
}  // namespace drape
