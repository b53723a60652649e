// STL files, text and binary. Files that other readers open are accepted, and damage is refused.
#include <gtest/gtest.h>

#include "mesh_io/readers.h"
#include "tests/mesh_io/box.h"

namespace drape::test
{
namespace
{
std::string facet(const int* triangle, const std::string& normal = "0 0 0")
{
    std::string text = "facet normal " + normal + "\nouter loop\n";
    for (int i = 0; i < 3; ++i)
    {
        const int* v = kBoxVertices[triangle[i]];
        text += "vertex " + std::to_string(v[0]) + " " + std::to_string(v[1]) + " " + std::to_string(v[2]) + "\n";
    }
    return text + "endloop\nendfacet\n";
}

std::string facets(int first, int last, const std::string& normal = "0 0 0")
{
    std::string text;
    for (int i = first; i < last; ++i)
        text += facet(kBoxTriangles[i], normal);
    return text;
}

std::string binary(std::string header)
{
    header.resize(80, ' ');
    std::string bytes = header + bytesOf(std::uint32_t(12));
    for (const auto& triangle : kBoxTriangles)
    {
        bytes += bytesOf(0.0f) + bytesOf(0.0f) + bytesOf(0.0f);
        for (int index : triangle)
            for (int coordinate : kBoxVertices[index])
                bytes += bytesOf(float(coordinate));
        bytes += std::string(2, '\0');
    }
    return bytes;
}

MeshFile expectBox(const std::string& bytes)
{
    MeshFile mesh;
    EXPECT_EQ(readStl(bytes, mesh), "");
    EXPECT_FALSE(mesh.m_hasIndices);
    EXPECT_EQ(mesh.vertexCount(), 36u);
    EXPECT_EQ(mesh.faceCount(), 12u);
    const std::vector<std::int32_t> corners = boxCorners();
    for (std::size_t i = 0; i < mesh.m_positions.size() && i < 108; ++i)
        EXPECT_EQ(mesh.m_positions[i], kBoxVertices[corners[i / 3]][i % 3]);
    return mesh;
}

void expectRefused(const std::string& bytes, const std::vector<std::string>& words)
{
    MeshFile mesh;
    expectProblem(readStl(bytes, mesh), words);
}
}  // namespace

TEST(StlReader, ReadsText)
{
    const std::string plain = "solid a facet of text\n" + facets(0, 12) + "endsolid\n";
    expectBox(plain);
    expectBox(replaced(plain, "\n", " \r\n\t"));
    expectBox(replaced(plain, "\n", "\r"));
    expectBox(replaced(replaced(plain, "facet", "FACET"), "vertex", "Vertex"));
    expectBox("solid box\n" + facets(0, 12, "nan nan nan") + "endsolid box\n");
    expectBox("solid 1\n" + facets(0, 6) + "endsolid 1\nsolid 2\n" + facets(6, 12) + "endsolid 2");
    expectBox(replaced(replaced(plain, "endfacet", "end facet"), "endsolid", "End Solid"));
    expectBox(plain + std::string(7, '\0'));
    expectBox("\n solid\n" + replaced(facets(0, 12), "\nouter loop", " outer loop") + "endsolid");
}

TEST(StlReader, ReadsBinary)
{
    expectBox(binary("binary"));
    expectBox(binary("solid made by a program"));
    EXPECT_EQ(expectBox(binary("binary") + std::string(64, '\0')).m_notes.size(), 1u);
    EXPECT_EQ(expectBox(binary("solid") + "more").m_notes.size(), 1u);
}

TEST(StlReader, RefusesDamage)
{
    const std::string one = facets(0, 1);
    expectRefused("solid a\n" + one, {"too early", "1 facet", "endsolid"});
    expectRefused("solid a\n" + one + "facet normal 0 0 1\nouter loop\nvertex 0 0 0\n", {"facet 2", "too early"});
    expectRefused("solid a\n" + replaced(one, "endfacet\n", "") + one, {"line 8", "facet 1", "endfacet"});
    expectRefused("solid a\n" + replaced(one, "endloop", "vertex 1 1 0\nendloop") + "endsolid\n",
                  {"facet 1", "4 vertices"});
    expectRefused("solid a\nfacet normal 0 0 1\nvertex 1,5 0 0\n", {"line 3", "'1,5'"});
    expectRefused("solid a\nfacet normal 0 0 1\nvertex 1 0\n", {"line 3", "three coordinates"});
    expectRefused("solid a\nendsolid\n", {"no facets"});
    expectRefused("sol", {"neither"});
    const std::string whole = binary("binary");
    expectRefused(whole.substr(0, whole.size() - 1), {"too early", "12 triangles", "684", "683"});
    for (std::size_t length = 0; length < whole.size(); ++length)
    {
        MeshFile mesh;
        EXPECT_NE(readStl(whole.substr(0, length), mesh), "") << length;
    }
}
}  // namespace drape::test
