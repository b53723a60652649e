#include "tools/cloth_drop/recording_stream.h"

#include <limits>

namespace drape
{
namespace
{
using Json = nlohmann::json;

// Returns the last `count` values.
Json tail(const std::vector<float>& values, std::size_t count)
{
    return std::vector<float>(values.end() - static_cast<std::ptrdiff_t>(count), values.end());
}

// JSON has null for numbers that are not finite.
void append(const Json& numbers, std::vector<float>& values)
{
    for (const Json& number : numbers)
        values.push_back(number.is_null() ? std::numeric_limits<float>::quiet_NaN() : number.get<float>());
}
}  // namespace

Json asBodies(const Recording& recording)
{
    Json bodies = Json::array();
    for (const RecordedBody& body : recording.m_bodies)
    {
        Json channels = Json::array();
        for (const RecordedChannel& channel : body.m_channels)
            channels.push_back({channel.m_name, channel.m_unit, channel.m_low, channel.m_high});
        bodies.push_back({{"name", body.m_name},
                          {"rigid", body.m_rigid},
                          {"triangles", body.m_triangles},
                          {"lines", body.m_lines},
                          {"vertices", body.m_vertices},
                          {"channels", std::move(channels)}});
    }
    return bodies;
}

Json asFrame(const Recording& recording)
{
    Json frame = Json::array();
    for (const RecordedBody& body : recording.m_bodies)
    {
        Json numbers = {tail(body.m_frames, body.frameSize())};
        for (const RecordedChannel& channel : body.m_channels)
            numbers.push_back(tail(channel.m_values, body.vertexCount()));
        frame.push_back(std::move(numbers));
    }
    return frame;
}

void takeBodies(const Json& line, Recording& recording)
{
    for (const Json& json : line)
    {
        RecordedBody body;
        body.m_name = json.at("name");
        body.m_rigid = json.at("rigid");
        body.m_triangles = json.at("triangles").get<std::vector<std::int32_t>>();
        body.m_lines = json.at("lines").get<std::vector<std::int32_t>>();
        append(json.at("vertices"), body.m_vertices);
        for (const Json& channel : json.at("channels"))
            body.m_channels.push_back({channel.at(0), channel.at(1), channel.at(2), channel.at(3), {}});
        recording.m_bodies.push_back(std::move(body));
    }
}

void takeFrame(const Json& line, Recording& recording)
{
    for (std::size_t i = 0; i < recording.m_bodies.size(); ++i)
    {
        RecordedBody& body = recording.m_bodies[i];
        append(line.at(i).at(0), body.m_frames);
        for (std::size_t k = 0; k < body.m_channels.size(); ++k)
            append(line.at(i).at(k + 1), body.m_channels[k].m_values);
    }
    ++recording.m_frameCount;
}
}  // namespace drape
