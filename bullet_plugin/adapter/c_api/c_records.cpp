#include "bullet_plugin/adapter/c_api/c_records.h"

#include "bullet_plugin/adapter/c_api/field_count.h"
#include "drape/queries.h"

namespace drape
{
namespace
{
#define DRAPE_ONE(...) +1
constexpr std::size_t kSettings = 0 DRAPE_SETTINGS_FIELDS(DRAPE_ONE);
constexpr std::size_t kDeviceInfo = 0 DRAPE_DEVICE_INFO_FIELDS(DRAPE_ONE);
constexpr std::size_t kDeviceReport = 0 DRAPE_DEVICE_REPORT_FIELDS(DRAPE_ONE);
constexpr std::size_t kStatistics = 0 DRAPE_STATISTICS_FIELDS(DRAPE_ONE);
constexpr std::size_t kSums = 0 DRAPE_STATISTICS_SUMS(DRAPE_ONE);
#undef DRAPE_ONE

// A field that only one side has fails here: add it to the list, to the record of drape/c_api.h, and to the Python
// module's class if it has one.
static_assert(fieldCount<Settings>() == kSettings + 3, "besides the list, it has m_log, m_nameOf and m_parallelFor");
static_assert(fieldCount<DrapeSettings>() == kSettings + 4, "besides the list, two functions with their user pointers");
static_assert(fieldCount<DeviceInfo>() == kDeviceInfo && fieldCount<DrapeDeviceInfo>() == kDeviceInfo, "");
static_assert(fieldCount<DeviceReport>() == kDeviceReport + 1, "besides the list, DeviceReport has m_device");
static_assert(fieldCount<DrapeDeviceReport>() == kDeviceReport + 1, "besides the list, it has m_device");
static_assert(fieldCount<StepCounts>() + fieldCount<StepParts>() + fieldCount<StepStatistics>() == kStatistics + 2,
              "StepStatistics has its two bases and the fields of the list");
static_assert(fieldCount<DrapeStatistics>() == kStatistics + kSums, "");
static_assert(fieldCount<MeshPairs>() == 6 && fieldCount<DrapeMeshPairs>() == 8, "C has the lengths of two lists, too");
static_assert(fieldCount<MeshMotion>() == 7 && fieldCount<DrapeMeshMotion>() == 8, "C has a list's length, too");

// Runs a job for C: a function and its context.
void runJob(size_t index, void* job)
{
    (*static_cast<const std::function<void(std::size_t)>*>(job))(index);
}

// Constants of C and enumerators have the same numbers.
#define DRAPE_COMPARE(field, constant, enumerator, name) \
    static_assert(constant == static_cast<int>(enumerator), #constant);
DRAPE_CHOICES(DRAPE_COMPARE)
#undef DRAPE_COMPARE
#define DRAPE_COMPARE(name, enumerator) static_assert(DRAPE_STEP_##name == static_cast<int>(enumerator), #name);
DRAPE_STATUS_BITS(DRAPE_COMPARE)
#undef DRAPE_COMPARE
static_assert(DRAPE_TEST_CERTIFIED == static_cast<int>(TriangleTest::Certified) &&
                  DRAPE_TEST_EXACT == static_cast<int>(TriangleTest::Exact) &&
                  DRAPE_QUERY_CANDIDATE_LIMIT == static_cast<int>(kQueryCandidateLimit) &&
                  DRAPE_QUERY_ANSWER_LIMIT == static_cast<int>(kQueryAnswerLimit),
              "");
}  // namespace

#define DRAPE_COPY(field) copyField(from.field, to.field);

Settings settingsOf(const DrapeSettings* settings)
{
    Settings to;
    if (!settings) return to;
    const DrapeSettings& from = *settings;
    DRAPE_SETTINGS_FIELDS(DRAPE_COPY)
    to.m_log = nullptr;
    const DrapeLog log = from.m_log;
    void* const user = from.m_logUser;
    if (log) to.m_log = [log, user](const char* line) { log(line, user); };
    const DrapeParallelFor run = from.m_parallelFor;
    void* const system = from.m_parallelForUser;
    if (run)
        to.m_parallelFor = [run, system](std::size_t count, const std::function<void(std::size_t)>& job)
        { run(count, runJob, const_cast<std::function<void(std::size_t)>*>(&job), system); };
    return to;
}

DrapeSettings defaultCSettings()
{
    // Lives as long as the texts that the record points to.
    static const Settings from;
    DrapeSettings to = {};
    DRAPE_SETTINGS_FIELDS(DRAPE_COPY)
    to.m_log = drapeLogToStandardError;
    return to;
}

DrapeDeviceInfo infoOf(const DeviceInfo& from)
{
    DrapeDeviceInfo to = {};
    DRAPE_DEVICE_INFO_FIELDS(DRAPE_COPY)
    return to;
}

DrapeDeviceReport reportOf(const DeviceReport& from)
{
    DrapeDeviceReport to = {};
    DRAPE_DEVICE_REPORT_FIELDS(DRAPE_COPY)
    to.m_device = infoOf(from.m_device);
    return to;
}

DrapeStatistics statisticsOf(const StepStatistics& from)
{
    DrapeStatistics to = {};
    DRAPE_STATISTICS_FIELDS(DRAPE_COPY)
#define DRAPE_SUM(field, function) to.field = from.function();
    DRAPE_STATISTICS_SUMS(DRAPE_SUM)
#undef DRAPE_SUM
    return to;
}

#undef DRAPE_COPY

MeshDescription descriptionOf(const DrapeMesh& mesh)
{
    MeshDescription description;
    description.m_triangles = mesh.m_triangles;
    description.m_triangleCount = mesh.m_triangleCount;
    description.m_positions = mesh.m_positions;
    description.m_vertexCount = mesh.m_vertexCount;
    description.m_edges = mesh.m_edges;
    description.m_edgeCount = mesh.m_edgeCount;
    return description;
}
}  // namespace drape
