#include <cmath>
#include <memory>

#include "mesh_io/ply_header.h"
#include "mesh_io/readers.h"
#include "mesh_io/text_cursor.h"

namespace drape
{
namespace
{
// The body of a PLY file as a sequence of numbers.
class PlyNumbers
{
public:
    virtual ~PlyNumbers() = default;
    // Called before and after each element. Return "" or what is wrong with its extent.
    virtual std::string startElement() = 0;
    virtual std::string endElement() = 0;
    // Reads the next number. Returns "" or why there is none.
    virtual std::string next(NumberType type, double& value) = 0;
    // Whether `count` elements could be there, each of at least the size given. Keeps memory within the file's size.
    virtual bool canHold(std::uint64_t count, std::size_t smallestSize) const = 0;
    // Describes what follows the last element: empty for nothing.
    virtual std::string rest() = 0;
    // Whether nothing may follow the last element.
    virtual bool mustEnd() const = 0;
};

class BinaryNumbers : public PlyNumbers
{
public:
    BinaryNumbers(const std::string& bytes, const PlyHeader& header)
        : m_bytes(bytes), m_place(header.m_bodyStart), m_bigEndian(header.m_encoding == PlyEncoding::BigEndian)
    {
    }

    std::string startElement() override { return ""; }
    std::string endElement() override { return ""; }
    std::string next(NumberType type, double& value) override
    {
        const std::size_t size = numberSize(type);
        if (size > m_bytes.size() - m_place) return "the file ends too early";
        value = decodeNumber(type, m_bytes.data() + m_place, m_bigEndian);
        m_place += size;
        return "";
    }
    bool canHold(std::uint64_t count, std::size_t smallestSize) const override
    {
        return smallestSize == 0 || count <= (m_bytes.size() - m_place) / smallestSize;
    }
    std::string rest() override { return m_place == m_bytes.size() ? "" : counted(m_bytes.size() - m_place, "byte"); }
    bool mustEnd() const override { return false; }

private:
    const std::string& m_bytes;
    std::size_t m_place;
    bool m_bigEndian;
};

// Text has one element a line, and what follows on the line is passed over. A few writers break lines elsewhere. Where
// there are fewer lines than elements, or the first line is too short, line ends are blanks, and the numbers must be as
// many as the header says.
class TextNumbers : public PlyNumbers
{
public:
    TextNumbers(const std::string& bytes, const PlyHeader& header)
        : m_bytes(bytes), m_cursor(bytes, header.m_bodyStart), m_headerLines(header.m_lines)
    {
        std::uint64_t elements = 0, lines = 0;
        std::size_t needed = 0, words = 0;  // numbers that the first element has at least; words of the first line
        for (const PlyElement& element : header.m_elements)
        {
            if (element.m_properties.empty() || element.m_count == 0) continue;
            if (elements == 0) needed = element.m_properties.size();
            elements += element.m_count;
        }
        TextCursor cursor = m_cursor;
        for (cursor.skipSpace(); !cursor.atEnd() && lines < elements; cursor.skipSpace(), ++lines)
        {
            while (lines == 0 && !cursor.word().empty())
                ++words;
            cursor.nextLine();
        }
        m_byLines = lines >= elements && words >= needed;
        m_isStrict = header.m_unknownLines > 0;
    }

    std::string startElement() override
    {
        m_cursor.skipSpace();
        return "";
    }
    std::string endElement() override
    {
        if (!m_byLines) return "";
        m_cursor.skipBlanks();
        if (m_isStrict && !m_cursor.atLineEnd())
            return place() + "more numbers than the PLY header says, which has a line that is none of its keywords";
        m_cursor.nextLine();
        return "";
    }
    std::string next(NumberType, double& value) override
    {
        const std::string_view word = m_byLines ? m_cursor.word() : m_cursor.wordOfAnyLine();
        if (word.empty()) return m_cursor.atEnd() ? "the file ends too early" : place() + "the line ends too early";
        const std::string problem = readNumber(word, value);
        return problem.empty() ? "" : place() + problem;
    }
    bool canHold(std::uint64_t count, std::size_t smallestSize) const override
    {
        return smallestSize == 0 || count <= m_bytes.size() - m_cursor.place();
    }
    std::string rest() override
    {
        m_cursor.skipSpace();
        if (m_cursor.atEnd()) return "";
        std::size_t lines = 0;
        for (; !m_cursor.atEnd(); m_cursor.skipSpace(), ++lines)
            m_cursor.nextLine();
        return counted(lines, "line");
    }
    bool mustEnd() const override { return !m_byLines; }

private:
    std::string place() const { return "line " + std::to_string(m_headerLines + m_cursor.line()) + ": "; }

