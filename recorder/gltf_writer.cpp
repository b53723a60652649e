#include <algorithm>
#include <cmath>
#include <type_traits>

#include <nlohmann/json.hpp>

#include "recorder/check_recording.h"
#include "recorder/little_endian.h"
#include "scenes/atomic_file.h"

namespace drape
{
namespace
{
using Json = nlohmann::ordered_json;

constexpr int kFloat = 5126, kUnsigned = 5125;                      // componentType
constexpr int kVertices = 34962, kIndices = 34963, kAnimation = 0;  // target of a buffer view; 0: none
constexpr int kLineMode = 1, kTriangleMode = 4;

class GltfBuilder
{
public:
    GltfBuilder(const Recording& run, std::size_t mostTargets) : m_run(run), m_mostTargets(mostTargets)
    {
        m_json["asset"] = {{"version", "2.0"}, {"generator", "Drape"}};
        m_json["scene"] = 0;
        m_json["materials"] = {material("cloth", {0.68, 0.16, 0.2, 1.0}), material("obstacle", {0.7, 0.7, 0.69, 1.0})};
        // glTF has +y up: turn what has another direction up.
        m_json["scenes"] = {{{"nodes", {0}}}};
        m_json["nodes"] = {{{"name", run.m_title}, {"rotation", turnUp()}, {"children", Json::array()}}};
    }

    std::string build()
    {
        for (const RecordedBody& body : m_run.m_bodies)
            if (body.frameCount() > 0 && body.vertexCount() > 0 && body.m_triangles.size() + body.m_lines.size() > 0)
                add(body);
        if (!m_channels.empty()) m_json["animations"] = {{{"samplers", m_samplers}, {"channels", m_channels}}};
        m_json["buffers"] = {{{"byteLength", m_bytes.size()}}};
        std::string text = m_json.dump(-1, ' ', false, Json::error_handler_t::replace);
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::string file("glTF");
        appendLittle(file, std::uint32_t{2});
        appendLittle(file, static_cast<std::uint32_t>(28 + text.size() + m_bytes.size()));
        appendLittle(file, static_cast<std::uint32_t>(text.size()));
        file += "JSON" + text;
        appendLittle(file, static_cast<std::uint32_t>(m_bytes.size()));
        return file + std::string("BIN\0", 4) + m_bytes;
    }

private:
    static Json material(const char* name, const std::vector<double>& colour)
    {
        return {
            {"name", name},
            {"doubleSided", true},
            {"pbrMetallicRoughness", {{"baseColorFactor", colour}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.8}}}};
    }

    // Returns the quaternion that turns the run's upward direction to +y.
    Json turnUp() const
    {
        const double x = m_run.m_up[0], y = m_run.m_up[1], z = m_run.m_up[2];
        if (y < -0.999999) return {1.0, 0.0, 0.0, 0.0};
        const double length = std::sqrt(x * x + z * z + (1 + y) * (1 + y));  // (up × y, 1 + up · y)
        return {-z / length, 0.0, x / length, (1 + y) / length};
    }

    template <typename Number>
    std::size_t accessor(const std::vector<Number>& values, std::size_t group, int target, bool bounds = false)
    {
        Json view = {{"buffer", 0}, {"byteOffset", m_bytes.size()}, {"byteLength", 4 * values.size()}};
        if (target != kAnimation) view["target"] = target;
        for (const Number value : values)
            appendLittle(m_bytes, value);
        Json json = {{"bufferView", m_json["bufferViews"].size()},
                     {"componentType", std::is_same<Number, float>::value ? kFloat : kUnsigned},
                     {"count", values.size() / group},
                     {"type", group == 1   ? "SCALAR"
                              : group == 3 ? "VEC3"
                                           : "VEC4"}};
        for (std::size_t i = 0; bounds && i < values.size(); ++i)
        {
            Json &low = json["min"][i % group], &high = json["max"][i % group];
            low = i < group ? values[i] : std::min(low.get<Number>(), values[i]);
            high = i < group ? values[i] : std::max(high.get<Number>(), values[i]);
        }
        m_json["bufferViews"].push_back(std::move(view));
        m_json["accessors"].push_back(std::move(json));
        return m_json["accessors"].size() - 1;
    }

    // Returns the frames that are written: all, or evenly spaced ones with the first and the last.
    std::vector<std::size_t> framesOf(const RecordedBody& body) const
    {
        const std::size_t count = body.frameCount(),
                          kept = std::min(count, std::max<std::size_t>(m_mostTargets, 1) + 1);
        std::vector<std::size_t> frames;
        for (std::size_t i = 0; i < kept; ++i)
            frames.push_back(kept > 1 ? i * (count - 1) / (kept - 1) : 0);
        return frames;
    }

