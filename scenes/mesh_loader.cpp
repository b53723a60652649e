#include "scenes/mesh_loader.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <sstream>

#include <assimp/BaseImporter.h>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include "scenes/mesh_scan.h"
#include "scenes/read_file.h"

namespace drape
{
namespace
{
std::string endingOf(const std::string& path)
{
    std::string ending = std::filesystem::path(path).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
    return ending;
}

std::string oneLine(std::string text)
{
    for (char& c : text)
        if (c == '\n' || c == '\r') c = ' ';
    while (!text.empty() && text.back() == ' ')
        text.pop_back();
    return text;
}

std::string appendMesh(const aiMesh& part, const aiMatrix4x4& toWorld, TriangleMesh& mesh)
{
    const std::size_t first = mesh.vertexCount();
    for (unsigned int v = 0; v < part.mNumVertices; ++v)
    {
        const aiVector3D position = toWorld * part.mVertices[v];
        for (const float value : {position.x, position.y, position.z})
        {
            const std::string problem = coordinateProblem(static_cast<double>(value));
            if (!problem.empty()) return "vertex " + std::to_string(first + v + 1) + ": " + problem;
            mesh.m_positions.push_back(value);
        }
    }
    for (unsigned int f = 0; f < part.mNumFaces; ++f)
    {
        const aiFace& face = part.mFaces[f];
        if (face.mNumIndices != 3) continue;  // points and lines carry no surface
        for (int corner = 0; corner < 3; ++corner)
            mesh.m_triangles.push_back(static_cast<std::int32_t>(first + face.mIndices[corner]));
    }
    return "";
}

std::string appendNode(const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent, TriangleMesh& mesh)
{
    const aiMatrix4x4 toWorld = parent * node.mTransformation;
    for (unsigned int i = 0; i < node.mNumMeshes; ++i)
    {
        const std::string problem = appendMesh(*scene.mMeshes[node.mMeshes[i]], toWorld, mesh);
        if (!problem.empty()) return problem;
    }
    for (unsigned int i = 0; i < node.mNumChildren; ++i)
    {
        const std::string problem = appendNode(scene, *node.mChildren[i], toWorld, mesh);
        if (!problem.empty()) return problem;
    }
    return "";
}

// Assimp drops glTF faces with bad indices and only says so in its log: listens to that while it lives.
class LogListener
{
public:
    LogListener()
    {
        Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0);
        Assimp::DefaultLogger::get()->attachStream(new Stream(m_problem), Assimp::Logger::Warn | Assimp::Logger::Err);
    }
    ~LogListener() { Assimp::DefaultLogger::kill(); }  // the logger owns the stream
    LogListener(const LogListener&) = delete;
    LogListener& operator=(const LogListener&) = delete;

