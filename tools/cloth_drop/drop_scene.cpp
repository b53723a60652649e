#include "tools/cloth_drop/drop_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>

#include "scenes/mesh_builder.h"
#include "scenes/mesh_loader.h"
#include "scenes/shapes.h"
#include "tools/common/suggestion.h"

namespace drape
{
namespace
{
// A thickness above a quarter of the smaller size is most likely meant in another unit.
constexpr double kMostThickness = 0.25;
// A thickness below this many float32 steps at the scene's size is mostly rounding.
constexpr double kLeastRoundings = 8;

// Distance of a sheet from the one below, as a multiple of the thickness.
constexpr double kLayerDistance = 1.5;
// Each sheet is turned about the vertical against the one below, so that edges of neighbours are not parallel.
constexpr double kLayerTurn = 0.12;

// Suggests a shape where the name is neither a file nor a shape.
bool makeObstacle(const std::string& name, TriangleMesh& mesh, LoadReport& report, std::string& error)
{
    if (makeShape(name, mesh) || loadMesh(name, Joining::ByPosition, mesh, report, error)) return true;
    std::error_code code;
    if (std::filesystem::exists(name, code) || code) return false;
    const std::string nearest = didYouMean(name, shapeNames());
    if (!nearest.empty())
        error += nearest;
    else if (name.find_first_of("./") == std::string::npos)
        error += "; shapes are " + joinedWords(shapeNames());
    return false;
}
}  // namespace

TriangleMesh sheetsOf(const DropScene& scene)
{
    TriangleMesh sheets;
    const TriangleMesh& sheet = scene.m_cloth.m_mesh;
    for (std::size_t layer = 0; layer < scene.m_layers; ++layer)
    {
        const double angle = kLayerTurn * double(layer), rise = kLayerDistance * scene.m_thickness * double(layer);
        const double c = std::cos(angle), s = std::sin(angle);
        const auto first = static_cast<std::int32_t>(sheets.vertexCount());
        for (std::size_t i = 0; i < sheet.m_positions.size(); i += 3)
        {
            const double x = sheet.m_positions[i], z = sheet.m_positions[i + 2];
            addVertex(sheets, c * x - s * z, sheet.m_positions[i + 1] + rise, s * x + c * z);
        }
        for (const std::int32_t node : sheet.m_triangles)
            sheets.m_triangles.push_back(first + node);
    }
    return sheets;
}

RunSubject subjectOf(const DropScene& scene)
{
    RunSubject subject;
    subject.m_cloths = sheetsOf(scene);
    subject.m_rest = subject.m_cloths.m_positions;
    subject.m_obstacles = {scene.m_obstacle};
    subject.m_starts = {ObstacleFrame()};
    subject.m_isShown = {true};
    subject.m_thickness = scene.m_thickness;
    subject.m_dt = scene.m_dt;
    subject.m_countsClothPairs = countsClothPairs(scene);
    return subject;
}

bool makeDropScene(const Options& options, DropScene& scene, std::string& error)
{
    LoadReport report;
    if (!makeObstacle(options.m_obstacle, scene.m_obstacle, report, error)) return false;
    scene.m_notes = report.m_notes;
    if (!(boundsOf(scene.m_obstacle).largestExtent() > 0))
    {
        error = options.m_obstacle + ": all vertices: the mesh has no extent";
        return false;
    }
    placeOnFloor(scene.m_obstacle, static_cast<float>(options.m_obstacleSize));
    const double top = boundsOf(scene.m_obstacle).m_high[1];
    scene.m_cloth = makeClothGrid(options.m_clothColumns, options.m_clothRows, static_cast<float>(options.m_clothSize),
                                  static_cast<float>(top + options.m_thickness + options.m_dropHeight));
    scene.m_layers = static_cast<std::size_t>(options.m_layers);
    scene.m_self = options.m_self;
    scene.m_dropSpeed = options.m_dropSpeed;
    scene.m_dt = options.m_dt;
    scene.m_thickness = options.m_thickness;
    return true;
}

std::string thicknessRemark(const Options& options)
{
    const double thickness = options.m_thickness;
    const double smaller = std::min(options.m_obstacleSize, options.m_clothSize);
    const double larger = std::max(options.m_obstacleSize, options.m_clothSize);
    char text[256];
    if (thickness > kMostThickness * smaller)
    {
        std::snprintf(
            text, sizeof text,
            "--thickness is %g m, where the obstacle is %g m and the cloth %g m across: the cloth comes to rest "
            "%g m away from the surface (20 mm are 0.02)",
            thickness, options.m_obstacleSize, options.m_clothSize, thickness);
        return text;
    }
    const double finest = larger * std::numeric_limits<float>::epsilon();
    if (thickness >= kLeastRoundings * finest) return "";
    std::snprintf(
        text, sizeof text,
        "--thickness is %g m, but in a scene %g m across positions (float32) are up to %g m apart: the gap at "
        "rest is lost in rounding",
        thickness, larger, finest);
    return text;
}
}  // namespace drape
