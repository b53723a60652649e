#include "scenes/mesh_loader.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "mesh_io/read_mesh_file.h"
#include "mesh_io/triangulate.h"

namespace drape
{
namespace
{
using Centre = std::array<double, 3>;

// Centring has to make rounding errors this much smaller. Below it positions keep the bits that the file has.
constexpr double kWorthwhile = 8;

float rounded(double value)
{
    return static_cast<float>(value);
}

// Calls use(vertex) for the vertices that faces use.
template <typename Use>
void forUsedVertices(const MeshFile& file, Use use)
{
    std::vector<bool> isUsed(file.vertexCount(), false);
    for (const std::int32_t corner : file.m_corners)
        isUsed[static_cast<std::size_t>(corner)] = true;
    for (std::size_t vertex = 0; vertex < isUsed.size(); ++vertex)
        if (isUsed[vertex]) use(vertex);
}

// Returns the largest rounding error of all coordinates relative to the centre; infinite if one does not fit a float.
double roundingOf(const std::vector<const MeshFile*>& files, const Centre& centre)
{
    double largest = 0;
    for (const MeshFile* file : files)
        forUsedVertices(*file,
                        [&](std::size_t vertex)
                        {
                            for (std::size_t axis = 0; axis < 3; ++axis)
                            {
                                const double value = file->m_positions[3 * vertex + axis] - centre[axis];
                                largest = std::max(largest, std::fabs(static_cast<double>(rounded(value)) - value));
                            }
                        });
    return largest;
}

// Returns the middle of all files' bounds, rounded to a fraction of their extent: a short number, whose subtraction is
// exact in most cases.
Centre middleOf(const std::vector<const MeshFile*>& files)
{
    constexpr double far = std::numeric_limits<double>::infinity();
    Centre low = {far, far, far}, high = {-far, -far, -far};
    for (const MeshFile* file : files)
        forUsedVertices(*file,
                        [&](std::size_t vertex)
                        {
                            for (std::size_t axis = 0; axis < 3; ++axis)
                            {
                                low[axis] = std::min(low[axis], file->m_positions[3 * vertex + axis]);
                                high[axis] = std::max(high[axis], file->m_positions[3 * vertex + axis]);
                            }
                        });
    double extent = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
        extent = std::max(extent, 0.5 * high[axis] - 0.5 * low[axis]);
    Centre middle;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        middle[axis] = 0.5 * low[axis] + 0.5 * high[axis];
        if (!(extent > 0)) continue;
        const double step = std::ldexp(1.0, std::max(std::ilogb(extent) - 3, -1000));
        const double steps = std::nearbyint(middle[axis] / step);
        if (std::isfinite(steps)) middle[axis] = steps * step;
    }
    return middle;
}

// Chooses the centre and says what rounding will change.
void chooseCentre(const std::string& name, const std::vector<const MeshFile*>& files, LoadReport& report)
{
    report.m_centre = {};
    report.m_rounding = roundingOf(files, report.m_centre);
    if (report.m_rounding > 0)
    {
        const Centre middle = middleOf(files);
        const double centred = roundingOf(files, middle);
        if (centred * kWorthwhile <= report.m_rounding && std::isfinite(centred))
        {
            report.m_centre = middle;
            report.m_rounding = centred;
        }
    }
    if (!report.isCentred()) return;
    char text[200];
    std::snprintf(text, sizeof text,
                  ": centred: (%.17g, %.17g, %.17g) is subtracted before coordinates are rounded to float32, which "
                  "changes them by at most %.2g",
                  report.m_centre[0], report.m_centre[1], report.m_centre[2], report.m_rounding);
    report.m_notes.push_back(name + text);
}

// Returns "" and the positions less the centre as floats, or which vertex of a face does not fit.
std::string roundPositions(const std::string& path, const MeshFile& file, const Centre& centre,
                           std::vector<float>& positions)
{
    positions.resize(file.m_positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i)
        positions[i] = rounded(file.m_positions[i] - centre[i % 3]);
    std::string problem;
    forUsedVertices(file,
                    [&](std::size_t vertex)
                    {
                        const float* p = &positions[3 * vertex];
                        if (problem.empty() && !(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])))
                            problem =
                                path + ": vertex " + std::to_string(vertex + 1) + ": a coordinate does not fit a float";
                    });
    return problem;
}

