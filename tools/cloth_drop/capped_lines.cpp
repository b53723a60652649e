#include "tools/cloth_drop/capped_lines.h"

#include <cstring>

namespace drape
{
namespace
{
using Clock = CappedLines::Clock;

constexpr char kStep[] = "step ", kStepped[] = "stepped ", kMeasured[] = "measured ";

std::string withTime(const char* word)
{
    return word + std::to_string(std::chrono::nanoseconds(Clock::now().time_since_epoch()).count());
}

bool readTime(const std::string& line, const char* word, Clock::time_point& time)
{
    const std::size_t length = std::strlen(word);
    if (line.compare(0, length, word) != 0) return false;
    time = Clock::time_point(std::chrono::nanoseconds(std::stoll(line.substr(length))));
    return true;
}
}  // namespace

std::string stepLine()
{
    return withTime(kStep);
}

std::string steppedLine()
{
    return withTime(kStepped);
}

std::string measuredLine()
{
    return withTime(kMeasured);
}

double CappedLines::secondsLeft(Clock::time_point time) const
{
    return m_cap.m_seconds - m_spent - std::chrono::duration<double>(time - m_start).count();
}

bool CappedLines::take(const char* text, std::size_t size)
{
    std::size_t start = 0, from = m_text.size();  // the text kept so far has no line feed
    m_text.append(text, size);
    for (std::size_t end; (end = m_text.find('\n', from)) != std::string::npos; from = start = end + 1)
        if (!takeLine(m_text.substr(start, end - start))) return false;
    m_text.erase(0, start);
    return true;
}

bool CappedLines::takeLine(const std::string& line)
{
    Clock::time_point time;
    if (readTime(line, kStep, time))
    {
        ++m_step;
        if (!m_running) m_start = time;
        m_running = true;
        return true;
    }
    if (readTime(line, kStepped, time))
    {
        const double left = secondsLeft(time);
        if (left <= 0) return false;
        if (m_cap.m_measuring) return true;
        m_running = false;
        m_spent = m_cap.m_seconds - left;
        return true;
    }
    if (readTime(line, kMeasured, time)) return !m_running || secondsLeft(time) > 0;
    m_onLine(m_step, line);
    return true;
}
}  // namespace drape
