// PLY files in the three encodings. Files that other readers open are accepted, and damage is refused.
#include <gtest/gtest.h>

#include "mesh_io/readers.h"
#include "tests/mesh_io/box.h"

namespace drape::test
{
namespace
{
const std::string kCoordinates = "property float x\nproperty float y\nproperty float z\n";
const std::string kFaces = "element face 12\nproperty list uchar int vertex_indices\n";

std::string header(const std::string& format, const std::string& vertices = kCoordinates,
                   const std::string& faces = kFaces)
{
    return "ply\nformat " + format + " 1.0\nelement vertex 8\n" + vertices + faces + "end_header\n";
}

const std::string kText = header("ascii") + boxVertexLines("") + boxFaceLines("3", 0);

std::string binary(bool bigEndian)
{
    std::string bytes = header(bigEndian ? "binary_big_endian" : "binary_little_endian");
    for (const auto& v : kBoxVertices)
        for (int coordinate : v)
            bytes += bytesOf(float(coordinate), bigEndian);
    for (const auto& triangle : kBoxTriangles)
    {
        bytes += '\3';
        for (int index : triangle)
            bytes += bytesOf(std::int32_t(index), bigEndian);
    }
    return bytes;
}

MeshFile expectBox(const std::string& text)
{
    MeshFile mesh;
    EXPECT_EQ(readPly(text, mesh), "");
    expectIsBox(mesh);
    return mesh;
}

void expectRefused(const std::string& text, const std::vector<std::string>& words)
{
    MeshFile mesh;
    expectProblem(readPly(text, mesh), words);
}
}  // namespace

TEST(PlyReader, ReadsEveryEncoding)
{
    for (const std::string& bytes : {kText, binary(false), binary(true)})
        EXPECT_TRUE(expectBox(bytes).m_notes.empty());
    // The header's lines end like its first line, whatever byte the data begins with.
    for (bool bigEndian : {false, true})
        for (const char* end : {"\r\n", "\r"})
        {
            const std::string bytes = binary(bigEndian);
            const std::size_t body = bytes.find("end_header\n") + 11;
            expectBox(replaced(bytes.substr(0, body), "\n", end) + bytes.substr(body));
        }
}

TEST(PlyReader, ReadsWhatOtherReadersOpen)
{
    expectBox(replaced(kText, "\n", "\r\n"));
    expectBox(replaced(kText, "\n", "\r"));
    expectBox(kText.substr(0, kText.size() - 1));
    expectBox(replaced(kText, "vertex_indices", "vertex_index"));
    expectBox(replaced(kText, "element vertex", "made by some exporter\ncomment\nobj_info 3\nelement vertex"));
    expectBox(header("ascii") + boxVertexLines("") + boxFaceLines("3", 0, "%", " 6 0 0 1 0 1 1 9 1 1 1\n"));
    expectBox(replaced(header("ascii"), "float", "double") + boxVertexLines("") + boxFaceLines("3", 0));
    // Properties and elements of other meaning.
    expectBox(header("ascii", "property float nx\n" + kCoordinates + "property list uchar int others\n",
                     "element camera 1\nproperty float f\nelement empty 7\n" + kFaces + "property uchar flags\n") +
              boxVertexLines("0 ", " 2 5 5\n") + "0.5\n" + boxFaceLines("3", 0, "%", " 1\n"));
    // Lines that are broken elsewhere: as many numbers as the header says.
    expectBox(header("ascii") + replaced(boxVertexLines("") + boxFaceLines("3", 0), "\n", " "));
    expectBox(header("ascii") + replaced(boxVertexLines(" ") + boxFaceLines("3", 0), " ", "\n"));
}

TEST(PlyReader, ReadsTriangleStrips)
{
    const std::string strips = "element tristrips 1\nproperty list int int vertex_indices\n";
    std::string list = std::to_string(4 * 12);
    for (const auto& t : kBoxTriangles)
        list += " " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + " -1";
    expectBox(header("ascii", kCoordinates, strips) + boxVertexLines("") + list + "\n");
    MeshFile mesh;
    ASSERT_EQ(readPly(header("ascii", kCoordinates, strips) + boxVertexLines("") + "8 0 1 2 3 4 -1 5 6\n", mesh), "");
    EXPECT_EQ(mesh.m_corners, std::vector<std::int32_t>({0, 1, 2, 2, 1, 3, 2, 3, 4}));
}

TEST(PlyReader, SaysWhatItLeavesOut)
{
    for (const std::string& more : {std::string("3 0 1 2\n"), std::string("and so on\n")})
        EXPECT_EQ(expectBox(kText + more).m_notes.size(), 1u);
    EXPECT_EQ(expectBox(binary(false) + "more").m_notes.size(), 1u);
    EXPECT_TRUE(expectBox(kText + " \r\n\n").m_notes.empty());
    const std::string thirteen = replaced(header("ascii"), "face 12", "face 13");
    EXPECT_EQ(expectBox(thirteen + boxVertexLines("") + "2 0 1\n" + boxFaceLines("3", 0)).m_notes.size(), 1u);
}

TEST(PlyReader, RefusesWhatEndsTooEarly)
{
    const std::string little = binary(false), big = binary(true);
    for (const std::string& whole : {kText, little, big})
        for (std::size_t length = 0; length + 2 < whole.size(); ++length)
        {
            MeshFile mesh;
            EXPECT_NE(readPly(whole.substr(0, length), mesh), "") << length << " bytes of " << whole.size();
        }
}

TEST(PlyReader, RefusesDamage)
{
    expectRefused(replaced(kText, "3 3 2 1", "3 3 2 8"), {"face 1", "index 8 is out of range", "8 vertices"});
    expectRefused(replaced(kText, "3 3 2 1", "3 3 2 -1"), {"face 1", "index -1"});
    expectRefused(replaced(kText, "3 3 2 1", "3 3 2 1.5"), {"face 1", "1.5"});
    expectRefused(replaced(kText, "3 3 2 1", "4 3 2 1"), {"face 1", "line 18", "ends too early"});
    expectRefused(replaced(kText, "-1 -1 1\n", "-1 x 1\n"), {"vertex 1", "line 10", "'x'"});
    expectRefused(replaced(kText, "float y", "float v"), {"no y"});
    expectRefused(replaced(kText, "vertex_indices", "corners"), {"face", "vertex_indices"});
    expectRefused(replaced(kText, "format ascii", "format morse"), {"morse"});
    expectRefused(replaced(kText, "float y", "fload y"), {"line 5", "fload"});
    expectRefused(replaced(kText, "element face 12", "element face 0"), {"no triangles"});
    // A misspelt keyword hides a property: then every number has to be accounted for.
    const std::string more = header("ascii", "propery float nx\n" + kCoordinates);
    expectRefused(more + boxVertexLines("0 ") + boxFaceLines("3", 0), {"vertex 1", "more numbers"});
    expectRefused(replaced(binary(false), "property float x", "propery float n\nproperty float x") + "more",
                  {"do not match"});
    // Counts that the file cannot hold take no memory.
    expectRefused(replaced(binary(false), "face 12", "face 999999999999999999"), {"ends too early"});
    expectRefused(replaced(kText, "vertex 8", "vertex 2147483647"), {"too early"});
    expectRefused("ply\nformat ascii 1.0\nelement", {"does not end"});
    expectRefused("letter\n", {"no PLY header"});
}
}  // namespace drape::test
