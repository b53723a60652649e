#include "recorder/replay_data.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "recorder/coding.h"

namespace drape
{
namespace
{
using Json = nlohmann::ordered_json;

constexpr double kPartsOfSize = 10000;  // fractions of the soft bodies' size: a fifth of a pixel
constexpr double kPartsOfTurn = 32767;  // fractions of 1, for a quaternion's numbers
constexpr double kLevels = 254;         // steps of a channel; level 0 is for nodes without a value

// Returns the resolution for the soft bodies' first frames; for rigid bodies' if there are no others.
double resolutionOf(const std::vector<const Recording*>& runs, bool rigid)
{
    float low[3], high[3];
    std::fill_n(low, 3, std::numeric_limits<float>::infinity());
    std::fill_n(high, 3, -std::numeric_limits<float>::infinity());
    for (const Recording* run : runs)
        for (const RecordedBody& body : run->m_bodies)
            for (std::size_t i = 0; body.m_rigid == rigid && i < body.m_vertices.size(); ++i)
            {
                if (!std::isfinite(body.m_vertices[i])) continue;
                low[i % 3] = std::min(low[i % 3], body.m_vertices[i]);
                high[i % 3] = std::max(high[i % 3], body.m_vertices[i]);
            }
    double size = 0;
    for (int axis = 0; axis < 3; ++axis)
        size = std::max(size, double(high[axis]) - double(low[axis]));
    if (size > 0) return size / kPartsOfSize;
    return rigid ? 1 / kPartsOfSize : resolutionOf(runs, true);
}

class ReplayPacker
{
public:
    explicit ReplayPacker(double step) : m_step(step) {}

    Json run(const Recording& run)
    {
        Json bodies = Json::array();
        for (const RecordedBody& body : run.m_bodies)
            bodies.push_back(packed(body));
        return {{"title", run.m_title},       {"remark", run.m_remark}, {"frameTime", run.m_frameTime},
                {"frames", run.m_frameCount}, {"up", run.m_up},         {"bodies", std::move(bodies)}};
    }

    const Json& meshes() const { return m_json; }
    const std::string& arrays() const { return m_arrays; }

private:
    struct Mesh
    {
        const RecordedBody* m_body;
        std::vector<std::int32_t> m_order;  // old indices of the vertices in the order of the page
    };

    std::size_t add(const std::string& array)
    {
        m_arrays += array;
        return m_arrays.size() - array.size();
    }

    // Returns the values of each item in the mesh's order, one axis after the other, frame after frame.
    static std::vector<float> sorted(const std::vector<float>& values, const std::vector<std::int32_t>& order,
                                     std::size_t axes)
    {
        std::vector<float> result;
        result.reserve(values.size());
        const std::size_t width = order.size() * axes;
        for (std::size_t frame = 0; width > 0 && frame < values.size() / width; ++frame)
            for (std::size_t axis = 0; axis < axes; ++axis)
                for (const std::int32_t item : order)
                    result.push_back(values[frame * width + static_cast<std::size_t>(item) * axes + axis]);
        return result;
    }

    std::size_t addPositions(const std::vector<float>& positions, const std::vector<std::int32_t>& order)
    {
        const std::size_t width = 3 * std::max<std::size_t>(order.size(), 1);
        return add(codeRows(quantise(sorted(positions, order, 3), width, m_step), width));
    }

    static bool same(const RecordedBody& a, const RecordedBody& b)
    {
        return a.m_rigid == b.m_rigid && a.m_triangles == b.m_triangles && a.m_lines == b.m_lines &&
               (a.m_rigid ? a.m_vertices == b.m_vertices : a.m_vertices.size() == b.m_vertices.size());
    }

