// Fuzzes files of queries with their answers. The reader refuses the bytes in one line that names the file, or returns
// every record with finite numbers that equal the file's.
//
// The first byte chooses between motions and pairs of triangles.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>

#include "scenes/query_records.h"
#include "tests/fuzz/bytes.h"
#include "tests/fuzz/input_file.h"

using drape::fuzz::require;

namespace
{
void checkNumbers(const float* values, std::size_t count, const std::uint8_t* file)
{
    for (std::size_t i = 0; i < count; ++i)
        require(std::isfinite(values[i]));
    require(std::memcmp(values, file, count * sizeof(float)) == 0);
}

void check(const drape::CcdQuery& query, const std::uint8_t* file)
{
    checkNumbers(query.m_start, 12, file);
    checkNumbers(query.m_end, 12, file + sizeof query.m_start);
    require(query.m_kind == DRAPE_VERTEX_FACE || query.m_kind == DRAPE_EDGES);
    require(std::memcmp(&query.m_kind, file + sizeof query.m_start + sizeof query.m_end, sizeof query.m_kind) == 0);
}

void check(const drape::TriangleQuery& query, const std::uint8_t* file)
{
    checkNumbers(query.m_a, 9, file);
    checkNumbers(query.m_b, 9, file + sizeof query.m_a);
}

// bytes: of a record in the file; its last four are the answer.
template <typename Records>
void read(const std::uint8_t* data, std::size_t size, std::size_t bytes)
{
    const drape::fuzz::InputFile file(".bin", data, size);
    Records records;
    std::string error;
    const bool good = drape::readRecords(file.path(), records, error);
    require(good == error.empty());
    require(error.find('\n') == std::string::npos);
    require(good || error.compare(0, file.path().size(), file.path()) == 0);
    require(!good || size % bytes == 0);
    if (!good) return;
    require(records.m_queries.size() == size / bytes && records.m_truth.size() == size / bytes);
    for (std::size_t i = 0; i < records.m_queries.size(); ++i)
    {
        check(records.m_queries[i], data + i * bytes);
        std::int32_t answer;
        std::memcpy(&answer, data + (i + 1) * bytes - sizeof answer, sizeof answer);
        require(answer == std::int32_t(records.m_truth[i]));
    }
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    if (size < 1) return 0;
    if (data[0] % 2)
        read<drape::TriangleRecords>(data + 1, size - 1, 76);
    else
        read<drape::MotionRecords>(data + 1, size - 1, 104);
    return 0;
}
