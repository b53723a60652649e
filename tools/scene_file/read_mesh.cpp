#include <filesystem>

#include "scenes/mesh_loader.h"
#include "tools/scene_file/scene_parts.h"

namespace drape
{
namespace
{
void readFile(const JsonObject& object, SceneContext& context, TriangleMesh& mesh)
{
    const std::filesystem::path given = object.at("file").text();
    const std::string path = given.is_absolute() || context.m_folder.empty()
                                 ? given.string()
                                 : (std::filesystem::path(context.m_folder) / given).string();
    bool join = true;
    object.read("join", join);
    LoadReport report;
    std::string error;
    if (!loadMesh(path, join ? Joining::ByPosition : Joining::ByIndex, mesh, report, error))
        object.at("file").fail(error);
    context.m_file->m_meshes.push_back(path);
    for (const std::string& note : report.m_notes)
        context.m_file->m_notes.push_back(note);
}

void readArrays(const JsonObject& object, TriangleMesh& mesh)
{
    const JsonValue positions = object.at("positions"), triangles = object.at("triangles");
    for (const double coordinate : positions.numbers(kCoordinate))
        mesh.m_positions.push_back(float(coordinate));
    if (mesh.m_positions.size() < 9 || mesh.m_positions.size() % 3 != 0)
        positions.refuse("three numbers for each of three or more vertices");
    const int most = int(mesh.vertexCount()) - 1;
    triangles.each(3, [&](const JsonValue& item) { mesh.m_triangles.push_back(item.whole(0, most)); });
    if (mesh.m_triangles.size() % 3 != 0) triangles.refuse("three vertices for each triangle");
    for (std::size_t t = 0; t < mesh.m_triangles.size(); t += 3)
    {
        const std::int32_t* const corners = &mesh.m_triangles[t];
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
            triangles.fail("triangle " + std::to_string(t / 3) + " repeats a vertex");
    }
}
}  // namespace

const std::vector<std::string> kMeshKeys = {"type", "file", "join", "positions", "triangles", "scale", "fit"};

TriangleMesh readMesh(const JsonObject& object, SceneContext& context)
{
    TriangleMesh mesh;
    object.exclude("file", "positions", "a mesh comes from a file or from arrays");
    object.exclude("file", "triangles", "a mesh comes from a file or from arrays");
    object.exclude("scale", "fit", "'fit' determines the scale");
    if (object.has("file"))
        readFile(object, context, mesh);
    else if (object.has("positions") || object.has("triangles"))
        readArrays(object, mesh);
    else
        object.value().fail("a mesh needs 'file', or 'positions' and 'triangles'");
    if (object.has("join") && !object.has("file")) object.at("join").fail("only a mesh from a file has it");
    if (!(boundsOf(mesh).largestExtent() > 0)) object.value().fail("the mesh has no extent");
    double scale = 1, fit = 0;
    object.read("scale", scale, {1e-6, 1e6});
    object.read("fit", fit, kLength);
    if (scale != 1)
        for (float& coordinate : mesh.m_positions)
            coordinate = float(scale * double(coordinate));
    if (fit > 0) placeOnFloor(mesh, float(fit));
    return mesh;
}
}  // namespace drape