    void animate(std::size_t node, const char* path, const std::vector<float>& times, const std::vector<float>& values,
                 std::size_t group)
    {
        m_samplers.push_back({{"input", accessor(times, 1, kAnimation, true)},
                              {"output", accessor(values, group, kAnimation)},
                              {"interpolation", "LINEAR"}});
        m_channels.push_back({{"sampler", m_samplers.size() - 1}, {"target", {{"node", node}, {"path", path}}}});
    }

    void add(const RecordedBody& body)
    {
        const std::size_t node = m_json["nodes"].size();
        m_json["nodes"][0]["children"].push_back(node);
        m_json["nodes"].push_back({{"name", body.m_name}, {"mesh", m_json["meshes"].size()}});
        const std::vector<float> frames = finiteFrames(body);
        const std::vector<std::size_t> kept = framesOf(body);
        std::vector<float> times;
        for (const std::size_t frame : kept)
            times.push_back(static_cast<float>(m_run.m_frameTime * static_cast<double>(body.m_first + frame)));
        const std::vector<float> start(frames.begin(), frames.begin() + static_cast<std::ptrdiff_t>(body.frameSize()));
        Json targets = Json::array();
        if (body.m_rigid)
            addPoses(body, frames, kept, times, node);
        else
            targets = addTargets(body, frames, kept, times, node);
        Json mesh = {{"primitives", Json::array()}};
        const std::size_t vertices = accessor(body.m_rigid ? body.m_vertices : start, 3, kVertices, true);
        const auto primitive = [&](const std::vector<std::int32_t>& indices, int mode)
        {
            if (indices.empty()) return;
            Json json = {{"attributes", {{"POSITION", vertices}}},
                         {"indices", accessor(std::vector<std::uint32_t>(indices.begin(), indices.end()), 1, kIndices)},
                         {"mode", mode},
                         {"material", body.m_rigid ? 1 : 0}};
            if (!targets.empty()) json["targets"] = targets;
            mesh["primitives"].push_back(std::move(json));
        };
        primitive(body.m_triangles, kTriangleMode);
        primitive(body.m_lines, kLineMode);
        if (!targets.empty()) mesh["weights"] = std::vector<float>(targets.size());
        m_json["meshes"].push_back(std::move(mesh));
    }

    // Adds a target for each kept frame but the first, and their weights: at its time each is 1 and the others are 0.
    Json addTargets(const RecordedBody& body, const std::vector<float>& frames, const std::vector<std::size_t>& kept,
                    const std::vector<float>& times, std::size_t node)
    {
        Json targets = Json::array();
        std::vector<float> moved(body.frameSize());
        for (std::size_t i = 1; i < kept.size(); ++i)
        {
            for (std::size_t k = 0; k < moved.size(); ++k)
                moved[k] = frames[kept[i] * moved.size() + k] - frames[k];
            targets.push_back({{"POSITION", accessor(moved, 3, kVertices, true)}});
        }
        if (targets.empty()) return targets;
        std::vector<float> weights(kept.size() * targets.size());
        for (std::size_t i = 1; i < kept.size(); ++i)
            weights[i * targets.size() + i - 1] = 1;
        animate(node, "weights", times, weights, 1);
        return targets;
    }

    void addPoses(const RecordedBody& body, const std::vector<float>& frames, const std::vector<std::size_t>& kept,
                  const std::vector<float>& times, std::size_t node)
    {
        std::vector<float> origins, turns;
        for (const std::size_t frame : kept)
        {
            const float* pose = &frames[frame * body.frameSize()];
            origins.insert(origins.end(), pose, pose + 3);
            turns.insert(turns.end(), pose + 3, pose + 7);
        }
        m_json["nodes"][node]["translation"] = {origins[0], origins[1], origins[2]};
        m_json["nodes"][node]["rotation"] = {turns[0], turns[1], turns[2], turns[3]};
        const auto rests = [](const std::vector<float>& values, std::size_t group)
        { return std::equal(values.begin() + static_cast<std::ptrdiff_t>(group), values.end(), values.begin()); };
        if (!rests(origins, 3)) animate(node, "translation", times, origins, 3);
        if (!rests(turns, 4)) animate(node, "rotation", times, turns, 4);
    }

    const Recording& m_run;
    std::size_t m_mostTargets;
    Json m_json, m_samplers = Json::array(), m_channels = Json::array();
    std::string m_bytes;
};
}  // namespace

bool writeGltf(const std::string& path, const Recording& run, std::size_t mostTargets, std::string& error)
{
    error.clear();
    return checkRecording(run, error) && writeFileAtomically(path, GltfBuilder(run, mostTargets).build(), error);
}
}  // namespace drape
