// OBJ files. Files that other readers open are accepted, and every refusal has a true reason.
#include <gtest/gtest.h>

#include "mesh_io/readers.h"
#include "tests/mesh_io/box.h"

namespace drape::test
{
namespace
{
const std::string kVertices = boxVertexLines("v "), kFaces = boxFaceLines("f", 1);

void expectBox(const std::string& text)
{
    MeshFile mesh;
    EXPECT_EQ(readObj(text, mesh), "");
    expectIsBox(mesh);
    EXPECT_TRUE(mesh.m_hasIndices);
}

void expectRefused(const std::string& text, const std::vector<std::string>& words)
{
    MeshFile mesh;
    expectProblem(readObj(text, mesh), words);
}
}  // namespace

TEST(ObjReader, ReadsIndicesOfTextureCoordinatesAndNormalsThatAreNotThere)
{
    for (const char* corner : {"%", "%/%", "%/%/%", "%//%", "%/", "%//", "%/%/1", "%/99/-7"})
    {
        SCOPED_TRACE(corner);
        expectBox(kVertices + "vn 0 0 1\n" + boxFaceLines("f", 1, corner));
    }
}

TEST(ObjReader, ReadsWhatOtherReadersOpen)
{
    const std::string plain = kVertices + kFaces;
    expectBox(plain);
    expectBox("\xef\xbb\xbf" + plain);
    expectBox(replaced(plain, "\n", " \t\r\n"));
    expectBox(replaced(plain, "\n", "\r"));
    expectBox(plain.substr(0, plain.size() - 1));  // no line end at the end
    expectBox("  # a comment\n\n" + replaced(plain, "\n", " # more\n"));
    expectBox(kVertices + boxFaceLines("f", -8));
    expectBox(kVertices + replaced(kFaces, "f ", "f \\\n \\\r\n"));
    expectBox(kVertices + replaced(kFaces, "f ", "fo\t"));
    expectBox(kFaces + kVertices);  // vertices may come after their faces
    expectBox(boxVertexLines("v ", " 1.0\n") + kFaces);
    expectBox(boxVertexLines("v ", " 0.5 0.5 0.5\n") + kFaces);
    expectBox(boxVertexLines("v ", " 1.0 0.5 0.5 0.5\n") + kFaces);
    expectBox(replaced(kVertices, "1", "1.e0") + kFaces);
    expectBox(replaced(kVertices, "1", "01.0E+00") + kFaces);
    expectBox(replaced(kVertices, "1", "0.1D+01") + kFaces);
    expectBox(plain + "l 1 2\np 3\ncurv 0 1 1 2\nvp 0.5\n");
    // A path that ends with a backslash does not swallow the next line.
    expectBox("# C:\\models\\\nusemtl C:\\\no box\ng a b\ns off\n" + plain);
}

TEST(ObjReader, KeepsDoublePrecisionAndEveryDigit)
{
    MeshFile mesh;
    ASSERT_EQ(readObj("v 5400000.123456789 .5 -.25\nv +1 2. 1e-5\nv 0 0 4.9e-324\nf 1 2 3\n", mesh), "");
    EXPECT_EQ(mesh.m_positions, std::vector<double>({5400000.123456789, 0.5, -0.25, 1, 2, 1e-5, 0, 0, 4.9e-324}));
}

TEST(ObjReader, KeepsPolygons)
{
    MeshFile mesh;
    ASSERT_EQ(readObj(kVertices + "f 1 2 3 4\nf 5 6 7 8 1\n", mesh), "");
    EXPECT_EQ(mesh.m_faceEnds, std::vector<std::size_t>({4, 9}));
}

TEST(ObjReader, LeavesOutFacesWithoutSurfaceAndSaysSo)
{
    MeshFile mesh;
    ASSERT_EQ(readObj(kVertices + "f 1 2\n" + kFaces + "f 1\nf\nf 1/1 # 2 3\n", mesh), "");
    EXPECT_EQ(mesh.m_corners, boxCorners());
    ASSERT_EQ(mesh.m_notes.size(), 1u);
    EXPECT_NE(mesh.m_notes[0].find("4 faces"), std::string::npos) << mesh.m_notes[0];
}

TEST(ObjReader, RefusesDamage)
{
    expectRefused(kVertices + kFaces + "f 1 2 99\n", {"line 21", "99", "8 vertices"});
    expectRefused("f 1 2 99\n" + kVertices + kFaces, {"line 1", "99", "8 vertices"});
    expectRefused(kVertices + "f 1 2 -9\n", {"line 9", "-9"});
    expectRefused(kVertices + "f 1 2 0\n", {"line 9", "index 0"});
    expectRefused(kVertices + "f 1 2 99999999999999999999\n", {"line 9", "out of range"});
    expectRefused(kVertices + "f 1 2 x\n", {"line 9", "'x' is not a whole number"});
    expectRefused(kVertices + "f 1 2 3.5\n", {"line 9", "'3.5'"});
    expectRefused("v 1 0\n", {"line 1", "vertex 1", "fewer than three"});
    expectRefused("v 1,5 0 0\n", {"vertex 1", "'1,5' is not a decimal number"});
    expectRefused("v 1D 0 0\n", {"'1D' is not a decimal number"});
    expectRefused("v 0x1p0 0 0\n", {"'0x1p0' is not a decimal number"});
    expectRefused(kVertices + kFaces + "f 1 2", {"line 21", "ends within a face"});
    expectRefused(kVertices + kFaces + "v 1 2", {"line 21", "fewer than three"});
    expectRefused(std::string("v 0 0 0\n\0", 9), {"zero bytes"});
    expectRefused("Dear reader,\n", {"no vertices"});
}
}  // namespace drape::test
