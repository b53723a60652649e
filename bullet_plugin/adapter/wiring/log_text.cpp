#include "bullet_plugin/adapter/wiring/log_text.h"

namespace drape
{
void ClothPairCounts::add(PairFlag flag)
{
    if (flag == PairFlag::StartsIntersecting) ++m_intersecting;
    if (flag == PairFlag::Touches) ++m_touching;
    if (flag == PairFlag::Forced) ++m_forced;
}

std::string ClothPairCounts::text() const
{
    std::string text;
    const auto add = [&](std::size_t count, const char* what)
    {
        if (count > 0) text += (text.empty() ? "" : ", ") + std::to_string(count) + what;
    };
    add(m_intersecting, " pairs of triangles intersect where a step begins and are pushed apart");
    add(m_touching, " pairs of features touch there");
    add(m_forced, " pairs of features are brought together by pinned nodes");
    return text;
}
}  // namespace drape
