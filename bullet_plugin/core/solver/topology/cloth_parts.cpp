#include "cloth_parts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kernels/lib/geometry/vec3.h"
#include "revision.h"

namespace drape
{
namespace
{
float along(const Vec3& position, int axis)
{
    return axis == 0 ? position.x : axis == 1 ? position.y : position.z;
}

// Bisects ranges of a node order along their longest axis.
class Bisection
{
public:
    Bisection(const std::vector<Vec3>& positions, std::vector<int>& order) : m_positions(positions), m_order(order) {}

    void halve(std::size_t first, std::size_t last)
    {
        const int axis = longestAxis(first, last);
        const auto before = [&](int a, int b)
        {
            const float x = along(position(a), axis), y = along(position(b), axis);
            return x < y || (x == y && a < b);  // a total order, whichever library sorts
        };
        const auto at = [&](std::size_t i) { return m_order.begin() + static_cast<std::ptrdiff_t>(i); };
        std::nth_element(at(first), at(middle(first, last)), at(last), before);
    }

    static std::size_t middle(std::size_t first, std::size_t last) { return first + (last - first) / 2; }

private:
    const Vec3& position(int node) const { return m_positions[static_cast<std::size_t>(node)]; }

    int longestAxis(std::size_t first, std::size_t last) const
    {
        if (first == last) return 0;
        Vec3 low = position(m_order[first]), high = low;
        for (std::size_t i = first; i < last; ++i)
        {
            low = vec3Least(low, position(m_order[i]));
            high = vec3Most(high, position(m_order[i]));
        }
        const Vec3 size = vec3Sub(high, low);
        if (size.x < size.y) return size.y < size.z ? 2 : 1;
        return size.x < size.z ? 2 : 0;
    }

    const std::vector<Vec3>& m_positions;
    std::vector<int>& m_order;
};
}  // namespace

void ClothParts::cut(std::vector<Vec3> positions, std::size_t mostNodes, ThreadTeam* threads)
{
    for (Vec3& position : positions)
        for (float* coordinate : {&position.x, &position.y, &position.z})
            if (!std::isfinite(*coordinate)) *coordinate = 0;
    m_order.resize(positions.size());
    std::iota(m_order.begin(), m_order.end(), 0);
    m_firsts = {0, positions.size()};
    Bisection bisection(positions, m_order);
    const auto forLeaves = [&](const auto& work)
    {
        if (threads) return threads->run(leafCount(), work);
        for (std::size_t leaf = 0; leaf < leafCount(); ++leaf)
            work(leaf);
    };
    while (positions.size() > mostNodes * leafCount())
    {
        std::vector<std::size_t> finer(2 * leafCount() + 1, 0);
        const auto halve = [&](std::size_t leaf)
        {
            bisection.halve(m_firsts[leaf], m_firsts[leaf + 1]);
            finer[2 * leaf + 1] = Bisection::middle(m_firsts[leaf], m_firsts[leaf + 1]);
            finer[2 * leaf + 2] = m_firsts[leaf + 1];
        };
        forLeaves(halve);
        m_firsts = finer;
    }
    m_leafOf.resize(positions.size());
    const auto number = [&](std::size_t leaf)
    {
        const auto begin = m_order.begin() + static_cast<std::ptrdiff_t>(m_firsts[leaf]);
        const auto end = m_order.begin() + static_cast<std::ptrdiff_t>(m_firsts[leaf + 1]);
        std::sort(begin, end);
        std::for_each(begin, end, [&](int node) { m_leafOf[static_cast<std::size_t>(node)] = firstLeaf() + leaf; });
    };
    forLeaves(number);
    m_revision = newRevision();
}
}  // namespace drape
