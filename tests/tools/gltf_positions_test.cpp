// glTF files whose positions Assimp would take for others: only those of three floats are read.
#include <gtest/gtest.h>

#include "scenes/mesh_loader.h"
#include "tests/tools/tool.h"

namespace drape::test
{
namespace
{
using GltfPositions = ToolTest;

// A triangle's positions as VEC3 of floats, then its indices 0 1 2 as shorts.
constexpr const char* kTriangle = "AACAvwAAAAAAAIC/AACAPwAAAAAAAIC/AAAAAAAAAAAAAIA/AAABAAIA";

std::string gltf(const std::string& componentType, const std::string& type, const std::string& more = "")
{
    return "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}]," +
           more +
           "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}],"
           "\"buffers\":[{\"byteLength\":42,\"uri\":\"data:application/octet-stream;base64," +
           kTriangle +
           "\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},"
           "{\"buffer\":0,\"byteOffset\":36,\"byteLength\":6}],"
           "\"accessors\":[{\"bufferView\":0,\"componentType\":" +
           componentType + ",\"count\":3,\"type\":\"" + type +
           "\"},{\"bufferView\":1,\"componentType\":5123,\"count\":3,\"type\":\"SCALAR\"}]}";
}

std::string glb(const std::string& text)
{
    return "glTF" + littleEndian(2) + littleEndian(std::uint32_t(text.size()) + 20) +
           littleEndian(std::uint32_t(text.size())) + "JSON" + text;
}

std::string requiring(const std::string& extension)
{
    return "\"extensionsRequired\":[\"" + extension + "\"],";
}
}  // namespace

TEST_F(GltfPositions, ofThreeFloatsAreRead)
{
    for (const std::string& more : {std::string(), requiring("KHR_materials_unlit"), requiring("KHR_texture_transform"),
                                    requiring("KHR_lights_punctual")})
    {
        SCOPED_TRACE(more);
        TriangleMesh mesh;
        std::string error;
        ASSERT_TRUE(loadMesh(write("good.gltf", gltf("5126", "VEC3", more)), mesh, error)) << error;
        EXPECT_EQ(mesh.m_positions, std::vector<float>({-1, 0, -1, 1, 0, -1, 0, 0, 1}));
    }
}

TEST_F(GltfPositions, ofAnotherTypeAreRefused)
{
    for (const char* type : {"5120", "5121", "5122", "5123", "5125", "5126.0"})
    {
        SCOPED_TRACE(type);
        const std::string text = gltf(type, "VEC3");
        expectRefused(runSmall({"--obstacle", write("bad.gltf", text)}), {"bad.gltf", "accessor 0", "floats"});
        expectRefused(runSmall({"--obstacle", write("bad.glb", glb(text))}), {"bad.glb", "accessor 0", "floats"});
    }
    for (const char* type : {"SCALAR", "VEC2", "VEC4"})
        expectRefused(runSmall({"--obstacle", write("bad.gltf", gltf("5126", type))}), {"bad.gltf", "VEC3"});
}

// Version 1 has names where version 2 has numbers.
TEST_F(GltfPositions, ofAnotherTypeAreRefusedByName)
{
    const std::string text =
        "{\"meshes\":{\"m\":{\"primitives\":[{\"attributes\":{\"POSITION\":\"a\"}}]}},"
        "\"accessors\":{\"a\":{\"componentType\":5122,\"type\":\"VEC3\"}}}";
    expectRefused(runSmall({"--obstacle", write("old.gltf", text)}), {"old.gltf", "accessor \"a\"", "floats"});
}

TEST_F(GltfPositions, changedByAnExtensionAreRefused)
{
    for (const char* extension : {"KHR_mesh_quantization", "EXT_meshopt_compression", "EXT_mesh_gpu_instancing"})
    {
        const std::string text = gltf("5126", "VEC3", requiring(extension));
        expectRefused(runSmall({"--obstacle", write("bad.gltf", text)}), {"bad.gltf", extension});
        expectRefused(runSmall({"--obstacle", write("bad.glb", glb(text))}), {"bad.glb", extension});
    }
}
}  // namespace drape::test
