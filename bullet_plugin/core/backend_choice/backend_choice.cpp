#include "backend_choice.h"

#include <algorithm>

namespace drape
{
namespace
{
// Share of the crossover below which a scene returns to the host. Around the crossover both back ends cost the same,
// and the estimate of a scene's work is right within a factor of about two.
constexpr double kReturnShare = 0.5;
}  // namespace

void BackendChoice::begin(double crossover)
{
    m_pairs.clear();
    m_crossover = crossover;
    m_active = true;
    m_onHost = crossover > 0;
}

void BackendChoice::note(MeshId cloth, MeshId obstacle, double pairs)
{
    m_pairs[cloth][obstacle] = pairs;
}

void BackendChoice::forget(MeshId mesh)
{
    m_pairs.erase(mesh);
    for (auto& cloth : m_pairs)
        cloth.second.erase(mesh);
}

double BackendChoice::pairs() const
{
    double sum = 0;
    for (const auto& cloth : m_pairs)
    {
        double most = 0;
        for (const auto& obstacle : cloth.second)
            most = std::max(most, obstacle.second);
        sum += most;
    }
    return sum;
}

bool BackendChoice::isOnHost()
{
    const double work = pairs();
    if (m_onHost)
        m_onHost = work <= m_crossover;
    else
        m_onHost = work < kReturnShare * m_crossover;
    return m_onHost;
}
}  // namespace drape
