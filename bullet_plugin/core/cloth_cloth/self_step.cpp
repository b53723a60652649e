#include "self_step.h"

#include <algorithm>

namespace drape
{
bool SelfReach::any() const
{
    return std::any_of(m_radius.begin(), m_radius.end(), [](float radius) { return radius >= 0.0f; });
}

void SelfReach::leaveOut(std::size_t cloth)
{
    m_thickness[cloth] = m_radius[cloth] = -1.0f;
}

float selfGrowth(float reach)
{
    // Far above the rounding of the volumes' comparisons, for which volumes have their own padding.
    return 0.5f * reach * 1.001f;
}

const float* SelfStep::start() const
{
    return m_view.m_cloth.m_mode == DRAPE_DISCRETE ? m_view.m_cloth.m_end : m_view.m_cloth.m_start;
}
}  // namespace drape