    const std::string& m_bytes;
    TextCursor m_cursor;
    std::size_t m_headerLines;
    bool m_byLines = true;
    bool m_isStrict = false;
};

class PlyReader
{
public:
    PlyReader(const PlyHeader& header, PlyNumbers& numbers, MeshFile& mesh)
        : m_header(header), m_numbers(numbers), m_mesh(mesh)
    {
    }

    std::string read()
    {
        const std::string problem = checkHeader();
        if (!problem.empty()) return problem;
        for (const PlyElement& element : m_header.m_elements)
        {
            const std::string elementProblem = readElements(element);
            if (!elementProblem.empty()) return elementProblem;
        }
        noteShortFaces(m_shortFaces, m_mesh);
        return "";
    }

private:
    enum class Role
    {
        Vertex,
        Face,
        Strip,
        Other
    };

    static Role roleOf(const PlyElement& element)
    {
        if (element.m_name == "vertex") return Role::Vertex;
        if (element.m_name == "face") return Role::Face;
        return element.m_name == "tristrips" ? Role::Strip : Role::Other;
    }

    static int cornersOf(const PlyElement& element)
    {
        const int indices = element.find("vertex_indices", true);
        return indices >= 0 ? indices : element.find("vertex_index", true);
    }

    std::string checkHeader()
    {
        int vertexElements = 0;
        std::uint64_t faces = 0;
        for (const PlyElement& element : m_header.m_elements)
        {
            const Role role = roleOf(element);
            if (role == Role::Vertex)
            {
                ++vertexElements;
                m_vertices = element.m_count;
                for (const char* axis : {"x", "y", "z"})
                    if (element.find(axis, false) < 0)
                        return std::string("not a mesh: vertices have no ") + axis + " in the PLY header";
            }
            if (role != Role::Face && role != Role::Strip) continue;
            faces += element.m_count;
            if (element.m_count > 0 && cornersOf(element) < 0)
                return "not a mesh: element '" + element.m_name + "' has no vertex_indices in the PLY header";
        }
        if (vertexElements > 1) return "not a mesh: the PLY header has two elements 'vertex'";
        if (m_vertices == 0) return "not a mesh: no vertices";
        if (m_vertices > kMostVertices) return "has more than " + std::to_string(kMostVertices) + " vertices";
        return faces == 0 ? "no triangles: the file has points alone" : "";
    }

    std::string readElements(const PlyElement& element)
    {
        std::size_t smallest = 0;
        for (const PlyProperty& property : element.m_properties)
            smallest += property.smallestSize();
        if (smallest == 0) return "";  // nothing to read
        if (!m_numbers.canHold(element.m_count, smallest))
            return "the file ends too early: the PLY header says " + std::to_string(element.m_count) + " of element '" +
                   element.m_name.substr(0, 32) + "'";
        const Role role = roleOf(element);
        if (role == Role::Vertex) findCoordinates(element);
        const int corners = role == Role::Face || role == Role::Strip ? cornersOf(element) : -1;
        for (std::uint64_t i = 0; i < element.m_count; ++i)
        {
            std::string problem = m_numbers.startElement();
            if (problem.empty()) problem = readProperties(element, role, corners);
            if (problem.empty()) problem = m_numbers.endElement();
            if (!problem.empty()) return element.m_name.substr(0, 32) + " " + std::to_string(i + 1) + ": " + problem;
        }
        return "";
    }

    void findCoordinates(const PlyElement& element)
    {
        m_coordinates[0] = element.find("x", false);
        m_coordinates[1] = element.find("y", false);
        m_coordinates[2] = element.find("z", false);
    }

