#include "tools/cloth_drop/report.h"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <optional>

namespace drape
{
namespace
{
using Json = nlohmann::ordered_json;

Json asJson(const TimeSummary& times)
{
    return {{"first", times.m_first}, {"median", times.m_median}, {"p95", times.m_p95}, {"max", times.m_max}};
}

Json asJson(const WholeStepParts& parts)
{
    Json json;
    for (const NamedPart& part : stepParts())
        json[part.m_name] = parts.*part.m_ms;
    return json;
}

// Returns a statistic of the steps in contact, or null when the run had none.
Json ifInContact(const RunSummary& summary, const Json& value)
{
    return summary.m_stepsInContact > 0 ? value : Json();
}

// Returns sums over the run. Counts the candidates of the broad phase, the continuous tests, and the contacts. Also
// counts skipped cloths, obstacles reused without change, idle steps, and steps that the host back end ran.
Json workJson(const RunRecord& record)
{
    std::uint64_t candidates = 0, swept = 0, contacts = 0;
    std::size_t cloths = 0, kept = 0, skipped = 0, onHost = 0;
    for (const StepRecord& step : record.m_steps)
    {
        candidates += step.m_times.m_candidates;
        swept += step.m_times.m_sweptTests;
        contacts += step.m_times.m_contacts;
        cloths += step.m_times.m_clothsSkipped;
        kept += step.m_times.m_obstaclesKept;
        skipped += step.m_times.m_skipped;
        onHost += step.m_times.m_onHost;
    }
    Json json;
    json["candidates"] = candidates;
    json["continuous_tests"] = swept;
    json["contacts"] = contacts;
    json["cloths_skipped"] = cloths;
    json["obstacles_kept"] = kept;
    json["steps_skipped"] = skipped;
    json["steps_on_host"] = onHost;
    return json;
}

// Returns whether Drape ran the steps.
bool hasParts(const RunRecord& record)
{
    return !record.m_backend.empty() && record.m_backend.rfind("bullet", 0) != 0;
}

Json asJson(const RunRecord& record)
{
    const RunSummary summary = summarise(record);
    Json json;
    json["backend"] = record.m_backend;
    json["device"] = record.m_device;
    json["device_reason"] = record.m_deviceReason;
    json["solver"] = record.m_solver;
    json["prepare_ms"] = record.m_prepareMs;
    json["steps"] = record.m_steps.size();
    json["steps_in_contact"] = summary.m_stepsInContact;
    json["cloth_triangles"] = record.m_clothTriangles;
    json["obstacle_triangles"] = record.m_obstacleTriangles;
    json["thickness_m"] = record.m_thickness;
    json["step_ms"] = ifInContact(summary, asJson(summary.m_step));
    json["collision_ms"] = ifInContact(summary, asJson(summary.m_collision));
    json["finding_ms"] = ifInContact(summary, asJson(summary.m_finding));
    if (hasParts(record))
    {
        json["step_parts_ms"] = ifInContact(summary, asJson(summary.m_parts));
        json["work"] = workJson(record);
    }
    json["contacts_max"] = summary.m_contactsMax;
    json["penetration_max_m"] = summary.m_penetrationMax;
    json["penetration_p99_m"] = ifInContact(summary, summary.m_penetrationP99);
    json["gap_min_m"] = summary.m_gapMin;
    json["nodes_below_surface"] = summary.m_nodesBelow;
    json["nodes_through"] = summary.m_nodesThrough;
    json["intersecting_pairs_end"] = summary.m_intersectingPairsEnd;
    json["intersecting_pairs_max"] = summary.m_intersectingPairsMax;
    json["intersecting_pairs_max_step"] = summary.m_intersectingPairsMaxStep;
    json["self_intersecting_pairs_end"] = record.m_countsClothPairs ? Json(summary.m_selfPairsEnd) : Json();
    json["self_intersecting_pairs_max"] = record.m_countsClothPairs ? Json(summary.m_selfPairsMax) : Json();
    json["stretch_mean"] = summary.m_stretch.m_mean;
    json["stretch_max"] = summary.m_stretch.m_max;
    json["rest_speed_mm_s"] = 1000 * summary.m_restSpeed;
    json["nan_nodes"] = summary.m_invalidNodes;
    json["hash"] = hashText(summary.m_hash);
    if (record.m_capped) json["capped_at_step"] = record.m_steps.size();
    if (!record.m_trouble.empty()) json["trouble"] = record.m_trouble;
    return json;
}

// Returns the ratio of the medians, or nothing when one of the runs was never in contact or took no measurable time.
std::optional<double> ratio(const RunSummary& other, const RunSummary& own, const TimeSummary RunSummary::*times)
{
    const bool bothInContact = other.m_stepsInContact > 0 && own.m_stepsInContact > 0;
    if (!bothInContact || !((own.*times).m_median > 0)) return {};
    return (other.*times).m_median / (own.*times).m_median;
}

Json asJson(const std::optional<double>& value)
{
    return value ? Json(*value) : Json();
}

std::string text(const char* format, double value)
{
    char buffer[64];
    std::snprintf(buffer, sizeof buffer, format, value);
    return buffer;
}

std::string count(std::size_t value)
{
    return std::to_string(value);
}

std::string row(const std::string& label, const std::vector<std::string>& cells)
{
    const auto pad = [](const std::string& cell, std::size_t width)
    { return cell.size() < width ? std::string(width - cell.size(), ' ') : std::string(); };
    std::string line = label + pad(label, 34);
    for (const std::string& cell : cells)
        line += "  " + pad(cell, 14) + cell;
    return line + "\n";
}

constexpr const char* kNone = "-";  // stands in the table for a missing value

// Returns a statistic of the steps in contact as text.
std::string textOfContacts(const RunSummary& summary, double value)
{
    return summary.m_stepsInContact > 0 ? text("%.3f", value) : kNone;
}

void addTimes(std::string& table, const std::string& label, const std::vector<RunSummary>& summaries,
              const TimeSummary RunSummary::*times)
{
    const std::pair<const char*, double TimeSummary::*> parts[4] = {{"first", &TimeSummary::m_first},
                                                                    {"median", &TimeSummary::m_median},
                                                                    {"p95", &TimeSummary::m_p95},
                                                                    {"max", &TimeSummary::m_max}};
    for (const auto& part : parts)
    {
        std::vector<std::string> cells;
        for (const RunSummary& summary : summaries)
            cells.push_back(textOfContacts(summary, summary.*times.*part.second));
        table += row(label + ", " + part.first, cells);
    }
}

// Adds the times of the whole step and the medians of its parts.
void addStepTimes(std::string& table, const std::vector<NamedRun>& runs, const std::vector<RunSummary>& summaries)
{
    addTimes(table, "step, ms", summaries, &RunSummary::m_step);
    for (const NamedPart& part : stepParts())
    {
        std::vector<std::string> cells;
        for (std::size_t i = 0; i < runs.size(); ++i)
            cells.push_back(hasParts(runs[i].m_record) ? textOfContacts(summaries[i], summaries[i].m_parts.*part.m_ms)
                                                       : kNone);
        table += row(std::string("part: ") + part.m_name + ", ms, median", cells);
    }
}

bool anyContact(const std::vector<RunSummary>& summaries)
{
    return std::any_of(summaries.begin(), summaries.end(),
                       [](const RunSummary& summary) { return summary.m_stepsInContact > 0; });
}

// Adds what was measured on the cloth.
void addMeasures(std::string& table, const std::vector<RunSummary>& summaries)
{
    const auto add = [&](const char* label, const std::function<std::string(const RunSummary&)>& cell)
    {
        std::vector<std::string> cells;
        for (const RunSummary& summary : summaries)
            cells.push_back(cell(summary));
        table += row(label, cells);
    };
    using Run = const RunSummary&;
    add("contacts, maximum", [](Run run) { return count(run.m_contactsMax); });
    add("penetration, maximum, mm", [](Run run) { return text("%.3f", 1000 * run.m_penetrationMax); });
    if (anyContact(summaries))
        add("penetration, p99, mm", [](Run run) { return textOfContacts(run, 1000 * run.m_penetrationP99); });
    add("gap, minimum, mm", [](Run run) { return text("%.3f", 1000 * run.m_gapMin); });
    add("nodes below surface, end", [](Run run) { return count(run.m_nodesBelow); });
    add("nodes that went through", [](Run run) { return count(run.m_nodesThrough); });
    add("intersecting pairs, end", [](Run run) { return count(run.m_intersectingPairsEnd); });
    add("intersecting pairs, maximum (step)",
        [](Run run)
        {
            return count(run.m_intersectingPairsMax) +
                   (run.m_intersectingPairsMax > 0 ? " (" + count(run.m_intersectingPairsMaxStep) + ")" : "");
        });
    add("stretch, mean, end, %", [](Run run) { return text("%.2f", 100 * run.m_stretch.m_mean); });
    add("stretch, maximum, end, %", [](Run run) { return text("%.2f", 100 * run.m_stretch.m_max); });
    add("cloth pairs intersecting, end (maximum)",
        [](Run run) {
            return run.m_countsClothPairs ? count(run.m_selfPairsEnd) + " (" + count(run.m_selfPairsMax) + ")" : kNone;
        });
    add("NaN nodes", [](Run run) { return count(run.m_invalidNodes); });
    add("hash", [](Run run) { return hashText(run.m_hash); });
}

std::string heading(const std::vector<NamedRun>& runs)
{
    const RunRecord& first = runs.front().m_record;
    std::string head = "cloth " + count(first.m_clothTriangles) + " triangles on obstacle of " +
                       count(first.m_obstacleTriangles) + ", thickness " + text("%g", 1000 * first.m_thickness) +
                       " mm\n";
    for (const NamedRun& run : runs)
    {
        const RunRecord& record = run.m_record;
        head += run.m_name + ": " + record.m_backend + " on " + record.m_device + " (" + record.m_deviceReason + ")";
        if (record.m_prepareMs > 0) head += ", prepared in " + text("%.0f", record.m_prepareMs) + " ms";
        if (record.m_capped) head += "; ended after step " + count(record.m_steps.size());
        if (!record.m_trouble.empty()) head += "; " + record.m_trouble;
        head += "\n";
    }
    return head;
}
}  // namespace

Json asJson(const std::vector<NamedRun>& runs, bool byName)
{
    if (!byName) return asJson(runs.front().m_record);
    Json json;
    const RunSummary first = summarise(runs.front().m_record);
    for (const NamedRun& run : runs)
        json[run.m_name] = asJson(run.m_record);
    for (std::size_t i = 1; i < runs.size(); ++i)
    {
        const std::string name = runs[i].m_name.substr(runs[i].m_name.find('_') + 1);
        const RunSummary other = summarise(runs[i].m_record);
        json["ratio_" + name] = asJson(ratio(other, first, &RunSummary::m_collision));
        json["ratio_" + name + "_finding"] = asJson(ratio(other, first, &RunSummary::m_finding));
    }
    return json;
}

std::string asCsv(const RunRecord& record, double dt)
{
    std::string csv =
        "step,time_s,step_ms,collision_ms,contacts,penetration_max_m,gap_min_m,nodes_below_surface,"
        "intersecting_pairs,nan_nodes,speed_rms_m_s,nodes_through,self_intersecting_pairs";
    for (const NamedPart& part : stepParts())
        csv += std::string(",") + part.m_name + "_ms";
    csv += "\n";
    char line[256];
    for (std::size_t i = 0; i < record.m_steps.size(); ++i)
    {
        const StepRecord& step = record.m_steps[i];
        std::snprintf(line, sizeof line, "%zu,%.9g,%.6f,%.6f,%zu,%.9g,%.9g,%zu,%zu,%zu,%.9g,%zu,", i + 1,
                      static_cast<double>(i + 1) * dt, step.m_times.m_stepMs, step.m_times.m_collisionMs,
                      step.m_times.m_contacts, step.m_measure.m_penetrationMax, step.m_measure.m_gapMin,
                      step.m_measure.nodesBelow(), step.m_measure.m_intersectingPairs, step.m_measure.m_invalidNodes,
                      step.m_speed, step.m_nodesThrough);
        csv += line + (record.m_countsClothPairs ? count(step.m_selfPairs) : std::string());
        for (const NamedPart& part : stepParts())
            csv += "," + (hasParts(record) ? text("%.6f", step.m_times.m_parts.*part.m_ms) : std::string());
        csv += "\n";
    }
    return csv;
}

std::string asTable(const std::vector<NamedRun>& runs)
{
    std::vector<RunSummary> summaries;
    std::vector<std::string> names;
    for (const NamedRun& run : runs)
    {
        summaries.push_back(summarise(run.m_record));
        names.push_back(run.m_name);
    }
    std::string table = heading(runs) + row("", names);
    const auto add = [&](const std::string& label, const std::function<std::string(std::size_t)>& cell)
    {
        std::vector<std::string> cells;
        for (std::size_t i = 0; i < runs.size(); ++i)
            cells.push_back(cell(i));
        table += row(label, cells);
    };
    add("steps (in contact)", [&](std::size_t i)
        { return count(runs[i].m_record.m_steps.size()) + " (" + count(summaries[i].m_stepsInContact) + ")"; });
    if (anyContact(summaries))
    {
        addStepTimes(table, runs, summaries);
        addTimes(table, "collision, ms", summaries, &RunSummary::m_collision);
        add("finding contacts, ms, median",
            [&](std::size_t i) { return textOfContacts(summaries[i], summaries[i].m_finding.m_median); });
    }
    addMeasures(table, summaries);
    if (runs.size() == 1) return table;
    const auto addRatio = [&](const char* label, const TimeSummary RunSummary::*times)
    {
        add(label,
            [&, times](std::size_t i)
            {
                const std::optional<double> value = ratio(summaries[i], summaries[0], times);
                return value ? text("%.1f", *value) : kNone;
            });
    };
    addRatio("collision median, ratio", &RunSummary::m_collision);
    addRatio("finding median, ratio", &RunSummary::m_finding);
    return table;
}
}  // namespace drape
