#include "scenes/query_records.h"

#include <cmath>
#include <cstring>

#include "mesh_io/read_file.h"

namespace drape
{
namespace
{
// A record in the byte layout of the file.
struct MotionRecord
{
    float m_points[24];
    std::int32_t m_kind;
    std::int32_t m_truth;
};
static_assert(sizeof(MotionRecord) == 104, "as in the file");

struct TriangleRecord
{
    float m_corners[18];
    std::int32_t m_truth;
};
static_assert(sizeof(TriangleRecord) == 76, "as in the file");

std::string problemOf(const float* values, int count, std::int32_t truth)
{
    for (int i = 0; i < count; ++i)
        if (!std::isfinite(values[i])) return "coordinate " + std::to_string(i + 1) + " is not finite";
    return truth == 0 || truth == 1 ? "" : "the answer " + std::to_string(truth) + " is neither 0 nor 1";
}

// Takes the file's records one by one; take returns what is wrong with one.
template <typename Record, typename Take>
bool readEach(const std::string& path, std::string& error, Take take)
{
    std::string bytes;
    std::string problem = readWholeFile(path, "file of records", bytes);
    if (problem.empty() && bytes.size() % sizeof(Record) != 0)
        problem = std::to_string(bytes.size()) + " bytes are not whole records of " + std::to_string(sizeof(Record));
    for (std::size_t i = 0; problem.empty() && i < bytes.size() / sizeof(Record); ++i)
    {
        Record record;
        std::memcpy(&record, bytes.data() + i * sizeof(Record), sizeof(Record));
        problem = take(record);
        if (!problem.empty()) problem = "record " + std::to_string(i + 1) + ": " + problem;
    }
    if (!problem.empty()) error = path + ": " + problem;
    return problem.empty();
}
}  // namespace

bool readRecords(const std::string& path, MotionRecords& records, std::string& error)
{
    const auto take = [&records](const MotionRecord& record) -> std::string
    {
        if (record.m_kind != 0 && record.m_kind != 1)
            return "the kind " + std::to_string(record.m_kind) + " is neither 0 nor 1";
        CcdQuery query;
        std::memcpy(query.m_start, record.m_points, sizeof query.m_start);
        std::memcpy(query.m_end, record.m_points + 12, sizeof query.m_end);
        query.m_kind = std::uint32_t(record.m_kind);
        records.m_queries.push_back(query);
        records.m_truth.push_back(record.m_truth != 0);
        return problemOf(record.m_points, 24, record.m_truth);
    };
    return readEach<MotionRecord>(path, error, take);
}

bool readRecords(const std::string& path, TriangleRecords& records, std::string& error)
{
    const auto take = [&records](const TriangleRecord& record) -> std::string
    {
        TriangleQuery query;
        std::memcpy(query.m_a, record.m_corners, sizeof query.m_a);
        std::memcpy(query.m_b, record.m_corners + 9, sizeof query.m_b);
        records.m_queries.push_back(query);
        records.m_truth.push_back(record.m_truth != 0);
        return problemOf(record.m_corners, 18, record.m_truth);
    };
    return readEach<TriangleRecord>(path, error, take);
}
}  // namespace drape
