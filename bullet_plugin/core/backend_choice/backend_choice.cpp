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
    m_work.clear();
    m_crossover = crossover;
    m_active = true;
    m_onHost = crossover > 0;
}

void BackendChoice::setWork(MeshId cloth, MeshId obstacle, double pairs)
{
    m_work[cloth][obstacle] = pairs;
}

void BackendChoice::forget(MeshId mesh)
{
    m_work.erase(mesh);
    for (auto& cloth : m_work)
        cloth.second.erase(mesh);
}

double BackendChoice::work() const
{
    double sum = 0;
    for (const auto& cloth : m_work)
    {
        double most = 0;
        for (const auto& obstacle : cloth.second)
            most = std::max(most, obstacle.second);
        sum += most;
    }
    return sum;
}

bool BackendChoice::chooseHost()
{
    const double now = work();
    if (m_onHost)
        m_onHost = now <= m_crossover;
    else
        m_onHost = now < kReturnShare * m_crossover;
    return m_onHost;
}
}  // namespace drape