    std::string readProperties(const PlyElement& element, Role role, int corners)
    {
        double position[3] = {};
        for (std::size_t i = 0; i < element.m_properties.size(); ++i)
        {
            const PlyProperty& property = element.m_properties[i];
            double value = 0;
            std::string problem;
            if (property.m_isList)
                problem = static_cast<int>(i) == corners ? readCorners(property, role) : skipList(property);
            else
                problem = m_numbers.next(property.m_type, value);
            if (!problem.empty()) return problem;
            for (int axis = 0; axis < 3 && role == Role::Vertex; ++axis)
                if (m_coordinates[axis] == static_cast<int>(i)) position[axis] = value;
        }
        if (role == Role::Vertex) m_mesh.addVertex(position[0], position[1], position[2]);
        return "";
    }

    std::string readLength(const PlyProperty& property, double& length)
    {
        const std::string problem = m_numbers.next(property.m_countType, length);
        if (!problem.empty()) return problem;
        return length >= 0 && length == std::floor(length) && std::isfinite(length)
                   ? ""
                   : "the length " + numberText(length) + " of a list is not a whole number";
    }

    std::string skipList(const PlyProperty& property)
    {
        double length = 0, value = 0;
        std::string problem = readLength(property, length);
        for (double i = 0; i < length && problem.empty(); ++i)
            problem = m_numbers.next(property.m_type, value);
        return problem;
    }

    std::string readCorners(const PlyProperty& property, Role role)
    {
        double length = 0, index = 0;
        std::string problem = readLength(property, length);
        m_strip.clear();
        for (double i = 0; i < length && problem.empty(); ++i)
        {
            problem = m_numbers.next(property.m_type, index);
            const bool ends = role == Role::Strip && index == -1;
            if (problem.empty() && !ends) problem = indexProblem(index);
            if (!problem.empty()) break;
            if (role == Role::Strip)
                addToStrip(ends, index);
            else
                m_mesh.m_corners.push_back(static_cast<std::int32_t>(index));
        }
        if (problem.empty() && role == Role::Face && !m_mesh.endFace()) ++m_shortFaces;
        return problem;
    }

    std::string indexProblem(double index) const
    {
        if (index != std::floor(index)) return "index " + numberText(index) + " is not a whole number";  // also for NaN
        if (index >= 0 && index < static_cast<double>(m_vertices)) return "";
        return "index " + numberText(index) + " is out of range (" + std::to_string(m_vertices) + " vertices)";
    }

    // Every index of a strip but the first two ends a triangle; every second triangle is wound the other way.
    void addToStrip(bool ends, double index)
    {
        if (ends)
        {
            m_strip.clear();
            return;
        }
        m_strip.push_back(static_cast<std::int32_t>(index));
        const std::size_t n = m_strip.size();
        if (n < 3) return;
        const bool odd = n % 2 == 0;
        m_mesh.addTriangle(m_strip[odd ? n - 2 : n - 3], m_strip[odd ? n - 3 : n - 2], m_strip[n - 1]);
    }

    const PlyHeader& m_header;
    PlyNumbers& m_numbers;
    MeshFile& m_mesh;
    std::uint64_t m_vertices = 0;
    int m_coordinates[3] = {-1, -1, -1};  // the properties x, y and z of a vertex
    std::vector<std::int32_t> m_strip;
    std::size_t m_shortFaces = 0;
};
}  // namespace

std::string readPly(const std::string& bytes, MeshFile& mesh)
{
    PlyHeader header;
    std::string problem = readPlyHeader(bytes, header);
    if (!problem.empty()) return problem;
    const bool text = header.m_encoding == PlyEncoding::Text;
    if (text && bytes.find('\0') != std::string::npos)
        return "not a mesh: an ASCII PLY file is text, this one has zero bytes";
    std::unique_ptr<PlyNumbers> numbers;
    if (text)
        numbers = std::make_unique<TextNumbers>(bytes, header);
    else
        numbers = std::make_unique<BinaryNumbers>(bytes, header);
    problem = PlyReader(header, *numbers, mesh).read();
    if (!problem.empty()) return problem;
    const std::string rest = numbers->rest();
    if (rest.empty()) return "";
    if (header.m_unknownLines > 0 || numbers->mustEnd())
        return "has " + rest + " behind what the PLY header says, so that the two do not match";
    mesh.m_notes.push_back(rest + " behind the last element not read");
    return "";
}
}  // namespace drape
