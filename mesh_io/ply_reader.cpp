#include <cmath>
#include <memory>

#include "mesh_io/ply_numbers.h"
#include "mesh_io/readers.h"
#include "mesh_io/text_cursor.h"

namespace drape
{
namespace
{
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
    const std::unique_ptr<PlyNumbers> numbers = makePlyNumbers(bytes, header);
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
