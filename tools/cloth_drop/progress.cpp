#include "tools/cloth_drop/progress.h"

#include <cstdio>
#include <utility>

#include <unistd.h>

namespace drape
{
namespace
{
constexpr int kBarWidth = 30;
constexpr auto kRedraw = std::chrono::milliseconds(50);  // fast enough to look alive, too seldom to cost anything
}  // namespace

Progress::Progress(std::string title, int steps, bool quiet, std::string unit)
    : m_title(std::move(title)),
      m_unit(std::move(unit)),
      m_steps(steps),
      m_quiet(quiet),
      m_terminal(::isatty(STDERR_FILENO) == 1),
      m_start(std::chrono::steady_clock::now()),
      m_drawn(m_start - kRedraw)
{
}

Progress::~Progress()
{
    if (m_lineOpen) std::fputc('\n', stderr);
}

void Progress::drawBar(int step) const
{
    char bar[kBarWidth + 1];
    const int filled = static_cast<int>(static_cast<long long>(kBarWidth) * step / m_steps);
    for (int i = 0; i < kBarWidth; ++i)
        bar[i] = i < filled ? '#' : '.';
    bar[kBarWidth] = '\0';
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - m_start).count();
    std::fprintf(stderr, "\r%s [%s] %s %d of %d, %.1f s ", m_title.c_str(), bar, m_unit.c_str(), step, m_steps,
                 seconds);
    std::fflush(stderr);
}

void Progress::show(int step)
{
    if (m_quiet) return;
    if (m_terminal)
    {
        const auto now = std::chrono::steady_clock::now();
        if (now - m_drawn < kRedraw && step != m_steps) return;
        m_drawn = now;
        m_lineOpen = true;
        return drawBar(step);
    }
    const int tenths = static_cast<int>(10LL * step / m_steps);
    if (tenths == m_tenths) return;
    m_tenths = tenths;
    std::fprintf(stderr, "%s: %d %% (%s %d of %d)\n", m_title.c_str(), 10 * tenths, m_unit.c_str(), step, m_steps);
}
}  // namespace drape
