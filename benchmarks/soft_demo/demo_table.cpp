#include "benchmarks/soft_demo/demo_table.h"

#include <cmath>
#include <cstdio>
#include <sstream>

#include "benchmarks/soft_demo/outcome.h"

namespace drape::bench
{
namespace
{
// Measures with a column of their own; the others share one, which leaves out those that are 0 in both runs.
const Measure kColumns[] = {Measure::Depth, Measure::Stretch, Measure::Rest, Measure::Energy};
const Measure kOthers[] = {Measure::Invalid,    Measure::Below, Measure::Carried, Measure::Disorder,
                           Measure::VolumeLost, Measure::Pairs, Measure::Travel};

std::string number(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, std::abs(value) < 9.995 ? "%.2f" : "%.0f", value);
    std::string shortened = text;
    if (shortened.find('.') == std::string::npos) return shortened;
    shortened.erase(shortened.find_last_not_of('0') + 1);
    if (shortened.back() == '.') shortened.pop_back();
    return shortened == "-0" ? "0" : shortened;
}

// One scene's rows.
struct Pair
{
    const Row &m_stock, &m_drape;

    bool has(const char* column) const { return m_stock.contains(column); }
    double stock(const char* column) const { return m_stock[column]; }
    double drape(const char* column) const { return m_drape[column]; }
    std::string both(const char* column) const
    {
        return has(column) ? number(stock(column)) + ", " + number(drape(column)) : "–";
    }
    std::string others() const
    {
        std::string text;
        for (const Measure measure : kOthers)
        {
            const MeasureRule& rule = ruleOf(measure);
            if (!has(rule.m_name) || (stock(rule.m_name) == 0 && drape(rule.m_name) == 0)) continue;
            text += (text.empty() ? "" : "; ") + std::string(rule.m_title) + ": " + both(rule.m_name);
        }
        return text;
    }
    std::string leftToBullet() const
    {
        const double links = drape("links_left_to_bullet"), contacts = drape("contacts_left_to_bullet");
        if (links == 0 && contacts == 0) return "";
        const std::string what = contacts == 0 ? "links" : "all";
        return what + " of " + number(links) + " of " + number(drape("soft_bodies"));
    }
    std::string outcome() const
    {
        if (m_drape["same_bits"]) return "same, bit for bit";
        return m_drape["verdict"];
    }
};
}  // namespace

std::string demoTable(const Table& table, bool times)
{
    std::ostringstream text;
    text << "| scene | left to Bullet |" << (times ? " ms per step |" : "");
    for (const Measure measure : kColumns)
        text << " " << ruleOf(measure).m_title << " |";
    text << " others | Drape's outcome |\n|---|---|" << (times ? "---|" : "");
    for (std::size_t i = 0; i < std::size(kColumns); ++i)
        text << "---|";
    text << "---|---|\n";
    for (std::size_t i = 0; i + 1 < table.rows().size(); i += 2)
    {
        const Pair pair = {table.rows()[i], table.rows()[i + 1]};
        text << "| `" << pair.m_drape["scene"].get<std::string>() << "` | " << pair.leftToBullet() << " |";
        if (times) text << " " << pair.both("median_ms") << " |";
        for (const Measure measure : kColumns)
            text << " " << pair.both(ruleOf(measure).m_name) << " |";
        text << " " << pair.others() << " | " << pair.outcome() << " |\n";
    }
    return text.str();
}
}  // namespace drape::bench
