#include "benchmarks/error_vs_time/detector_part.h"

#include <cstdlib>
#include <iostream>
#include <map>

#include "benchmarks/error_vs_time/detector_rows.h"
#include "benchmarks/error_vs_time/distance_rows.h"
#include "benchmarks/error_vs_time/motion_sets.h"
#include "benchmarks/error_vs_time/triangle_sets.h"
#include "benchmarks/support/result_hash.h"
#include "benchmarks/support/samples.h"
#include <drape/queries.h>
#include "scenes/query_records.h"

namespace drape::bench
{
namespace
{
constexpr std::size_t kQueries = 20000, kQuickQueries = 400;

struct Sets
{
    std::vector<MotionSet> m_motions;
    std::vector<TriangleSet> m_triangles;
};

// Adds the published queries with exact answers if their folder is named. Returns false if it is named and they cannot
// be read.
bool addPublished(const ErrorOptions& options, Sets& sets, std::string& error)
{
    const char* variable = std::getenv("DRAPE_TRUTH_DIR");
    const std::string folder = !options.m_truth.empty() ? options.m_truth : variable ? variable : "";
    if (folder.empty())
    {
        std::cerr << kProgram << ": the published queries are left out: --truth names their folder" << std::endl;
        return true;
    }
    MotionRecords motions;
    TriangleRecords triangles;
    if (!readRecords(folder + "/ccd_queries.bin", motions, error) ||
        !readRecords(folder + "/triangle_pairs.bin", triangles, error))
        return false;
    sets.m_motions.push_back({"published motions", motions.m_queries, motions.m_truth, {}});
    sets.m_triangles.push_back({"published triangles", triangles.m_queries, triangles.m_truth});
    return true;
}

struct MotionVariant
{
    Variant m_variant;
    CcdSettings m_settings;
};

// Lists variants around the defaults: the accuracy of the distance and of the time.
std::vector<MotionVariant> motionVariants()
{
    std::vector<MotionVariant> variants = {{{"defaults", 0, ""}, defaultCcdSettings()}};
    for (const float tolerance : {1e-7f, 1e-5f, 1e-4f, 1e-3f, 1e-2f})
    {
        variants.push_back({{"tolerance", tolerance, ""}, defaultCcdSettings()});
        variants.back().m_settings.m_tolerance = tolerance;
    }
    for (const float tolerance : {1e-6f, 1e-3f, 1e-2f, 1e-1f, 1.0f})
    {
        variants.push_back({{"time tolerance", tolerance, ""}, defaultCcdSettings()});
        variants.back().m_settings.m_timeTolerance = tolerance;
    }
    return variants;
}

const std::pair<TriangleTest, const char*> kTriangleTests[] = {{TriangleTest::Certified, "certified"},
                                                               {TriangleTest::Exact, "exact"}};

// Holds one back end's answers. The host goes first: a device must have its hashes.
class Asker
{
public:
    Asker(Queries& queries, std::map<std::string, std::string>& hostHashes, Table& table)
        : m_queries(queries), m_hostHashes(hostHashes), m_table(table)
    {
    }

    bool ask(const MotionSet& set, const MotionVariant& variant)
    {
        Row row = detectorRow(set.m_name, method(), variant.m_variant);
        std::vector<CcdResult> results(set.m_queries.size());
        const auto answer = [&]
        { return m_queries.motions(set.m_queries.data(), results.size(), variant.m_settings, results.data()); };
        if (!timeQueries(row, results.size(), answer)) return failed();
        std::vector<bool> hits;
        std::vector<double> early;
        std::size_t late = 0;
        for (std::size_t i = 0; i < results.size(); ++i)
        {
            hits.push_back(results[i].m_hit != 0);
            if (set.m_times.empty() || !set.m_truth[i] || !hits.back()) continue;
            const double error = set.m_times[i] - double(results[i].m_time);
            early.push_back(std::abs(error));
            late += error < -1e-9;  // the accuracy of the true times
        }
        fillAnswers(row, set.m_truth, hits);
        fillErrors(row, "time_error", early);
        if (!early.empty()) row["late_times"] = late;
        finish(row, hashOf(results));
        return true;
    }

    bool ask(const TriangleSet& set, TriangleTest test, const char* name)
    {
        Row row = detectorRow(set.m_name, method(), {"test", 0, name});
        std::vector<std::uint32_t> results(set.m_queries.size());
        const auto answer = [&]
        { return m_queries.triangles(set.m_queries.data(), results.size(), test, results.data()); };
        if (!timeQueries(row, results.size(), answer)) return failed();
        fillAnswers(row, set.m_truth, std::vector<bool>(results.begin(), results.end()));
        finish(row, hashOf(results));
        return true;
    }

private:
    std::string method() const { return m_queries.deviceReport().m_onHost ? "drape_host" : "drape"; }

    bool failed() const { return fail(kProgram, kExitFailed, m_queries.error().text()) == kExitGood; }

    void finish(Row& row, std::uint64_t hash)
    {
        row["device"] = m_queries.deviceReport().m_device.m_name;
        row["hash"] = hashText(hash);
        row[kMustMatch] = "same";
        const std::string name =
            row.value("scene", "") + "/" + row.value("knob", "") + "/" + row["value"].dump() + row.value("setting", "");
        if (m_queries.deviceReport().m_onHost) m_hostHashes[name] = hashText(hash);
        judgeRow(row, m_hostHashes[name]);
        m_table.add(row);
    }

    Queries& m_queries;
    std::map<std::string, std::string>& m_hostHashes;
    Table& m_table;
};

bool askAll(Queries& queries, const Sets& sets, std::map<std::string, std::string>& hostHashes, Table& table)
{
    Asker asker(queries, hostHashes, table);
    bool good = true;
    for (const MotionSet& set : sets.m_motions)
    {
        for (const MotionVariant& variant : motionVariants())
            good = good && asker.ask(set, variant);
    }
    for (const TriangleSet& set : sets.m_triangles)
    {
        for (const auto& [test, name] : kTriangleTests)
            good = good && asker.ask(set, test, name);
    }
    return good;
}
}  // namespace

bool measureDetector(const ErrorOptions& options, Table& table)
{
    const std::size_t count = options.m_quick ? kQuickQueries : kQueries;
    Sets sets;
    std::string text;
    bool good = options.m_quick || addPublished(options, sets, text);
    if (!good) fail(kProgram, kExitFailed, text);
    for (MotionSet& set : makeMotionSets(count))
        sets.m_motions.push_back(std::move(set));
    for (TriangleSet& set : makeTriangleSets(count))
        sets.m_triangles.push_back(std::move(set));

    std::map<std::string, std::string> hostHashes;
    Settings settings = options.settings();
    std::vector<Settings> backends = {Settings()};
    backends[0].m_backend = Backend::Host;
    if (hasDevice(options)) backends.push_back(settings);
    for (const Settings& backend : backends)
    {
        Error error;
        const std::unique_ptr<Queries> queries = Queries::create(backend, error);
        if (!queries)
            good = fail(kProgram, kExitFailed, error.text()) == kExitGood;
        else
            good = askAll(*queries, sets, hostHashes, table) && good;
    }
    addDistanceRows(count, table);
    return good;
}
}  // namespace drape::bench
