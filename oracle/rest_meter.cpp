#include "oracle/rest_meter.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace drape
{
namespace
{
// Returns the square of a node's displacement, m².
double displacement2(const std::vector<float>& from, const std::vector<float>& to, std::size_t node)
{
    double sum = 0;
    for (std::size_t k = 3 * node; k < 3 * node + 3; ++k)
        sum += (double(to[k]) - double(from[k])) * (double(to[k]) - double(from[k]));
    return sum;
}
}  // namespace

RestMeter::RestMeter(std::vector<float> positions) : m_first(std::move(positions)), m_last(m_first) {}

void RestMeter::add(const std::vector<float>& positions, double time)
{
    const std::size_t nodes = m_first.size() / 3;
    double sum2 = 0, most2 = 0, farthest2 = 0;
    for (std::size_t i = 0; i < nodes; ++i)
    {
        const double way2 = displacement2(m_last, positions, i);
        sum2 += way2;
        most2 = std::max(most2, way2);
        farthest2 = std::max(farthest2, displacement2(m_first, positions, i));
    }
    const double speed2 = sum2 / (double(nodes) * time * time);
    m_speed2 += speed2;
    m_worstStep = std::max(m_worstStep, std::sqrt(speed2));
    m_fastestNode = std::max(m_fastestNode, std::sqrt(most2) / time);
    m_farthest = std::max(m_farthest, std::sqrt(farthest2));
    m_time += time;
    ++m_steps;
    m_last = positions;
}

double RestMeter::speed() const
{
    return m_steps > 0 ? std::sqrt(m_speed2 / m_steps) : 0;
}

double RestMeter::creep() const
{
    const std::size_t nodes = m_first.size() / 3;
    double sum2 = 0;
    for (std::size_t i = 0; i < nodes; ++i)
        sum2 += displacement2(m_first, m_last, i);
    return m_time > 0 ? std::sqrt(sum2 / double(nodes)) / m_time : 0;
}
}  // namespace drape
