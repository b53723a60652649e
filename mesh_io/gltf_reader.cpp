#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "mesh_io/gltf_buffers.h"
#include "mesh_io/gltf_content.h"
#include "mesh_io/readers.h"
#include "mesh_io/text_cursor.h"

namespace drape
{
namespace
{
// Limits the nesting of brackets and of nodes. The specification has no limit; recursive readers would run out of
// stack.
constexpr std::size_t kMostDepth = 512;
// Limits the size of a mesh. Nodes may repeat a mesh: each byte of a file may give this many vertices or corners, plus
// a constant.
constexpr std::size_t kMostPerByte = 256, kMostBesides = std::size_t(1) << 20;

enum Mode
{
    kTriangles = 4,
    kTriangleStrip = 5,
    kTriangleFan = 6
};

// A column-major 4 × 4 matrix whose last row is 0 0 0 1.
using Matrix = std::array<double, 16>;
constexpr Matrix kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

Matrix multiply(const Matrix& a, const Matrix& b)
{
    Matrix product = {};
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            for (int i = 0; i < 4; ++i)
                product[4 * column + row] += a[4 * i + row] * b[4 * column + i];
    return product;
}

// Returns the determinant of the upper 3x3 matrix, which rotates and scales.
double determinant(const Matrix& m)
{
    return m[0] * (m[5] * m[10] - m[6] * m[9]) + m[4] * (m[9] * m[2] - m[10] * m[1]) +
           m[8] * (m[1] * m[6] - m[2] * m[5]);
}

bool readMatrix(const Json& node, Matrix& matrix)
{
    matrix = kIdentity;
    if (!at(node, "matrix").is_null()) return readNumbers(at(node, "matrix"), 16, matrix.data());
    double move[3] = {0, 0, 0}, turn[4] = {0, 0, 0, 1}, scale[3] = {1, 1, 1};
    if ((!at(node, "translation").is_null() && !readNumbers(at(node, "translation"), 3, move)) ||
        (!at(node, "rotation").is_null() && !readNumbers(at(node, "rotation"), 4, turn)) ||
        (!at(node, "scale").is_null() && !readNumbers(at(node, "scale"), 3, scale)))
        return false;
    const double x = turn[0], y = turn[1], z = turn[2], w = turn[3];
    const double rotation[9] = {1 - 2 * (y * y + z * z), 2 * (x * y + z * w),     2 * (x * z - y * w),
                                2 * (x * y - z * w),     1 - 2 * (x * x + z * z), 2 * (y * z + x * w),
                                2 * (x * z + y * w),     2 * (y * z - x * w),     1 - 2 * (x * x + y * y)};
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            matrix[4 * column + row] = rotation[3 * column + row] * scale[column];
    for (int row = 0; row < 3; ++row)
        matrix[12 + row] = move[row];
    return true;
}

// Scans the text before it is parsed.
bool isNestedTooDeep(const std::string& text)
{
    std::size_t depth = 0;
    bool inString = false;
    for (std::size_t i = 0; i < text.size() && depth <= kMostDepth; ++i)
    {
        const char c = text[i];
        if (inString && c == '\\')
            ++i;
        else if (c == '"')
            inString = !inString;
        if (inString) continue;
        if (c == '[' || c == '{') ++depth;
        if ((c == ']' || c == '}') && depth > 0) --depth;
    }
    return depth > kMostDepth;
}

// Extensions that leave positions and triangles as they are, or that are read here.
bool isHarmless(const std::string& extension)
{
    for (const char* part : {"_materials_", "_texture_", "_lights_", "_xmp", "_animation_"})
        if (extension.find(part) != std::string::npos) return true;
    return extension == "KHR_mesh_quantization" || extension == "KHR_binary_glTF";
}

std::string extensionsProblem(const Json& extensions)
{
    if (!extensions.is_array()) return "";
    for (const Json& extension : extensions)
        if (!extension.is_string() || !isHarmless(extension.get_ref<const std::string&>()))
            return "requires the extension " +
                   extension.dump(-1, ' ', true, Json::error_handler_t::replace).substr(0, 64) + ", which is not read";
    return "";
}

class GltfReader
{
public:
    GltfReader(const Json& content, const std::string* binary, const FindBuffer& findBuffer, std::size_t fileBytes,
               MeshFile& mesh)
        : m_content(content), m_fileBytes(fileBytes), m_buffers(content, binary, findBuffer, kMostBesides), m_mesh(mesh)
    {
        m_mesh.m_hasIndices = false;
    }