    // "" or what was dropped.
    const std::string& problem() const { return m_problem; }

private:
    struct Stream : Assimp::LogStream
    {
        explicit Stream(std::string& problem) : m_problem(problem) {}
        void write(const char* message) override
        {
            const std::string text = message;
            if (text.find("out-of-range") != std::string::npos || text.find("out of range") != std::string::npos)
                m_problem = "face index is out of range";
        }
        std::string& m_problem;
    };
    std::string m_problem;
};

// What Assimp's steps after reading take for granted, with an assertion: every face has a corner, and each is a vertex.
std::string faceProblem(const aiScene& scene)
{
    for (unsigned int m = 0; m < scene.mNumMeshes; ++m)
    {
        const aiMesh& part = *scene.mMeshes[m];
        for (unsigned int f = 0; f < part.mNumFaces; ++f)
        {
            const aiFace& face = part.mFaces[f];
            if (face.mNumIndices == 0) return "face " + std::to_string(f + 1) + ": no corners";
            for (unsigned int corner = 0; corner < face.mNumIndices; ++corner)
                if (face.mIndices[corner] >= part.mNumVertices)
                    return "face " + std::to_string(f + 1) + ": index " + std::to_string(face.mIndices[corner]) +
                           " is out of range (" + std::to_string(part.mNumVertices) + " vertices)";
        }
    }
    return "";
}

bool reads(const aiImporterDesc& reader, const std::string& ending)
{
    std::istringstream endings(reader.mFileExtensions);
    for (std::string known; endings >> known;)
        if ("." + known == ending) return true;
    return false;
}

// A file is what its ending says: Assimp would go by its content where no reader of that ending wants it, past what is
// looked through here before.
void keepReadersOf(const std::string& ending, Assimp::Importer& importer)
{
    for (std::size_t i = importer.GetImporterCount(); i-- > 0;)
    {
        if (reads(*importer.GetImporterInfo(i), ending)) continue;
        Assimp::BaseImporter* reader = importer.GetImporter(i);
        importer.UnregisterLoader(reader);
        delete reader;  // unregistered, it is the caller's
    }
}

// `bytes` stand for the file's own where there are any.
std::string importMesh(const std::string& path, const std::string& bytes, TriangleMesh& mesh)
{
    const LogListener listener;
    Assimp::Importer importer;
    const std::string ending = endingOf(path);
    keepReadersOf(ending, importer);
    const aiScene* scene = bytes.empty()
                               ? importer.ReadFile(path, 0)
                               : importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, ending.c_str() + 1);
    if (!listener.problem().empty()) return listener.problem();
    const std::string problem = scene == nullptr ? "" : faceProblem(*scene);
    if (!problem.empty()) return problem;
    if (scene != nullptr) scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
    if (scene == nullptr || scene->mRootNode == nullptr) return "not a mesh: " + oneLine(importer.GetErrorString());
    return appendNode(*scene, *scene->mRootNode, aiMatrix4x4(), mesh);
}

// The mesh as the file has it, or why it cannot be had. `structure`, where it is given, gets that of an OBJ file.
std::string readMesh(const std::string& path, TriangleMesh& mesh, std::string* structure = nullptr)
{
    std::string bytes;
    std::string problem = readWholeFile(path, "mesh", bytes);
    const std::string ending = endingOf(path);
    if (problem.empty() && ending == ".obj") problem = scanObj(bytes);
    if (problem.empty() && ending == ".ply") problem = scanPly(bytes);
    if (problem.empty() && ending == ".stl") problem = scanStl(bytes);
    if (problem.empty() && ending == ".glb") problem = scanGlb(bytes);
    if (problem.empty() && ending == ".gltf") problem = scanGltf(bytes);
    if (problem.empty()) problem = importMesh(path, ending == ".ply" ? plyWithLineEnd(bytes) : "", mesh);
    if (structure && ending == ".obj") *structure = objStructure(bytes);
    return problem.empty() ? "" : path + ": " + problem;
}
}  // namespace

bool loadMesh(const std::string& path, TriangleMesh& mesh, std::string& error)
{
    TriangleMesh loaded;
    std::string problem = readMesh(path, loaded);
    if (problem.empty()) joinVertices(loaded);
    if (problem.empty() && loaded.triangleCount() == 0) problem = path + ": no triangles";
    if (problem.empty())
        mesh = std::move(loaded);
    else
        error = problem;
    return problem.empty();
}

bool loadMotion(const std::string& startPath, const std::string& endPath, TriangleMesh& mesh, std::vector<float>& end,
                std::string& error)
{
    TriangleMesh first, last;
    std::string firstStructure, lastStructure;
    std::string problem = readMesh(startPath, first, &firstStructure);
    if (problem.empty()) problem = readMesh(endPath, last, &lastStructure);
    if (problem.empty() && (first.vertexCount() != last.vertexCount() || first.m_triangles != last.m_triangles))
        problem = endPath + ": has not the vertices and triangles of " + startPath;
    if (problem.empty() && firstStructure != lastStructure)
        problem = endPath + ": has not the faces of " + startPath + " in their order";
    if (problem.empty()) joinVertices(first, last.m_positions);
    if (problem.empty() && first.triangleCount() == 0) problem = startPath + ": no triangles";
    if (problem.empty())
    {
        mesh = std::move(first);
        end = std::move(last.m_positions);
    }
    else
        error = problem;
    return problem.empty();
}
}  // namespace drape
