#include "recorder/check_recording.h"

#include <algorithm>
#include <cmath>

namespace drape
{
namespace
{
bool indicesFit(const std::vector<std::int32_t>& indices, std::size_t group, std::size_t vertices)
{
    return indices.size() % group == 0 &&
           std::all_of(indices.begin(), indices.end(),
                       [&](std::int32_t index) { return index >= 0 && static_cast<std::size_t>(index) < vertices; });
}

bool channelFits(const RecordedChannel& channel, const RecordedBody& body)
{
    return std::isfinite(channel.m_low) && std::isfinite(channel.m_high) && channel.m_low < channel.m_high &&
           channel.m_values.size() == body.vertexCount() * body.frameCount();
}

const char* problemOf(const RecordedBody& body, const Recording& run)
{
    if (body.m_vertices.size() % 3 != 0) return "its vertices are no groups of three numbers";
    if (body.m_rigid &&
        !std::all_of(body.m_vertices.begin(), body.m_vertices.end(), [](float x) { return std::isfinite(x); }))
        return "its vertices are not finite";
    if (!indicesFit(body.m_triangles, 3, body.vertexCount()))
        return "its triangles name vertices that it does not have";
    if (!indicesFit(body.m_lines, 2, body.vertexCount())) return "its lines name vertices that it does not have";
    if (body.m_frames.size() != body.frameSize() * body.frameCount()) return "its last frame is not whole";
    if (body.m_first + body.frameCount() > run.m_frameCount) return "it has more frames than the recording";
    for (const RecordedChannel& channel : body.m_channels)
        if (!channelFits(channel, body)) return "a channel needs low < high, and a value for each vertex and frame";
    return nullptr;
}
}  // namespace

bool checkRecording(const Recording& run, std::string& error)
{
    if (!(run.m_frameTime > 0) || !std::isfinite(run.m_frameTime)) error = "the time of a frame is not above 0";
    for (const RecordedBody& body : run.m_bodies)
        if (const char* problem = problemOf(body, run)) error = "body \"" + body.m_name + "\": " + problem;
    return error.empty();
}

std::vector<float> finiteFrames(const RecordedBody& body)
{
    std::vector<float> values = body.m_frames;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!std::isfinite(values[i])) values[i] = i >= body.frameSize() ? values[i - body.frameSize()] : 0;
    return values;
}
}  // namespace drape
