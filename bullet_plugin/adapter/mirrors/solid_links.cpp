#include "bullet_plugin/adapter/mirrors/solid_links.h"

#include <algorithm>
#include <functional>

namespace drape
{
namespace
{
// Links checked per step. Bullet's own functions change the number, the address or only the order of links. A link
// that gets another node in place is detected within links / 1024 steps, or twice that.
constexpr int kLinksPerCheck = 1024;

const void* arrayOf(const btSoftBody& body)
{
    return body.m_links.size() > 0 ? &body.m_links[0] : nullptr;
}

// Hashes a link, so that a sum over many links is practically unique.
std::uint64_t mixed(int a, int b)
{
    std::uint64_t key = std::uint64_t(std::uint32_t(std::min(a, b))) << 32 | std::uint32_t(std::max(a, b));
    key = (key ^ key >> 30) * 0xbf58476d1ce4e5b9ull;  // SplitMix64's multiplier
    key = (key ^ key >> 27) * 0x94d049bb133111ebull;
    return (key ^ key >> 31) | 1;
}
}  // namespace

int nodeIndex(const btSoftBody& body, const btSoftBody::Node* node)
{
    if (body.m_nodes.size() == 0) return kForeign;
    const std::less<const btSoftBody::Node*> before;
    const btSoftBody::Node* const first = &body.m_nodes[0];
    if (before(node, first) || !before(node, first + body.m_nodes.size())) return kForeign;
    return static_cast<int>(node - first);
}

bool hasSolidLink(const btSoftBody& body)
{
    for (int i = 0; i < body.m_links.size(); ++i)
    {
        const btSoftBody::Link& link = body.m_links[i];
        if (!link.m_bbending && link.m_n[0] != link.m_n[1] && nodeIndex(body, link.m_n[0]) != kForeign &&
            nodeIndex(body, link.m_n[1]) != kForeign)
            return true;
    }
    return false;
}

void SolidLinks::joinSurfaces(const btSoftBody& body, const std::vector<std::int32_t>& faces)
{
    m_surfaces.clear(std::size_t(body.m_nodes.size()));
    const auto join = [this](const int* nodes, int count)
    {
        if (std::find(nodes, nodes + count, kForeign) != nodes + count) return;
        for (int k = 0; k < count; ++k)
            m_surfaces.join(std::uint32_t(nodes[0]), std::uint32_t(nodes[k]));
    };
    for (std::size_t i = 0; i + 2 < faces.size(); i += 3)
        join(&faces[i], 3);
    for (int i = 0; i < body.m_tetras.size(); ++i)
    {
        int nodes[4];
        for (int k = 0; k < 4; ++k)
            nodes[k] = nodeIndex(body, body.m_tetras[i].m_n[k]);
        join(nodes, 4);
    }
    m_surfaces.nameGroups();
}

bool SolidLinks::isSolid(Ends ends) const
{
    if (ends.m_a == kForeign || ends.m_b == kForeign || ends.m_a == ends.m_b) return false;
    const std::uint32_t surface = m_surfaces.groupOf(std::size_t(ends.m_a));
    return surface == NodeGroups::kNone || surface != m_surfaces.groupOf(std::size_t(ends.m_b));
}

// Returns an order-independent hash of the range's solid links and the links with a foreign node.
std::uint64_t SolidLinks::sumOf(const btSoftBody& body, int begin, int end) const
{
    std::uint64_t sum = 0;
    for (int i = begin; i < end; ++i)
    {
        const btSoftBody::Link& link = body.m_links[i];
        if (link.m_bbending) continue;
        const Ends ends = {nodeIndex(body, link.m_n[0]), nodeIndex(body, link.m_n[1])};
        const bool foreign = ends.m_a == kForeign || ends.m_b == kForeign;
        if (foreign || isSolid(ends)) sum += mixed(ends.m_a, ends.m_b);
    }
    return sum;
}

void SolidLinks::remember(const btSoftBody& body)
{
    m_linkCount = body.m_links.size();
    m_linkArray = arrayOf(body);
    m_cursor = 0;
    m_seen = 0;
}

void SolidLinks::read(const btSoftBody& body, const std::vector<std::int32_t>& faces)
{
    m_nodes.clear();
    m_hasForeign = false;
    m_tetraCount = body.m_tetras.size();
    joinSurfaces(body, faces);
    for (int i = 0; i < body.m_links.size(); ++i)
    {
        const btSoftBody::Link& link = body.m_links[i];
        if (link.m_bbending) continue;
        const Ends ends = {nodeIndex(body, link.m_n[0]), nodeIndex(body, link.m_n[1])};
        m_hasForeign = m_hasForeign || ends.m_a == kForeign || ends.m_b == kForeign;
        if (isSolid(ends)) m_nodes.insert(m_nodes.end(), {ends.m_a, ends.m_b});
    }
    m_sum = sumOf(body, 0, body.m_links.size());
    remember(body);
}

bool SolidLinks::changed(const btSoftBody& body, bool all)
{
    if (body.m_tetras.size() != m_tetraCount) return true;
    const int links = body.m_links.size();
    if (all || links != m_linkCount || m_linkArray != arrayOf(body))
    {
        remember(body);
        return sumOf(body, 0, links) != m_sum;
    }
    const int end = std::min(links, m_cursor + kLinksPerCheck);
    m_seen += sumOf(body, m_cursor, end);
    m_cursor = end;
    if (end < links) return false;
    const bool other = m_seen != m_sum;
    m_cursor = 0;
    m_seen = 0;
    return other;
}
}  // namespace drape
