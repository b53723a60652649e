#include "bullet_plugin/adapter/wiring/log_text.h"

#include <cstdio>

namespace drape
{
std::string nameOf(const btSoftBody& body)
{
    char text[48];
    std::snprintf(text, sizeof text, "soft body %p", static_cast<const void*>(&body));
    return text;
}

void ClothPairCounts::add(PairFlag flag)
{
    if (flag == PairFlag::StartsIntersecting) ++m_intersecting;
    if (flag == PairFlag::Touches) ++m_touching;
    if (flag == PairFlag::Forced) ++m_forced;
}

std::string clothPairText(const btSoftBody& body, const btSoftBody& other, const ClothPairCounts& counts)
{
    std::string text;
    const auto add = [&](std::size_t count, const char* what)
    {
        if (count > 0) text += (text.empty() ? "" : ", ") + std::to_string(count) + what;
    };
    add(counts.m_intersecting, " pairs of triangles intersect where a step begins and are pushed apart");
    add(counts.m_touching, " pairs of features touch there");
    add(counts.m_forced, " pairs of features are brought together by pinned nodes");
    return nameOf(body) + " and " + (&body == &other ? "itself" : nameOf(other)) + ": " + text;
}
}  // namespace drape
