// glTF files of both versions, as text and binary. Files that other readers open are accepted, and damage is refused.
#include <gtest/gtest.h>

#include "mesh_io/readers.h"
#include "tests/mesh_io/box.h"

namespace drape::test
{
namespace
{
// Indices as shorts (72 bytes), then positions as floats (96 bytes).
std::string boxData()
{
    std::string bytes;
    for (std::int32_t corner : boxCorners())
        bytes += bytesOf(std::uint16_t(corner));
    for (const auto& v : kBoxVertices)
        for (int coordinate : v)
            bytes += bytesOf(float(coordinate));
    return bytes;
}

const std::string kViews =
    "'bufferViews':[{'buffer':0,'byteOffset':0,'byteLength':72},{'buffer':0,'byteOffset':72,'byteLength':96}],";
const std::string kAccessors =
    "'accessors':[{'bufferView':0,'componentType':5123,'count':36,'type':'SCALAR'},"
    "{'bufferView':1,'componentType':5126,'count':8,'type':'VEC3'}],";
const std::string kNodes = "'scene':0,'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0}],";
const std::string kMeshes = "'meshes':[{'primitives':[{'attributes':{'POSITION':1},'indices':0}]}],";
const std::string kRest = "'asset':{'version':'2.0'}}";

std::string json(const std::string& text)
{
    return replaced(text, "'", "\"");
}

std::string box(const std::string& buffers, const std::string& more = "")
{
    return "{" + more + buffers + kViews + kAccessors + kNodes + kMeshes + kRest;
}

const std::string kBinBuffer = "'buffers':[{'byteLength':168}],";

std::string glb(const std::string& text, const std::string& data, bool padded = true)
{
    std::string content = json(text);
    while (padded && content.size() % 4 != 0)
        content += ' ';
    const auto number = [](std::size_t value) { return bytesOf(std::uint32_t(value)); };
    return "glTF" + number(2) + number(28 + content.size() + data.size()) + number(content.size()) + "JSON" + content +
           number(data.size()) + std::string("BIN\0", 4) + data;
}

std::string noBuffer(const std::string&, std::string&)
{
    return "no such file";
}

MeshFile readGood(const std::string& bytes, bool binary = true)
{
    MeshFile mesh;
    EXPECT_EQ(binary ? readGlb(bytes, noBuffer, mesh) : readGltf(bytes, noBuffer, mesh), "");
    return mesh;
}

void expectRefused(const std::string& text, const std::vector<std::string>& words)
{
    MeshFile mesh;
    expectProblem(readGlb(glb(text, boxData()), noBuffer, mesh), words);
}
}  // namespace

TEST(GltfReader, ReadsBinary)
{
    const std::string text = box(kBinBuffer), plain = glb(text, boxData());
    expectIsBox(readGood(plain));
    for (int spaces = 0; spaces < 4; ++spaces)  // chunks of every length
        expectIsBox(readGood(glb(text + std::string(std::size_t(spaces), ' '), boxData(), false)));
    EXPECT_EQ(readGood(plain + "more").m_notes.size(), 1u);
    expectIsBox(readGood(glb(replaced(text, kRest, "'extras':0}"), boxData())));  // without an asset
    expectIsBox(readGood(glb(replaced(text, kNodes, ""), boxData())));            // meshes without nodes
    expectIsBox(readGood(glb(text + std::string(3, '\0'), boxData(), false)));    // padded with zero bytes
    expectIsBox(readGood(glb(replaced(text, "5126", "5126.0"), boxData())));
}

TEST(GltfReader, ReadsBuffersFromUris)
{
    const std::string data = boxData();
    std::string asked;
    const FindBuffer find = [&](const std::string& uri, std::string& bytes)
    {
        asked = uri;
        bytes = data;
        return std::string();
    };
    MeshFile mesh;
    const std::string buffer = "'buffers':[{'byteLength':168,'uri':'a%20box.bin'}],";
    ASSERT_EQ(readGltf(json(box(buffer)), find, mesh), "");
    EXPECT_EQ(asked, "a box.bin");
    expectIsBox(mesh);
    MeshFile none;
    EXPECT_NE(readGltf(json(box(buffer)), noBuffer, none).find("no such file"), std::string::npos);
}

TEST(GltfReader, ReadsDataUrisOfBase64)
{
    // Positions (−1 0 −1), (1 0 −1), (0 0 1) as floats, then indices 0 1 2 as shorts.
    for (const char* data : {"AACAvwAAAAAAAIC/AACAPwAAAAAAAIC/AAAAAAAAAAAAAIA/AAABAAIA",
                             "AACAvwAAAAAAAIC/AACAPwAAAAAAAIC/\\nAAAAAAAAAAAAAIA/AAABAAIAAA=="})
    {
        const std::string text =
            "{'buffers':[{'uri':'data:application/octet-stream;base64," + std::string(data) +
            "'}],'bufferViews':[{'buffer':0,'byteLength':36},{'buffer':0,'byteOffset':36,'byteLength':6}],"
            "'accessors':[{'bufferView':1,'componentType':5123,'count':3,'type':'SCALAR'},"
            "{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}]," +
            kNodes + kMeshes + kRest;
        const MeshFile mesh = readGood(json(text), false);
        EXPECT_EQ(mesh.m_positions, std::vector<double>({-1, 0, -1, 1, 0, -1, 0, 0, 1}));
        EXPECT_EQ(mesh.m_corners, std::vector<std::int32_t>({0, 1, 2}));
    }
}

TEST(GltfReader, ReadsVersionOne)
{
    std::string text =
        "{'buffers':{'binary_glTF':{'byteLength':168,'type':'arraybuffer'}},"
        "'bufferViews':{'i':{'buffer':'binary_glTF','byteOffset':0,'byteLength':72},"
        "'p':{'buffer':'binary_glTF','byteOffset':72,'byteLength':96}},"
        "'accessors':{'a':{'bufferView':'i','byteOffset':0,'byteStride':0,'componentType':5123,'count':36,"
        "'type':'SCALAR'},"
        "'b':{'bufferView':'p','byteOffset':0,'byteStride':12,'componentType':5126,'count':8,'type':'VEC3'}},"
        "'scene':'s','scenes':{'s':{'nodes':['n']}},'nodes':{'n':{'meshes':['m']}},"
        "'meshes':{'m':{'primitives':[{'attributes':{'POSITION':'b'},'indices':'a','mode':4}]}},"
        "'extensionsUsed':['KHR_binary_glTF']}";
    text = json(text);
    const auto number = [](std::size_t value) { return bytesOf(std::uint32_t(value)); };
    expectIsBox(readGood("glTF" + number(1) + number(20 + text.size() + 168) + number(text.size()) + number(0) + text +
                         boxData()));
}

TEST(GltfReader, AppliesTransformsInDouble)
{
    std::string text = replaced(box(kBinBuffer), "'nodes':[{'mesh':0}]",
                                "'nodes':[{'children':[1,2],'translation':[5000000.1,0,0]},"
                                "{'mesh':0,'scale':[2,2,2],'rotation':[0,0,1,0]},"
                                "{'mesh':0,'matrix':[1,0,0,0,0,1,0,0,0,0,1,0,0,7,0,1]}]");
    const MeshFile mesh = readGood(glb(text, boxData()));
    ASSERT_EQ(mesh.vertexCount(), 16u);
    EXPECT_DOUBLE_EQ(mesh.m_positions[0], 5000000.1 + 2);  // turned by half around z, and doubled
    EXPECT_DOUBLE_EQ(mesh.m_positions[1], 2);
    EXPECT_DOUBLE_EQ(mesh.m_positions[24], 5000000.1 - 1);
    EXPECT_DOUBLE_EQ(mesh.m_positions[25], 6);
    EXPECT_EQ(mesh.faceCount(), 24u);
    EXPECT_EQ(mesh.m_corners[36], mesh.m_corners[0] + 8);
}

TEST(GltfReader, TurnsTheWindingOfWhatIsMirrored)
{
    const std::string text = replaced(box(kBinBuffer), "{'mesh':0}", "{'mesh':0,'scale':[1,-1,1]}");
    const MeshFile mesh = readGood(glb(text, boxData()));
    std::vector<std::int32_t> corners = boxCorners();
    for (std::size_t i = 0; i < corners.size(); i += 3)
        std::swap(corners[i], corners[i + 1]);
    EXPECT_EQ(mesh.m_corners, corners);
}

TEST(GltfReader, TellsLongNamesApart)
{
    const std::string name(100, 'n');
    const std::string text =
        replaced(replaced(replaced(box(kBinBuffer), "'nodes':[{'mesh':0}]",
                                   "'nodes':{'" + name + "1':{'mesh':0},'" + name + "2':{'mesh':0}}"),
                          "'scenes':[{'nodes':[0]}]", "'scenes':[{}]"),
                 "'scene':0,", "");
    EXPECT_EQ(readGood(glb(text, boxData())).faceCount(), 24u);
}

TEST(GltfReader, ReadsStripsFansAndFacesWithoutIndices)
{
    const auto cornersOf = [](const std::string& primitive)
    {
        const std::string text = replaced(box(kBinBuffer), "'attributes':{'POSITION':1},'indices':0", primitive);
        return readGood(glb(text, boxData()));
    };
    const MeshFile soup = cornersOf("'attributes':{'POSITION':1}");
    EXPECT_EQ(soup.m_corners, std::vector<std::int32_t>({0, 1, 2, 3, 4, 5}));  // two vertices are left over
    EXPECT_FALSE(soup.m_hasIndices);
    const MeshFile strip = cornersOf("'attributes':{'POSITION':1},'mode':5");
    EXPECT_EQ(strip.m_corners, std::vector<std::int32_t>({0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 5, 4, 5, 6, 6, 5, 7}));
    const MeshFile fan = cornersOf("'attributes':{'POSITION':1},'mode':6");
    EXPECT_EQ(fan.m_corners, std::vector<std::int32_t>({0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5, 0, 5, 6, 0, 6, 7}));
    EXPECT_EQ(cornersOf("'attributes':{'POSITION':1},'mode':1").faceCount(), 0u);
    // Primitives with the same positions share vertices.
    EXPECT_EQ(
        cornersOf("'attributes':{'POSITION':1},'indices':0},{'attributes':{'POSITION':1},'indices':0").vertexCount(),
        8u);
}

TEST(GltfReader, ReadsQuantizedAndSparsePositions)
{
    const std::string shorts = replaced(box(kBinBuffer, "'extensionsRequired':['KHR_mesh_quantization'],"),
                                        "5126,'count':8", "5122,'count':8");
    EXPECT_EQ(readGood(glb(shorts, boxData())).m_positions[1], double(std::int16_t(0xbf80)));
    const MeshFile normalized = readGood(glb(replaced(shorts, "5122,", "5122,'normalized':true,"), boxData()));
    EXPECT_DOUBLE_EQ(normalized.m_positions[1], std::int16_t(0xbf80) / 32767.0);
    // Row 2 of zeros becomes the first of the box's positions; index 2 is the second short (3 2 1 …).
    const MeshFile sparse = readGood(
        glb(replaced(box(kBinBuffer), "{'bufferView':1,'componentType':5126,'count':8,'type':'VEC3'}",
                     "{'componentType':5126,'count':8,'type':'VEC3','sparse':{'count':1,"
                     "'indices':{'bufferView':0,'byteOffset':2,'componentType':5123},'values':{'bufferView':1}}}"),
            boxData()));
    ASSERT_EQ(sparse.m_positions.size(), 24u);
    for (std::size_t i = 0; i < 24; ++i)
        EXPECT_EQ(sparse.m_positions[i], i / 3 == 2 ? kBoxVertices[0][i % 3] : 0);
}

TEST(GltfReader, ReadsPastExtensionsOfLooks)
{
    for (const char* extension : {"KHR_materials_unlit", "KHR_texture_transform", "KHR_lights_punctual",
                                  "EXT_texture_webp", "MSFT_texture_dds"})
        expectIsBox(
            readGood(glb(box(kBinBuffer, "'extensionsRequired':['" + std::string(extension) + "'],"), boxData())));
    for (const char* extension : {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "EXT_mesh_gpu_instancing"})
        expectRefused(box(kBinBuffer, "'extensionsRequired':['" + std::string(extension) + "'],"), {extension});
}

TEST(GltfReader, RefusesDamage)
{
    const std::string text = box(kBinBuffer);
    for (const char* type : {"SCALAR", "VEC2", "VEC4"})
        expectRefused(replaced(text, "VEC3", type), {"accessor 1", "VEC3"});
    expectRefused(replaced(text, "5126", "5124"), {"accessor 1", "componentType"});
    expectRefused(replaced(text, "'count':8", "'count':9"), {"accessor 1", "9 elements", "96 bytes"});
    expectRefused(replaced(text, "'count':8", "'count':4e15"), {"accessor 1", "do not fit"});
    expectRefused(replaced(text, "'count':8", "'count':-8"), {"accessor 1", "whole number"});
    expectRefused(replaced(text, "'count':8", "'count':7"), {"mesh 0", "primitive 0", "index 7", "7 vertices"});
    expectRefused(replaced(text, "'byteLength':96", "'byteLength':97"), {"accessor 1", "169"});
    expectRefused(replaced(text, "'byteLength':168", "'byteLength':169"), {"buffer 0", "169 bytes", "168"});
    expectRefused(replaced(text, "'bufferView':1,", "'bufferView':5,"), {"accessor 1", "bufferView"});
    expectRefused(replaced(text, "'bufferView':1,", ""), {"accessor 1", "no data"});
    expectRefused(replaced(text, "'POSITION':1", "'POSITION':9"), {"accessor 9", "does not exist"});
    expectRefused(replaced(text, "'nodes':[0]", "'nodes':[3]"), {"node 3", "out of range"});
    expectRefused(replaced(text, "{'mesh':0}", "{'mesh':4}"), {"mesh 4", "out of range"});
    expectRefused(replaced(text, "{'mesh':0}", "{'children':[0]}"), {"two parents"});
    expectRefused(replaced(text, "{'mesh':0}", "{'mesh':0,'scale':[1,'a',1]}"), {"node 0", "transform"});
    expectRefused(replaced(text, "'indices':0", "'indices':1"), {"accessor 1", "SCALAR"});
    expectRefused(text.substr(0, text.size() - 1), {"not all of it"});
    expectRefused("[]", {"not the JSON of glTF"});
}

TEST(GltfReader, BoundsWhatAFileSaysItHolds)
{
    const std::string text = box(kBinBuffer);
    const std::string zeros =
        replaced(text, "'bufferView':1,",
                 "'sparse':{'count':1,'indices':{'bufferView':0,'componentType':5123},'values':{'bufferView':1}},");
    expectRefused(replaced(zeros, "'count':8", "'count':9000000000"), {"accessor 1", "without data"});
    // The nodes repeat a mesh of a million vertices that do not exist.
    std::string nodes = "'nodes':[{'mesh':0}", roots = "0";
    for (int i = 1; i < 100; ++i)
    {
        nodes += ",{'mesh':0}";
        roots += "," + std::to_string(i);
    }
    expectRefused(replaced(replaced(replaced(zeros, "'count':8", "'count':1000000"), "'nodes':[{'mesh':0}", nodes),
                           "'scenes':[{'nodes':[0]}]", "'scenes':[{'nodes':[" + roots + "]}]"),
                  {"repeat"});
    MeshFile mesh;
    EXPECT_NE(readGltf(std::string(200000, '['), noBuffer, mesh).find("deeper"), std::string::npos);
    std::string chain = "{\"nodes\":[{}";
    for (int node = 0; node < 20000; ++node)
        chain += ",{\"children\":[" + std::to_string(node) + "]}";
    EXPECT_NE(readGltf(chain + "]}", noBuffer, mesh).find("deeper"), std::string::npos);
}

TEST(GltfReader, RefusesBinaryFilesThatEndTooEarly)
{
    const std::string whole = glb(box(kBinBuffer), boxData());
    for (std::size_t length = 0; length < whole.size(); ++length)
    {
        MeshFile mesh;
        EXPECT_NE(readGlb(whole.substr(0, length), noBuffer, mesh), "") << length;
    }
    std::string newer = whole;
    newer[4] = 3;
    MeshFile mesh;
    EXPECT_NE(readGlb(newer, noBuffer, mesh).find("version 3"), std::string::npos);
}
}  // namespace drape::test