    std::string read()
    {
        std::vector<std::pair<Json, Matrix>> level;
        for (const Json& root : roots())
            level.emplace_back(root, kIdentity);
        std::map<std::string, bool> visited;
        for (std::size_t depth = 0; !level.empty(); ++depth)
        {
            if (depth > kMostDepth) return "nodes are nested deeper than " + std::to_string(kMostDepth);
            std::vector<std::pair<Json, Matrix>> next;
            for (const auto& [reference, parent] : level)
            {
                // Nodes are trees. A node with two parents would be read twice, its children four times.
                bool& seen = visited[nameOf(reference)];
                if (seen) return "node " + shortName(reference) + " has two parents";
                seen = true;
                const std::string problem = readNode(reference, parent, next);
                if (!problem.empty()) return "node " + shortName(reference) + ": " + problem;
            }
            level.swap(next);
        }
        if (at(m_content, "nodes").empty()) return readLooseMeshes();
        if (m_hasSkins) m_mesh.m_notes.push_back("skins and morph targets not applied");
        return "";
    }

private:
    // Returns a reference as a key.
    static std::string nameOf(const Json& reference)
    {
        return reference.dump(-1, ' ', true, Json::error_handler_t::replace);
    }
    // Returns the name, shortened for messages.
    static std::string shortName(const Json& reference) { return nameOf(reference).substr(0, 64); }

    // Returns the nodes of the default scene, else of the first, else all nodes that are no child.
    std::vector<Json> roots() const
    {
        const Json &scenes = at(m_content, "scenes"), &nodes = at(m_content, "nodes");
        const Json* scene = &follow(scenes, at(m_content, "scene"));
        if (scene->is_null() && (scenes.is_array() || scenes.is_object()) && !scenes.empty()) scene = &*scenes.begin();
        std::vector<Json> found;
        if (at(*scene, "nodes").is_array())
        {
            for (const Json& node : at(*scene, "nodes"))
                found.push_back(node);
            return found;
        }
        std::map<std::string, bool> isChild;
        for (const Json& node : nodes)
            for (const Json& child : at(node, "children"))
                isChild[nameOf(child)] = true;
        std::size_t index = 0;
        for (const auto& node : nodes.items())
        {
            const Json reference = nodes.is_object() ? Json(node.key()) : Json(index++);
            if (isChild.count(nameOf(reference)) == 0) found.push_back(reference);
        }
        return found;
    }

    std::string readNode(const Json& reference, const Matrix& parent, std::vector<std::pair<Json, Matrix>>& next)
    {
        const Json& node = follow(at(m_content, "nodes"), reference);
        if (!node.is_object()) return "is out of range";
        Matrix own;
        if (!readMatrix(node, own)) return "its transform is not made of numbers";
        const Matrix toWorld = multiply(parent, own);
        if (at(node, "children").is_array())
            for (const Json& child : at(node, "children"))
                next.emplace_back(child, toWorld);
        m_hasSkins = m_hasSkins || !at(node, "skin").is_null() || !at(node, "weights").is_null();
        std::string problem;
        if (!at(node, "mesh").is_null()) problem = readMesh(at(node, "mesh"), toWorld);
        if (at(node, "meshes").is_array())  // glTF 1.0
            for (const Json& mesh : at(node, "meshes"))
                if (problem.empty()) problem = readMesh(mesh, toWorld);
        return problem;
    }

    // A file without nodes is a collection of meshes.
    std::string readLooseMeshes()
    {
        const Json& meshes = at(m_content, "meshes");
        std::size_t index = 0;
        for (const auto& mesh : meshes.items())
        {
            const std::string problem = readMesh(meshes.is_object() ? Json(mesh.key()) : Json(index++), kIdentity);
            if (!problem.empty()) return problem;
        }
        return "";
    }

    std::string readMesh(const Json& reference, const Matrix& toWorld)
    {
        const Json& mesh = follow(at(m_content, "meshes"), reference);
        if (!mesh.is_object()) return "mesh " + shortName(reference) + " is out of range";
        // Primitives that share positions share vertices.
        std::map<std::string, Vertices> known;
        std::size_t number = 0;
        if (!at(mesh, "primitives").is_array()) return "";
        for (const Json& primitive : at(mesh, "primitives"))
        {
            const std::string problem = readPrimitive(primitive, toWorld, known);
            if (!problem.empty())
                return "mesh " + shortName(reference) + ": primitive " + std::to_string(number) + ": " + problem;
            ++number;
        }
        return "";
    }

    struct Vertices
    {
        std::size_t m_first = 0, m_count = 0;
        bool m_isMirrored = false;  // by the node's transform, which turns the winding around
    };

