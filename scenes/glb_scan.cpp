#include <cstdint>

#include "scenes/mesh_scan.h"

namespace drape
{
namespace
{
constexpr std::size_t kHeaderBytes = 12;       // of version 2: magic, version, length of the file
constexpr std::size_t kFirstHeaderBytes = 20;  // of version 1: length and format of the content besides
constexpr std::size_t kChunkHeaderBytes = 8;   // length and type

// Little-endian, as in all of the format.
std::size_t numberAt(const std::string& bytes, std::size_t place)
{
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;)
        value = value << 8 | static_cast<unsigned char>(bytes[place + i]);
    return value;
}

std::string tooLong(const std::string& what, std::size_t length, std::size_t there)
{
    return what + ": says " + std::to_string(length) + " bytes where there are " + std::to_string(there);
}

std::string chunkProblem(const std::string& bytes)
{
    std::size_t place = kHeaderBytes;
    for (int chunk = 1; place + kChunkHeaderBytes <= bytes.size(); ++chunk)
    {
        const std::size_t length = numberAt(bytes, place), there = bytes.size() - place - kChunkHeaderBytes;
        if (length > there) return tooLong("chunk " + std::to_string(chunk), length, there);
        const std::size_t content = place + kChunkHeaderBytes;
        const std::string problem = chunk == 1 ? scanGltf(bytes.substr(content, length)) : "";
        if (!problem.empty()) return problem;
        place += kChunkHeaderBytes + length;
    }
    return "";
}
}  // namespace

std::string scanGlb(const std::string& bytes)
{
    if (bytes.size() < kHeaderBytes || bytes.compare(0, 4, "glTF") != 0) return "not a mesh: not binary glTF";
    const std::size_t version = numberAt(bytes, 4), length = numberAt(bytes, 8);
    if (version != 1 && version != 2) return "glTF version " + std::to_string(version) + " is neither 1 nor 2";
    if (length > bytes.size()) return tooLong("header", length, bytes.size());
    if (version == 2) return chunkProblem(bytes);
    if (bytes.size() < kFirstHeaderBytes) return "not a mesh: not binary glTF";
    const std::size_t content = numberAt(bytes, 12), there = bytes.size() - kFirstHeaderBytes;
    return content > there ? tooLong("content", content, there) : scanGltf(bytes.substr(kFirstHeaderBytes, content));
}
}  // namespace drape
