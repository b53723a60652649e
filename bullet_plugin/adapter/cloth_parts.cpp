#include "bullet_plugin/adapter/cloth_parts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace drape
{
namespace
{
// Bisects ranges of a node order along their longest axis.
class Bisection
{
public:
    Bisection(const std::vector<btVector3>& places, std::vector<int>& order) : m_places(places), m_order(order) {}

    void halve(std::size_t first, std::size_t last)
    {
        const int axis = longestAxis(first, last);
        const auto before = [&](int a, int b)
        {
            const btScalar x = place(a)[axis], y = place(b)[axis];
            return x < y || (x == y && a < b);  // a total order, whichever library sorts
        };
        const auto at = [&](std::size_t i) { return m_order.begin() + static_cast<std::ptrdiff_t>(i); };
        std::nth_element(at(first), at(middle(first, last)), at(last), before);
    }

    static std::size_t middle(std::size_t first, std::size_t last) { return first + (last - first) / 2; }

private:
    const btVector3& place(int node) const { return m_places[static_cast<std::size_t>(node)]; }

    int longestAxis(std::size_t first, std::size_t last) const
    {
        if (first == last) return 0;
        btVector3 low = place(m_order[first]), high = low;
        for (std::size_t i = first; i < last; ++i)
        {
            low.setMin(place(m_order[i]));
            high.setMax(place(m_order[i]));
        }
        return (high - low).maxAxis();
    }

    const std::vector<btVector3>& m_places;
    std::vector<int>& m_order;
};
}  // namespace

void ClothParts::cut(std::vector<btVector3> places)
{
    for (btVector3& place : places)
        for (int axis = 0; axis < 3; ++axis)
            if (!std::isfinite(place[axis])) place[axis] = 0;
    m_order.resize(places.size());
    std::iota(m_order.begin(), m_order.end(), 0);
    m_firsts = {0, places.size()};
    Bisection bisection(places, m_order);
    while (places.size() > kMostNodes * leafCount())
    {
        std::vector<std::size_t> finer{0};
        for (std::size_t leaf = 0; leaf < leafCount(); ++leaf)
        {
            bisection.halve(m_firsts[leaf], m_firsts[leaf + 1]);
            finer.push_back(Bisection::middle(m_firsts[leaf], m_firsts[leaf + 1]));
            finer.push_back(m_firsts[leaf + 1]);
        }
        m_firsts = finer;
    }
    m_leafOf.resize(places.size());
    for (std::size_t leaf = 0; leaf < leafCount(); ++leaf)
    {
        const auto begin = m_order.begin() + static_cast<std::ptrdiff_t>(m_firsts[leaf]);
        const auto end = m_order.begin() + static_cast<std::ptrdiff_t>(m_firsts[leaf + 1]);
        std::sort(begin, end);
        std::for_each(begin, end, [&](int node) { m_leafOf[static_cast<std::size_t>(node)] = firstLeaf() + leaf; });
    }
}
}  // namespace drape