    std::string readPrimitive(const Json& primitive, const Matrix& toWorld, std::map<std::string, Vertices>& known)
    {
        std::size_t mode = 0;
        if (!readCount(primitive, "mode", kTriangles, mode) || mode > kTriangleFan) return "unknown mode";
        const Json& positions = at(at(primitive, "attributes"), "POSITION");
        if (mode < kTriangles || positions.is_null()) return "";  // points and lines have no surface
        const auto found = known.emplace(nameOf(positions), Vertices());
        std::string problem = found.second ? addVertices(positions, toWorld, found.first->second) : "";
        if (!problem.empty()) return problem;
        const Vertices vertices = found.first->second;
        const Json& indices = at(primitive, "indices");
        m_order.m_values.clear();
        if (indices.is_null())
            for (std::size_t i = 0; i < vertices.m_count; ++i)
                m_order.m_values.push_back(static_cast<double>(i));
        else
        {
            m_mesh.m_hasIndices = true;
            problem = m_buffers.read(indices, "SCALAR", 1, m_order);
        }
        return problem.empty() ? addTriangles(mode, vertices) : problem;
    }

    std::string addVertices(const Json& reference, const Matrix& m, Vertices& vertices)
    {
        GltfNumbers positions;
        const std::string problem = m_buffers.read(reference, "VEC3", 3, positions);
        if (!problem.empty()) return problem;
        vertices = {m_mesh.vertexCount(), positions.rows(), determinant(m) < 0};
        if (vertices.m_first + vertices.m_count > std::min(most(), kMostVertices))
            return "its nodes repeat meshes to more than " + std::to_string(std::min(most(), kMostVertices)) +
                   " vertices";
        const bool moves = m != kIdentity;  // without a transform every number stays as it is
        for (std::size_t i = 0; i < positions.rows(); ++i)
        {
            const double* p = &positions.m_values[3 * i];
            if (moves)
                m_mesh.addVertex(m[0] * p[0] + m[4] * p[1] + m[8] * p[2] + m[12],
                                 m[1] * p[0] + m[5] * p[1] + m[9] * p[2] + m[13],
                                 m[2] * p[0] + m[6] * p[1] + m[10] * p[2] + m[14]);
            else
                m_mesh.addVertex(p[0], p[1], p[2]);
        }
        return "";
    }

    std::string addTriangles(std::size_t mode, const Vertices& vertices)
    {
        const std::vector<double>& order = m_order.m_values;
        for (const double index : order)
            if (!(index >= 0 && index < static_cast<double>(vertices.m_count)))
                return "index " + numberText(index) + " is out of range (" + std::to_string(vertices.m_count) +
                       " vertices)";
        const std::size_t step = mode == kTriangles ? 3 : 1;
        if (m_mesh.m_corners.size() + 3 * (order.size() / step) > 3 * most())
            return "its nodes repeat meshes to more than " + std::to_string(most()) + " triangles";
        const auto vertex = [&](std::size_t i)
        { return static_cast<std::int32_t>(vertices.m_first + std::size_t(order[i])); };
        for (std::size_t i = 0; i + 2 < order.size(); i += step)
        {
            const bool turned = (mode == kTriangleStrip && i % 2 == 1) != vertices.m_isMirrored;
            const std::size_t first = mode == kTriangleFan ? 0 : i;
            m_mesh.addTriangle(vertex(turned ? i + 1 : first), vertex(turned ? first : i + 1), vertex(i + 2));
        }
        return "";
    }

    // Returns the largest number of vertices and of triangles.
    std::size_t most() const { return kMostBesides + kMostPerByte * (m_fileBytes + m_buffers.loadedBytes()); }

    const Json& m_content;
    std::size_t m_fileBytes;
    GltfBuffers m_buffers;
    MeshFile& m_mesh;
    GltfNumbers m_order;
    bool m_hasSkins = false;
};
}  // namespace

std::string readGltfContent(const std::string& text, const std::string* binary, std::size_t fileBytes,
                            const FindBuffer& findBuffer, MeshFile& mesh)
{
    if (isNestedTooDeep(text)) return "not a mesh: brackets nested deeper than " + std::to_string(kMostDepth);
    const Json content = Json::parse(text, nullptr, false);
    if (content.is_discarded() || !content.is_object()) return "not a mesh: not the JSON of glTF, or not all of it";
    const std::string problem = extensionsProblem(at(content, "extensionsRequired"));
    return problem.empty() ? GltfReader(content, binary, findBuffer, fileBytes, mesh).read() : problem;
}

std::string readGltf(const std::string& bytes, const FindBuffer& findBuffer, MeshFile& mesh)
{
    return readGltfContent(bytes, nullptr, bytes.size(), findBuffer, mesh);
}
}  // namespace drape
