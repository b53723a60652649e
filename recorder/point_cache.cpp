#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "recorder/check_recording.h"
#include "recorder/little_endian.h"
#include "scenes/atomic_file.h"

namespace drape
{
namespace
{
std::string nameOf(std::size_t number, const RecordedBody& body)
{
    char digits[24];
    std::snprintf(digits, sizeof digits, "%03zu_", number);
    std::string name = digits;
    for (const char c : body.m_name)
        name += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' ? c : '_';
    return name;
}

// Writes the vertices of a frame, x y z each, to `out`.
void placed(const RecordedBody& body, std::size_t frame, std::vector<float>& out)
{
    const float* now = &body.m_frames[frame * body.frameSize()];
    if (!body.m_rigid) return out.assign(now, now + body.frameSize());
    out.clear();
    const float *turn = now + 3, w = now[6];
    for (std::size_t i = 0; i < body.m_vertices.size(); i += 3)
    {
        const float* v = &body.m_vertices[i];
        // v + 2 q × (q × v + w v)
        const float t[3] = {turn[1] * v[2] - turn[2] * v[1] + w * v[0], turn[2] * v[0] - turn[0] * v[2] + w * v[1],
                            turn[0] * v[1] - turn[1] * v[0] + w * v[2]};
        out.push_back(now[0] + v[0] + 2 * (turn[1] * t[2] - turn[2] * t[1]));
        out.push_back(now[1] + v[1] + 2 * (turn[2] * t[0] - turn[0] * t[2]));
        out.push_back(now[2] + v[2] + 2 * (turn[0] * t[1] - turn[1] * t[0]));
    }
}

std::string asObj(const RecordedBody& body, const std::vector<float>& positions)
{
    std::string text = "# metres\n";
    char line[96];
    for (std::size_t i = 0; i < positions.size(); i += 3)
    {
        // Nine digits give every float back exactly.
        std::snprintf(line, sizeof line, "v %.9g %.9g %.9g\n", double(positions[i]), double(positions[i + 1]),
                      double(positions[i + 2]));
        text += line;
    }
    const auto elements = [&](const char* kind, const std::vector<std::int32_t>& indices, std::size_t group)
    {
        for (std::size_t i = 0; i < indices.size(); ++i)
            text +=
                (i % group == 0 ? kind : " ") + std::to_string(indices[i] + 1) + (i % group + 1 == group ? "\n" : "");
    };
    elements("f ", body.m_triangles, 3);
    elements("l ", body.m_lines, 2);
    return text;
}

bool moves(const RecordedBody& body)
{
    const std::size_t size = body.frameSize();
    for (std::size_t i = size; i < body.m_frames.size(); ++i)
        if (body.m_frames[i] != body.m_frames[i - size]) return true;
    return false;
}

// Calls `write` with each coordinate of each frame.
template <typename Write>
void forEachCoordinate(const RecordedBody& body, const Write& write)
{
    std::vector<float> positions;
    for (std::size_t frame = 0; frame < body.frameCount(); ++frame)
    {
        placed(body, frame, positions);
        for (const float value : positions)
            write(value);
    }
}

// PC2: twelve letters, version, points, first frame, frames a sample, samples; then the points of each sample.
std::string asPc2(const RecordedBody& body)
{
    std::string bytes("POINTCACHE2\0", 12);
    appendLittle(bytes, std::int32_t{1});
    appendLittle(bytes, static_cast<std::int32_t>(body.vertexCount()));
    appendLittle(bytes, static_cast<float>(body.m_first));
    appendLittle(bytes, 1.0f);
    appendLittle(bytes, static_cast<std::int32_t>(body.frameCount()));
    forEachCoordinate(body, [&](float value) { appendLittle(bytes, value); });
    return bytes;
}

// MDD, the highest bytes first: frames, points, the times of the frames in seconds; then the points of each frame.
std::string asMdd(const RecordedBody& body, double frameTime)
{
    std::string bytes;
    const auto append = [&](auto value)
    {
        appendLittle(bytes, value);
        std::reverse(bytes.end() - sizeof value, bytes.end());
    };
    append(static_cast<std::int32_t>(body.frameCount()));
    append(static_cast<std::int32_t>(body.vertexCount()));
    for (std::size_t frame = 0; frame < body.frameCount(); ++frame)
        append(static_cast<float>(frameTime * static_cast<double>(body.m_first + frame)));
    forEachCoordinate(body, append);
    return bytes;
}
}  // namespace

bool writePointCaches(const std::string& folder, const Recording& run, std::string& error)
{
    error.clear();
    if (!checkRecording(run, error)) return false;
    std::error_code code;
    std::filesystem::create_directories(folder, code);
    if (code) error = folder + ": cannot write: " + code.message();
    std::vector<float> positions;
    for (std::size_t i = 0; i < run.m_bodies.size() && error.empty(); ++i)
    {
        const RecordedBody& body = run.m_bodies[i];
        if (body.frameCount() == 0) continue;
        const std::string path = folder + "/" + nameOf(i, body);
        placed(body, 0, positions);
        if (writeFileAtomically(path + ".obj", asObj(body, positions), error) && moves(body))
            static_cast<void>(writeFileAtomically(path + ".pc2", asPc2(body), error) &&
                              writeFileAtomically(path + ".mdd", asMdd(body, run.m_frameTime), error));
    }
    return error.empty();
}
}  // namespace drape