// Parses a file once where both are the same.
bool readBoth(const std::string& firstPath, const std::string& secondPath, MeshFile& first, MeshFile& second,
              std::string& error)
{
    if (!readMeshFile(firstPath, first, error)) return false;
    if (firstPath != secondPath) return readMeshFile(secondPath, second, error);
    second = first;
    return true;
}

void addNotes(const std::string& path, const std::vector<std::string>& notes, LoadReport& report)
{
    for (const std::string& note : notes)
        report.m_notes.push_back(path + ": " + note);
}

// Triangles of a file that has been read, with positions less the report's centre. `end`, where it is not null, has the
// positions of the same vertices at another time.
std::string makeMesh(const std::string& path, const MeshFile& file, Joining joining, TriangleMesh& mesh,
                     std::vector<float>* end, LoadReport& report)
{
    TriangleMesh made;
    std::vector<std::string> notes = file.m_notes;
    std::string problem = triangulate(file, made.m_triangles, notes);
    if (!problem.empty()) return path + ": " + problem;
    problem = roundPositions(path, file, report.m_centre, made.m_positions);
    if (!problem.empty()) return problem;
    const bool byPosition = joining == Joining::ByPosition || !file.m_hasIndices;
    std::vector<float> start;
    if (end == nullptr) start = made.m_positions;
    std::vector<float>& moved = end ? *end : start;
    const std::size_t dropped = byPosition ? joinVertices(made, moved) : keepUsedVertices(made, moved);
    if (made.triangleCount() == 0) return path + ": no triangles";
    if (dropped > 0) notes.push_back(counted(dropped, "triangle") + " with a vertex twice left out");
    report.m_isJoined = report.m_isJoined || byPosition;
    addNotes(path, notes, report);
    mesh = std::move(made);
    return "";
}
}  // namespace

bool loadMesh(const std::string& path, TriangleMesh& mesh, std::string& error)
{
    LoadReport report;
    return loadMesh(path, Joining::ByPosition, mesh, report, error);
}

bool loadMesh(const std::string& path, Joining joining, TriangleMesh& mesh, LoadReport& report, std::string& error)
{
    MeshFile file;
    report = LoadReport();
    if (!readMeshFile(path, file, error)) return false;
    chooseCentre(path, {&file}, report);
    const std::string problem = makeMesh(path, file, joining, mesh, nullptr, report);
    if (!problem.empty()) error = problem;
    return problem.empty();
}

bool loadMeshes(const std::string& firstPath, const std::string& secondPath, Joining joining, TriangleMesh& first,
                TriangleMesh& second, LoadReport& report, std::string& error)
{
    MeshFile firstFile, secondFile;
    report = LoadReport();
    if (!readBoth(firstPath, secondPath, firstFile, secondFile, error)) return false;
    chooseCentre(firstPath + ", " + secondPath, {&firstFile, &secondFile}, report);
    std::string problem = makeMesh(firstPath, firstFile, joining, first, nullptr, report);
    if (problem.empty()) problem = makeMesh(secondPath, secondFile, joining, second, nullptr, report);
    if (!problem.empty()) error = problem;
    return problem.empty();
}

bool loadMotion(const std::string& startPath, const std::string& endPath, Joining joining, TriangleMesh& mesh,
                std::vector<float>& end, LoadReport& report, std::string& error)
{
    MeshFile first, last;
    report = LoadReport();
    if (!readBoth(startPath, endPath, first, last, error)) return false;
    std::string problem;
    if (first.vertexCount() != last.vertexCount())
        problem = endPath + ": has " + std::to_string(last.vertexCount()) + " vertices, " + startPath + " has " +
                  std::to_string(first.vertexCount());
    else if (first.m_faceEnds != last.m_faceEnds || first.m_corners != last.m_corners)
        problem = endPath + ": does not have the faces of " + startPath + " in the same order";
    if (problem.empty()) chooseCentre(startPath + ", " + endPath, {&first, &last}, report);
    std::vector<float> moved;
    if (problem.empty()) problem = roundPositions(endPath, last, report.m_centre, moved);
    if (problem.empty()) problem = makeMesh(startPath, first, joining, mesh, &moved, report);
    addNotes(endPath, last.m_notes, report);
    if (problem.empty())
        end = std::move(moved);
    else
        error = problem;
    return problem.empty();
}

bool loadMotion(const std::string& startPath, const std::string& endPath, TriangleMesh& mesh, std::vector<float>& end,
                std::string& error)
{
    LoadReport report;
    return loadMotion(startPath, endPath, Joining::ByPosition, mesh, end, report, error);
}
}  // namespace drape
