// Names the triangles of a mesh that was read from a shape as Bullet names them to a btTriangleCallback.
//
// Triangles are added in the order of the mesh. Memory: one record for each run of successive triangles of a part, so
// one for each part of an ordinary mesh. name() takes O(log n) in the runs.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace drape
{
struct TriangleName
{
    int m_part, m_triangle;  // -1 where Bullet has no number
};

class TriangleNames
{
public:
    void clear()
    {
        m_runs.clear();
        m_count = 0;
    }
    // Names the next triangle.
    void add(int part, int triangle)
    {
        const std::size_t index = m_count++;
        if (!m_runs.empty() && m_runs.back().m_name.m_part == part &&
            triangle - m_runs.back().m_name.m_triangle == static_cast<int>(index - m_runs.back().m_first))
            return;
        m_runs.push_back({index, {part, triangle}});
    }
    // Returns -1 twice for a triangle without a name.
    TriangleName name(std::size_t index) const
    {
        if (index >= m_count) return {-1, -1};
        const auto after = std::upper_bound(m_runs.begin(), m_runs.end(), index,
                                            [](std::size_t wanted, const Run& run) { return wanted < run.m_first; });
        const Run& run = *(after - 1);
        return {run.m_name.m_part, run.m_name.m_triangle + static_cast<int>(index - run.m_first)};
    }

private:
    struct Run
    {
        std::size_t m_first;  // index of its first triangle
        TriangleName m_name;
    };

    std::vector<Run> m_runs;
    std::size_t m_count = 0;
};
}  // namespace drape
