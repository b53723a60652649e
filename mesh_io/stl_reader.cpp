#include <cstring>

#include "mesh_io/binary_number.h"
#include "mesh_io/readers.h"
#include "mesh_io/text_cursor.h"

namespace drape
{
namespace
{
constexpr std::size_t kHeaderBytes = 84;    // a text of 80 bytes and the number of triangles
constexpr std::size_t kTriangleBytes = 50;  // normal, three corners and two bytes of attributes
constexpr std::size_t kNormalBytes = 12;

void addTriangle(MeshFile& mesh)
{
    const std::int32_t last = static_cast<std::int32_t>(mesh.vertexCount()) - 1;
    mesh.addTriangle(last - 2, last - 1, last);
}

std::string readBinary(const std::string& bytes, MeshFile& mesh)
{
    const std::size_t count = littleUint32(bytes, kHeaderBytes - 4), there = bytes.size();
    const std::size_t needed = kHeaderBytes + count * kTriangleBytes;
    if (needed > there)
        return "the file ends too early: " + counted(count, "triangle") + " take " + std::to_string(needed) +
               " bytes where there are " + std::to_string(there);
    if (count > kMostVertices / 3) return "has more than " + std::to_string(kMostVertices / 3) + " triangles";
    mesh.m_positions.reserve(9 * count);
    for (std::size_t triangle = 0; triangle < count; ++triangle)
    {
        const std::size_t start = kHeaderBytes + triangle * kTriangleBytes + kNormalBytes;
        for (std::size_t i = 0; i < 9; ++i)
            mesh.m_positions.push_back(decodeNumber(NumberType::Float32, bytes.data() + start + 4 * i, false));
        addTriangle(mesh);
    }
    if (there > needed) mesh.m_notes.push_back(counted(there - needed, "byte") + " behind the last triangle not read");
    return "";
}

class StlTextReader
{
public:
    StlTextReader(const std::string& bytes, MeshFile& mesh) : m_cursor(bytes), m_mesh(mesh) {}

    // Names of solids may be any text, so the rest of such a line is skipped, as are lines of unknown extensions.
    std::string read()
    {
        bool ended = false;
        for (std::string_view word = keyword(); !word.empty(); word = keyword())
        {
            if (!sameWord(word, "facet"))
            {
                ended = ended || sameWord(word, "endsolid");
                m_cursor.nextLine();
                continue;
            }
            ended = false;
            const std::string problem = readFacet();
            if (!problem.empty())
                return "line " + std::to_string(m_cursor.line()) + ": facet " + std::to_string(m_mesh.faceCount() + 1) +
                       " " + problem;
        }
        if (m_mesh.faceCount() == 0) return "not a mesh: no facets";
        return ended ? ""
                     : "the file ends too early, after " + counted(m_mesh.faceCount(), "facet") + ", without endsolid";
    }

private:
    // Returns the next word; "end facet" and the like count as one.
    std::string_view keyword()
    {
        const std::string_view word = m_cursor.wordOfAnyLine();
        if (!sameWord(word, "end")) return word;
        const std::string_view what = m_cursor.word();
        if (sameWord(what, "solid")) return "endsolid";
        return sameWord(what, "facet") ? "endfacet" : "endloop";
    }

    std::string readFacet()
    {
        int vertices = 0;
        for (std::string_view word = keyword(); !sameWord(word, "endfacet"); word = keyword())
        {
            if (word.empty()) return "is not complete: the file ends too early";
            if (sameWord(word, "facet") || sameWord(word, "endsolid")) return "has no endfacet";
            if (!sameWord(word, "vertex")) continue;  // the normal, outer loop and endloop
            const std::string problem = ++vertices <= 3 ? readVertex() : "";
            if (!problem.empty()) return problem;
        }
        if (vertices != 3) return "has " + std::to_string(vertices) + " vertices, not 3";
        if (m_mesh.vertexCount() > kMostVertices) return "is one too many: indices have 31 bits";
        addTriangle(m_mesh);
        return "";
    }

    std::string readVertex()
    {
        double position[3];
        for (double& coordinate : position)
        {
            const std::string_view word = m_cursor.word();
            if (word.empty()) return "has a vertex with fewer than three coordinates";
            const std::string problem = readNumber(word, coordinate);
            if (!problem.empty()) return "has a vertex whose coordinate " + problem;
        }
        m_mesh.addVertex(position[0], position[1], position[2]);
        return "";
    }

    TextCursor m_cursor;
    MeshFile& m_mesh;
};

// Binary files may begin with "solid", too. Their count of triangles has a zero byte below 16 million.
bool isText(const std::string& bytes)
{
    return sameWord(TextCursor(bytes).wordOfAnyLine(), "solid") && bytes.find('\0') >= kHeaderBytes;
}
}  // namespace

std::string readStl(const std::string& bytes, MeshFile& mesh)
{
    mesh.m_hasIndices = false;
    const bool binary = bytes.size() >= kHeaderBytes &&
                        bytes.size() == kHeaderBytes + littleUint32(bytes, kHeaderBytes - 4) * kTriangleBytes;
    if (!binary && isText(bytes)) return StlTextReader(bytes, mesh).read();
    if (bytes.size() < kHeaderBytes) return "not a mesh: neither text that begins with solid nor a binary STL header";
    return readBinary(bytes, mesh);
}
}  // namespace drape
