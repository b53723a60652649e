#include "mesh_io/readers.h"
#include "mesh_io/text_cursor.h"

namespace drape
{
namespace
{
class ObjReader
{
public:
    ObjReader(const std::string& bytes, MeshFile& mesh) : m_cursor(bytes), m_bytes(bytes), m_mesh(mesh) {}

    std::string read()
    {
        if (m_bytes.find('\0') != std::string::npos) return "not a mesh: an OBJ file is text, this one has zero bytes";
        for (; !m_cursor.atEnd(); m_cursor.nextLine())
        {
            const std::string_view keyword = m_cursor.word();
            std::string problem;
            if (keyword == "v") problem = readVertex();
            if (keyword == "f" || keyword == "fo") problem = readFace();
            if (!problem.empty()) return "line " + std::to_string(m_cursor.line()) + ": " + problem;
        }
        return finish();
    }

private:
    // Returns the next word of the statement, which continues in the next line after a backslash. Returns an empty word
    // at its end or before a comment.
    std::string_view statementWord()
    {
        for (;;)
        {
            std::string_view word = m_cursor.word();
            const std::size_t comment = word.find('#');
            if (comment != std::string_view::npos) skipComment();
            if (comment != std::string_view::npos) return word.substr(0, comment);
            if (word.empty() || word.back() != '\\') return word;
            m_cursor.skipBlanks();
            if (!m_cursor.atLineEnd()) return word;
            m_cursor.nextLine();
            word.remove_suffix(1);
            if (!word.empty()) return word;
        }
    }

    void skipComment()
    {
        while (!m_cursor.atLineEnd())
        {
            m_cursor.word();
            m_cursor.skipBlanks();
        }
    }

    // A weight or a colour may follow the three coordinates. It is ignored.
    std::string readVertex()
    {
        double position[3];
        const std::string vertex = "vertex " + std::to_string(m_mesh.vertexCount() + 1) + ": ";
        for (double& coordinate : position)
        {
            const std::string_view word = statementWord();
            if (word.empty()) return vertex + "has fewer than three coordinates";
            const std::string problem = readNumber(word, coordinate);
            if (!problem.empty()) return vertex + "coordinate " + problem;
        }
        m_mesh.addVertex(position[0], position[1], position[2]);
        return "";
    }

    std::string readFace()
    {
        for (std::string_view word = statementWord(); !word.empty(); word = statementWord())
        {
            const std::string problem = addCorner(word.substr(0, word.find('/')));
            if (!problem.empty()) return problem;
        }
        if (m_mesh.endFace()) return "";
        ++m_shortFaces;
        return m_cursor.atEnd() ? "the file ends within a face" : "";
    }

    // Indices of texture coordinates and normals behind a slash are not looked at.
    std::string addCorner(std::string_view word)
    {
        long long index = 0;
        if (!readInteger(word, index).empty()) return "face index " + quoted(word) + " is not a whole number";
        const long long vertices = static_cast<long long>(m_mesh.vertexCount());
        if (index == 0 || index < -vertices || index > static_cast<long long>(kMostVertices))
            return "face index " + std::to_string(index) + " is out of range (" + std::to_string(vertices) +
                   " vertices so far)";
        const long long vertex = index > 0 ? index - 1 : vertices + index;
        if (vertex >= m_largest)
        {
            m_largest = vertex + 1;
            m_largestLine = m_cursor.line();
        }
        m_mesh.m_corners.push_back(static_cast<std::int32_t>(vertex));
        return "";
    }

    // Faces may come before their vertices, so the largest index is checked at the end.
    std::string finish()
    {
        const std::size_t vertices = m_mesh.vertexCount();
        if (vertices == 0) return "not a mesh: no vertices";
        if (vertices > kMostVertices) return "has more than " + std::to_string(kMostVertices) + " vertices";
        if (m_largest > static_cast<long long>(vertices))
            return "line " + std::to_string(m_largestLine) + ": face index " + std::to_string(m_largest) +
                   " is out of range (" + std::to_string(vertices) + " vertices)";
        noteShortFaces(m_shortFaces, m_mesh);
        return "";
    }

    TextCursor m_cursor;
    const std::string& m_bytes;
    MeshFile& m_mesh;
    long long m_largest = 0;  // the largest face index, counted from 1
    std::size_t m_largestLine = 0;
    std::size_t m_shortFaces = 0;
};
}  // namespace

std::string readObj(const std::string& bytes, MeshFile& mesh)
{
    return ObjReader(bytes, mesh).read();
}
}  // namespace drape