    std::size_t meshOf(const RecordedBody& body)
    {
        const auto found =
            std::find_if(m_meshes.begin(), m_meshes.end(), [&](const Mesh& mesh) { return same(*mesh.m_body, body); });
        if (found != m_meshes.end()) return static_cast<std::size_t>(found - m_meshes.begin());
        Mesh mesh{&body, {}};
        Json json = {{"vertices", body.vertexCount()}, {"triangles", body.m_triangles.size() / 3}};
        json["walk"] = add(codeTriangles(body.m_triangles, body.vertexCount(), mesh.m_order));
        if (!body.m_lines.empty())
        {
            std::vector<std::int32_t> numbers(mesh.m_order.size()), lines;
            for (std::size_t i = 0; i < mesh.m_order.size(); ++i)
                numbers[static_cast<std::size_t>(mesh.m_order[i])] = static_cast<std::int32_t>(i);
            for (const std::int32_t vertex : body.m_lines)
                lines.push_back(numbers[static_cast<std::size_t>(vertex)]);
            json["lineCount"] = lines.size() / 2;
            json["lines"] = add(codeRows(lines, lines.size()));
        }
        if (body.m_rigid) json["positions"] = addPositions(body.m_vertices, mesh.m_order);
        m_json.push_back(std::move(json));
        m_meshes.push_back(std::move(mesh));
        return m_meshes.size() - 1;
    }

    Json packed(const RecordedBody& body)
    {
        const std::size_t mesh = meshOf(body);
        Json json = {{"name", body.m_name},
                     {"rigid", body.m_rigid},
                     {"mesh", mesh},
                     {"first", body.m_first},
                     {"frames", body.frameCount()}};
        if (body.m_rigid)
        {
            std::vector<float> origins, turns;
            for (std::size_t i = 0; i < body.m_frames.size(); ++i)
                (i % 7 < 3 ? origins : turns).push_back(body.m_frames[i]);
            json["origins"] = add(codeRows(quantise(origins, 3, m_step), 3));
            json["turns"] = add(codeRows(quantise(turns, 4, 1 / kPartsOfTurn), 4));
            return json;
        }
        json["positions"] = addPositions(body.m_frames, m_meshes[mesh].m_order);
        json["channels"] = Json::array();
        for (const RecordedChannel& channel : body.m_channels)
            json["channels"].push_back(packed(channel, m_meshes[mesh].m_order));
        return json;
    }

    Json packed(const RecordedChannel& channel, const std::vector<std::int32_t>& order)
    {
        std::vector<std::int32_t> levels;
        levels.reserve(channel.m_values.size());
        const double scale = kLevels / (double(channel.m_high) - double(channel.m_low));
        for (const float value : sorted(channel.m_values, order, 1))
            levels.push_back(std::isnan(value)
                                 ? 0
                                 : 1 + static_cast<int>(std::lround(
                                           std::clamp((double(value) - double(channel.m_low)) * scale, 0.0, kLevels))));
        return {{"name", channel.m_name},
                {"unit", channel.m_unit},
                {"low", channel.m_low},
                {"high", channel.m_high},
                {"levels", add(codeRows(levels, std::max<std::size_t>(order.size(), 1)))}};
    }

    double m_step;
    Json m_json = Json::array();
    std::vector<Mesh> m_meshes;
    std::string m_arrays;
};
}  // namespace

std::string packReplay(const std::vector<const Recording*>& runs, const ReplaySettings& settings)
{
    const double step = settings.m_resolution > 0 ? settings.m_resolution : resolutionOf(runs, false);
    ReplayPacker packer(step);
    Json json = {{"title", settings.m_title}, {"step", step}, {"turnStep", 1 / kPartsOfTurn}, {"runs", Json::array()}};
    for (const Recording* run : runs)
        json["runs"].push_back(packer.run(*run));
    json["meshes"] = packer.meshes();
    const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    std::string data;
    for (int shift = 0; shift < 32; shift += 8)
        data.push_back(static_cast<char>(text.size() >> shift & 0xffu));
    return data + text + packer.arrays();
}
}  // namespace drape
