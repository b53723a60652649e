#include "mesh_io/binary_number.h"
#include "mesh_io/gltf_content.h"
#include "mesh_io/readers.h"

namespace drape
{
namespace
{
std::string tooLong(const std::string& what, std::size_t length, std::size_t there)
{
    return what + ": says " + std::to_string(length) + " bytes where there are " + std::to_string(there);
}

constexpr std::size_t kHeaderBytes = 12;            // magic, version, length of the file
constexpr std::size_t kFirstHeaderBytes = 20;       // glTF 1.0: length and format of the content besides
constexpr std::size_t kChunkHeaderBytes = 8;        // length and type
constexpr std::uint32_t kBinaryChunk = 0x004e4942;  // "BIN" and a zero byte

// Text is padded with spaces; some writers use zero bytes.
std::string withoutPadding(std::string text)
{
    text.resize(text.find_last_not_of('\0') + 1);
    return text;
}

// The first chunk is the JSON text, the next one may be the first buffer, more are for extensions.
std::string findChunks(const std::string& bytes, std::size_t length, std::string& text, std::string& binary,
                       bool& hasBinary)
{
    std::size_t place = kHeaderBytes;
    hasBinary = false;
    for (int chunk = 1; place + kChunkHeaderBytes <= length; ++chunk)
    {
        const std::size_t size = littleUint32(bytes, place), there = length - place - kChunkHeaderBytes;
        const std::uint32_t type = littleUint32(bytes, place + 4);
        if (size > there) return tooLong("chunk " + std::to_string(chunk), size, there);
        place += kChunkHeaderBytes;
        if (chunk == 1) text = withoutPadding(bytes.substr(place, size));
        if (chunk > 1 && type == kBinaryChunk && !hasBinary)
        {
            binary = bytes.substr(place, size);
            hasBinary = true;
        }
        place += size;
    }
    return "";
}
}  // namespace

std::string readGlb(const std::string& bytes, const FindBuffer& findBuffer, MeshFile& mesh)
{
    if (bytes.size() < kHeaderBytes || bytes.compare(0, 4, "glTF") != 0) return "not a mesh: not binary glTF";
    const std::size_t version = littleUint32(bytes, 4), length = littleUint32(bytes, 8);
    if (version != 1 && version != 2) return "glTF version " + std::to_string(version) + " is neither 1 nor 2";
    if (length > bytes.size()) return tooLong("header", length, bytes.size());
    if (bytes.size() > length)
        mesh.m_notes.push_back(counted(bytes.size() - length, "byte") + " behind the glTF not read");
    std::string text, binary;
    bool hasBinary = true;
    if (version == 2)
    {
        const std::string problem = findChunks(bytes, length, text, binary, hasBinary);
        if (!problem.empty()) return problem;
    }
    else
    {
        if (length < kFirstHeaderBytes) return "not a mesh: not binary glTF";
        const std::size_t size = littleUint32(bytes, kHeaderBytes), there = length - kFirstHeaderBytes;
        if (size > there) return tooLong("content", size, there);
        text = bytes.substr(kFirstHeaderBytes, size);
        binary = bytes.substr(kFirstHeaderBytes + size, there - size);
    }
    return readGltfContent(text, hasBinary ? &binary : nullptr, bytes.size(), findBuffer, mesh);
}
}  // namespace drape
